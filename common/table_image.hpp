#pragma once
// The flash image of the lookup tables: what the host tools build from the elastic model and the firmware
// reads in place. Byte by byte: TABLES.md and TABLES_PATCHES.md, with an example: TABLES_EXAMPLE.md. What is
// checked: TABLES_CHECKS.md.

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

#include "common/crc32.hpp"
#include "common/quantities.hpp"

namespace strainfinger {

static_assert(std::endian::native == std::endian::little, "the image is little-endian and is read in place");

inline constexpr std::uint32_t kTableMagic = 0x42544653;  ///< "SFTB" in the file's first four bytes
inline constexpr std::uint16_t kTableFormat = 10;         ///< raised with every change of the layout

/// What the image was made from, as in finger.toml. The firmware carries it and doesn't look at it.
struct TableParameters {
  double core_radius_m;
  double outer_radius_m;
  double length_m;
  double shear_modulus_pa;
  double poisson_ratio;
  double gauge_radius_m;
  double first_angle_deg;
  double arc_length_m;
  double noise_strain;
  double full_scale_strain;
  double model_error;
  double place_error_m;
  double load_error;
  double moment_error_m2;
  double contact_width_m;  ///< negative: not known, fitted with each touch
  double largest_width_m;
  double friction_coefficient;
  std::uint16_t gauge_count;
  StrainComponent component;
  std::uint8_t adc_bits;
  std::uint32_t reserved;  ///< 0

  bool operator==(const TableParameters&) const = default;
};

/// Cells of the second moment that a table can have. Their edges are closer where it is small.
inline constexpr int kMostCells = 10;
/// Patches of a table: angle nodes times cells of the second moment.
inline constexpr int kMostPatches = 1000;
inline constexpr int kLeastNodes = 8;

/// Second moment of the pressure over the contact's arc, as a fraction of TableConstants::largest_moment_um2
/// [* 2^20]; that of a tangential load, up to twice as large, as a fraction of twice that.
inline constexpr int kMomentBits = 20;

/// How far the gauges of a ring are apart for their depth and the rubber.
enum class RingSpacing : std::uint8_t {
  kDense,
  kLoose,   ///< a narrow touch may have a second answer near by, however firm it is
  kSparse,  ///< too far to tell a gauge that fails from a touch between two
};

/// Integers the firmware works with, derived from TableParameters, the calibration and, where a finger is not
/// calibrated, from [tolerance].
struct TableConstants {
  std::uint32_t noise_variance;  ///< of a reading: sigma^2 = this (24 bits) * 2^noise_variance_exponent
                                 ///< [(strain * 2^32)^2]
  std::uint32_t gate_on;         ///< energy (see gate_shift) at which a contact begins
  std::uint32_t gate_off;        ///< energy below which it ends
  std::int32_t load_scale;    ///< LineLoadQ12 per unit of a fitted load = this * 2^load_exponent; two units
                              ///< make a largest reading of 1 (strain * 2^32)
  std::int32_t reading_gain;  ///< strain * 2^32 = ((code << 15) - zero) * reading_gain >> 32
  std::uint32_t force_per_load_q16;  ///< mN per N/m [* 2^16]
  std::uint32_t reach_q32;           ///< grids look at gauges within this angle of a contact, TurnQ32
  std::uint32_t largest_moment_um2;  ///< second moment of the widest pressure [um^2]
  std::uint32_t known_moment_q20;    ///< fraction of it, where the width is known
  std::uint32_t place_error_q32;     ///< standard error of all places that no residual shows, TurnQ32
  std::int16_t load_exponent;
  std::uint16_t friction_q8;           ///< coefficient of friction [* 2^8]
  std::uint16_t cone_q8;               ///< largest |tangential| / normal an answer may have [* 2^8]
  std::uint16_t model_error_q16;       ///< standard deviation of a reading's model error over that reading
  std::uint16_t load_scale_error_q16;  ///< standard error of the scale of all loads, at most 1
  std::uint16_t load_error_q16;        ///< that calibration leaves of both loads, over the normal load
  std::uint16_t moment_error_q16;      ///< of second moments that no residual shows, over the largest
  std::uint16_t adc_rail;              ///< codes from here on, and those as near to 0, are ends of the range
  std::uint16_t node_count;            ///< angle nodes over half a revolution
  std::int8_t noise_variance_exponent;
  std::int8_t mirror_sign;  ///< reading seen from the other side: +1 radial, hoop; -1 shear
  std::int8_t peak_sign;    ///< sign of the largest reading that a pressing load makes
  std::uint8_t gauge_count;
  std::uint8_t cell_count;      ///< cells of the second moment
  std::uint8_t width_is_known;  ///< 1: known_moment_q20 holds, no width is fitted
  std::uint8_t gate_shift;      ///< the gate's energy is the sum of strain^2, >> (2 * gate_shift)
  RingSpacing spacing;          ///< of the gauges, for their depth and rubber
  std::array<std::uint16_t, kMostCells + 1> cell_edge_q15;  ///< ascending from 0 to 2^15 (all of it)
  std::array<std::uint16_t, kMostCells> cell_rate_q8;       ///< 2 / (cell's width) [* 2^8]
  std::array<std::uint8_t, 4> reserved2;                    ///< 0
};

/// The response of a gauge at angles around a node and second moments around a cell's middle, a quadratic in
/// both: s and t run from -1 to 1 over the cell of second moments and over the node's angles. Weights of 1,
/// s, t, t^2, st, s^2 [* 2^15 of the largest response].
using ResponsePatch = std::array<std::int16_t, 6>;

/// To a unit of normal and of tangential load.
struct PatchPair {
  ResponsePatch normal;
  ResponsePatch tangential;
};

/// How sensitive each gauge is, from calibration: gauge i's gain is reading_gain (1 + correction_i 2^-14).
struct GaugeGains {
  std::array<std::int16_t, kMaxGauges> correction_q14;
  std::uint8_t are_known;                ///< 0: not calibrated, and no gauge is corrected
  std::array<std::uint8_t, 7> reserved;  ///< 0

  static constexpr int kFracBits = 14;
  constexpr bool areKnown() const { return are_known != 0; }
  constexpr std::int64_t gainOf(std::int32_t readingGain, std::size_t gauge) const {
    return readingGain + (std::int64_t{readingGain} * correction_q14[gauge] >> kFracBits);
  }
  bool operator==(const GaugeGains&) const = default;
};

/// Points of a shape over half a revolution from the contact, both ends included.
inline constexpr int kDepthShapePoints = 24;
inline constexpr int kMostDepthShapeShift = 8;

/// How much deeper each gauge lies than the drawing, and what a depth of 128 steps adds to its responses
/// besides a factor, which is in its gain: so much of the other load's slope over the angle, taken at the
/// same second moment, of itself, and a shape over the angle.
struct GaugeDepths {
  using Shape = std::array<std::int8_t, kDepthShapePoints>;
  static constexpr int kStepsBits = 7;    ///< [log2] the depth for which the rest tells what is added
  static constexpr int kTurnBits = 11;    ///< fraction bits of the factors of slopes
  static constexpr int kFactorBits = 15;  ///< of the factor of the response itself

  std::array<std::int8_t, kMaxGauges> steps;  ///< negative: nearer the surface; 0 beyond the ring
  std::int16_t normal_turn_q11;               ///< of d(tangential) / dt
  std::int16_t tangential_turn_q11;           ///< of d(normal) / dt
  std::int16_t tangential_q15;                ///< of the tangential response
  std::uint16_t step_nm;                      ///< 0: not calibrated, and no gauge is deeper
  Shape normal_shape;                         ///< * 2^shape_shift: response * 2^15
  Shape tangential_shape;                     ///< the same
  std::uint8_t shape_shift;
  std::array<std::uint8_t, 7> reserved;  ///< 0

  constexpr bool areKnown() const { return step_nm != 0; }
  bool operator==(const GaugeDepths&) const = default;
};

/// Where each gauge of a ring is, TurnQ32, ascending from the first one round the ring; then 0.
using GaugeAngles = std::array<std::uint32_t, kMaxGauges>;

struct TableImage {
  std::uint32_t magic;
  std::uint16_t format;
  std::uint16_t reserved;     ///< 0
  std::uint32_t image_bytes;  ///< all of it
  std::uint32_t crc32;        ///< of everything behind this field
  TableParameters parameters;
  TableConstants constants;
  GaugeAngles gauge_angle_q32;
  GaugeGains gains;
  GaugeDepths depths;
  std::array<PatchPair, kMostPatches> patches;  ///< node by node; of each, cell by cell

  const PatchPair& patch(int node, int cell) const {
    return patches[static_cast<std::size_t>(node * constants.cell_count + cell)];
  }
};

static_assert(std::is_trivially_copyable_v<TableImage>);
static_assert(sizeof(TableParameters) == 144 && sizeof(TableConstants) == 112 && sizeof(PatchPair) == 24 &&
              sizeof(GaugeGains) == 72 && sizeof(GaugeDepths) == 96);
static_assert(sizeof(TableImage) == 16 + 144 + 112 + 4 * kMaxGauges + 72 + 96 + 24 * kMostPatches,
              "no padding anywhere");

/// Why an image was refused.
enum class TableFault : std::uint8_t {
  kNone,
  kTooShort,  ///< not even a header
  kMagic,
  kFormat,  ///< another format than kTableFormat
  kLength,
  kChecksum,
  kConstants,  ///< checksum right, but a number is outside what the firmware can work with
};

/// Magic, format, length and checksum: what must be there before an image can be judged.
inline constexpr std::size_t kTableHeaderBytes = offsetof(TableImage, parameters);

/// Bytes that the checksum covers: all behind the header.
inline std::span<const std::byte> checkedBytes(const TableImage& image) {
  return std::as_bytes(std::span(&image, 1)).subspan(kTableHeaderBytes);
}

/// Strains stay below 2^(15 + this): sums of their squares, and four of them, fit their words.
inline constexpr int kMostGateShift = 14;

/// Strains of any code and zero stay smaller than 2^(15 + gate_shift).
constexpr bool usableGain(std::int64_t gain, int gateShift) {
  return gain >= 0 && gain <= (std::int64_t{1} << (16 + gateShift)) - 2;
}

/// Gains of all gauges, in use or not, are usable; none is corrected without a calibration.
constexpr bool usable(const GaugeGains& gains, const TableConstants& constants) {
  if (gains.are_known > 1) return false;
  for (std::size_t i = 0; i < gains.correction_q14.size(); ++i) {
    if (!gains.areKnown() && gains.correction_q14[i] != 0) return false;
    if (!usableGain(gains.gainOf(constants.reading_gain, i), constants.gate_shift)) return false;
  }
  return true;
}

/// No gauge is deeper than the drawing without a step.
constexpr bool usable(const GaugeDepths& depths) {
  return depths.shape_shift <= kMostDepthShapeShift &&
         (depths.areKnown() ||
          std::all_of(depths.steps.begin(), depths.steps.end(), [](int each) { return each == 0; }));
}

/// Variances have 24 bits; 2^24 is what rounding makes of the largest.
inline constexpr std::uint32_t kMostNoiseVariance = std::uint32_t{1} << 24;

/// Exponents with which a reading's standard deviation is a number below 2^31 and shifted by less than 32.
inline constexpr int kLeastNoiseExponent = -62;
inline constexpr int kMostNoiseExponent = 36;

constexpr bool usableNoise(std::uint32_t variance, int exponent) {
  return variance <= kMostNoiseVariance && exponent >= kLeastNoiseExponent && exponent <= kMostNoiseExponent;
}

/// Loads are amplitudes times load_scale shifted right by at least 2, whatever the readings were shifted by.
constexpr bool usableLoads(int loadExponent, int gateShift) { return loadExponent < -2 - gateShift; }

/// Cells ascend from 0 to 1 and are no narrower than their rate's format holds.
constexpr bool usableCells(const TableConstants& constants) {
  if (constants.cell_count < 1 || constants.cell_count > kMostCells) return false;
  if (constants.cell_edge_q15[0] != 0 || constants.cell_edge_q15[constants.cell_count] != 1 << 15)
    return false;
  for (std::size_t k = 0; k < constants.cell_count; ++k) {
    if (constants.cell_edge_q15[k + 1] <= constants.cell_edge_q15[k]) return false;
    const int width_q15 = constants.cell_edge_q15[k + 1] - constants.cell_edge_q15[k];
    if (constants.cell_rate_q8[k] > (2 << 23) / width_q15 + 1) return false;
  }
  return true;
}

/// Places that are known no better are not known.
inline constexpr std::uint32_t kMostPlaceError_q32 = std::uint32_t{1} << 30;

/// What the firmware's loops and shifts rely on, and names that have a meaning.
constexpr bool usable(const TableParameters& parameters, const TableConstants& constants) {
  return parameters.component <= StrainComponent::kShear && constants.gauge_count >= kMinGauges &&
         constants.gauge_count <= kMaxGauges && constants.gauge_count % 2 == 0 &&
         constants.gate_shift <= kMostGateShift && usableGain(constants.reading_gain, constants.gate_shift) &&
         usableNoise(constants.noise_variance, constants.noise_variance_exponent) &&
         usableLoads(constants.load_exponent, constants.gate_shift) &&
         (constants.mirror_sign == 1 || constants.mirror_sign == -1) &&
         (constants.peak_sign == 1 || constants.peak_sign == -1) && constants.width_is_known <= 1 &&
         constants.spacing <= RingSpacing::kSparse && constants.known_moment_q20 <= 1u << kMomentBits &&
         constants.place_error_q32 <= kMostPlaceError_q32 && constants.cone_q8 > 0 &&
         constants.reach_q32 < std::uint32_t{1} << 31 && usableCells(constants) &&
         constants.node_count >= kLeastNodes && constants.node_count * constants.cell_count <= kMostPatches;
}

/// Gauges of the ring ascend within one revolution from the first one.
constexpr bool usable(const GaugeAngles& angles_q32, int gauges) {
  for (int i = 1; i < gauges; ++i)
    if (angles_q32[static_cast<std::size_t>(i)] - angles_q32[0] <=
        angles_q32[static_cast<std::size_t>(i - 1)] - angles_q32[0])
      return false;
  return true;
}

/// A patch's values stay within 16 bits, its slopes within twice that, whatever s and t.
constexpr bool usable(const ResponsePatch& patch) {
  int sum = 0;
  for (const int weight : patch) sum += weight < 0 ? -weight : weight;
  return sum < 1 << 15;
}

/// Looks at everything that can be wrong with an image of the right size. Cost: one pass over its bytes.
inline TableFault checkTableImage(const TableImage& image) {
  if (image.magic != kTableMagic) return TableFault::kMagic;
  if (image.format != kTableFormat || image.reserved != 0) return TableFault::kFormat;
  if (image.image_bytes != sizeof(TableImage)) return TableFault::kLength;
  if (image.crc32 != crc32(checkedBytes(image))) return TableFault::kChecksum;
  const bool works = usable(image.parameters, image.constants) && usable(image.gains, image.constants) &&
                     usable(image.depths) && usable(image.gauge_angle_q32, image.constants.gauge_count) &&
                     std::all_of(image.patches.begin(), image.patches.end(), [](const PatchPair& pair) {
                       return usable(pair.normal) && usable(pair.tangential);
                     });
  return works ? TableFault::kNone : TableFault::kConstants;
}

}  // namespace strainfinger
