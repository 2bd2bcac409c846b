#pragma once
// The flash image of the lookup tables: what the host tools build from the elastic model and the firmware
// reads in place. Byte by byte, with an example: TABLES.md.

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <type_traits>

#include "common/crc32.hpp"
#include "common/quantities.hpp"

namespace strainfinger {

static_assert(std::endian::native == std::endian::little, "the image is little-endian and is read in place");

inline constexpr std::uint32_t kTableMagic = 0x42544653;  ///< "SFTB" in the file's first four bytes
inline constexpr std::uint16_t kTableFormat = 6;          ///< raised with every change of the layout

/// Gauges that one fit looks at: the nearest one and three on either side. With 16 gauges they hold all but
/// 0.4 / 0.3 / 0.9 % of what the whole ring knows of angle, normal and tangential load.
inline constexpr int kWindowGauges = 7;
inline constexpr int kWindowReach = kWindowGauges / 2;

/// Finer rings have a wider response, in pitches: there a fit also looks at the outer pair, the gauges at
/// distance 4, of which it takes the difference. With it a window of 24 gauges holds all but 0.6 / 0.2 / 1.8
/// % of what its ring knows, instead of 1.8 / 0.3 / 5.3 %.
inline constexpr int kOuterReach = kWindowReach + 1;
constexpr bool hasOuterPair(int gauges) { return gauges > 16; }
constexpr int fitReach(int gauges) { return hasOuterPair(gauges) ? kOuterReach : kWindowReach; }

/// Rows of a fit table: contact offsets 0, 1/64, .. 39/64 of a pitch from the window's middle gauge. Beyond
/// half a pitch the next gauge's window takes over; the rest is overlap, so that a fit may walk across.
inline constexpr int kRowsPerPitch = 64;
inline constexpr int kFitRows = 40;

/// Rows between the starts of a scan, either of the two: fewer cost more, more would step over a maximum.
inline constexpr int kMinScanStep = 4;
inline constexpr int kMaxScanStep = 8;

/// Rows at which a scan may start and end.
inline constexpr int kFirstScanRow = 4;
inline constexpr int kLastScanRow = 36;

/// Where to look for a contact, from the share that the deepest reading has of the ring's energy: the more,
/// the nearer is the contact to that gauge. Rows to scan on either side of it; none where the contact may be
/// too far from it for that, but no nearer to any gauge than `first`.
struct ScanSpan {
  std::uint8_t packed;  ///< first row / 4, last row / 4 * 16

  constexpr int first() const { return (packed & 15) * 4; }
  constexpr int last() const { return (packed >> 4) * 4; }
  static constexpr ScanSpan of(int first, int last) {
    return {static_cast<std::uint8_t>(first / 4 | last / 4 << 4)};
  }
  bool operator==(const ScanSpan&) const = default;
};
inline constexpr int kShares = 16;  ///< shares are told apart by sixteenths

/// Where a contact is, by the share that the deepest reading has: the differences of the pairs around it (+
/// side minus - side; the outer pair's last, 0 without), weighted and over that reading, add up to the offset
/// [pitches * 2^kStartWeightBits], to within 1/16 pitch for most. The first 0: they don't. Of firm contacts
/// (TableConstants::firm_exponent), a quarter of a pitch or more from that gauge, a fit from there that
/// explains the readings is theirs: another offset of its window would not explain them within noise.
struct alignas(8) StartWeights : std::array<std::int16_t, 4> {
  constexpr bool tell() const { return front() != 0; }
};
inline constexpr int kStartWeightBits = 10;

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
  double contact_width_m;
  double friction_coefficient;
  std::uint16_t gauge_count;
  StrainComponent component;
  std::uint8_t adc_bits;
  std::uint32_t reserved;  ///< 0

  bool operator==(const TableParameters&) const = default;
};

/// How the locator finds the gauge nearest to the contact.
enum class AnchorRule : std::uint8_t {
  kSecondDifference = 0,  ///< where anchor_sign (s[c-1] - 2 s[c] + s[c+1]) is largest
  kExhaustive = 1,        ///< the window that the model explains best: dearer, for responses without one peak
};

/// Integers the firmware works with, all derived from TableParameters.
struct TableConstants {
  std::uint32_t pitch_turn_q35;      ///< one pitch [revolutions * 2^35]
  std::uint32_t first_angle_q32;     ///< angle of gauge 0, TurnQ32
  std::uint32_t noise_variance;      ///< of a reading: sigma^2 = this (24 bits) * 2^noise_variance_exponent
                                     ///< [(strain * 2^32)^2]
  std::uint32_t gate_on;             ///< energy (see gate_shift) at which a contact begins
  std::uint32_t gate_off;            ///< energy below which it ends
  std::int32_t load_scale;           ///< LineLoadQ12 per unit of a fit's amplitude = this * 2^load_exponent
  std::int32_t reading_gain;         ///< strain * 2^32 = ((code << 15) - zero) * reading_gain >> 32
  std::uint32_t force_per_load_q16;  ///< mN per N/m [* 2^16]
  std::int16_t load_exponent;
  std::uint16_t friction_cone_q8;  ///< largest |tangential| / normal a fit may have [* 2^8]
  std::uint16_t adc_rail;          ///< left-justified code at which the converter clips; 0 is the other
  std::uint16_t tail_q16;  ///< most energy a contact leaves outside its window, over that inside [* 2^16]
  std::int8_t noise_variance_exponent;
  std::int8_t amplitude_exponent;  ///< FitRow::load counts 2^amplitude_exponent
  std::int8_t mirror_sign;         ///< reading seen from the other side: +1 radial, hoop; -1 shear
  std::int8_t anchor_sign;         ///< +1: peak of a pressing load is negative; -1: positive
  std::uint8_t gauge_count;
  std::uint8_t gate_shift;  ///< the gate's energy is the sum of (strain >> gate_shift)^2
  AnchorRule anchor_rule;
  std::uint8_t scan_step;  ///< rows between the starts of a scan: half a step, 3/2, 5/2 .. of it
  std::array<ScanSpan, kShares> scan_span;  ///< by the deepest reading's share
  std::uint16_t near_pole_q15;           ///< offset at which near rows would tell no loads [pitches * 2^15]
  std::uint8_t firm_exponent;            ///< a ring of 2^this variances is firm, see StartWeights
  std::array<std::uint8_t, 5> reserved;  ///< 0
};

/// A signal over the window, folded about the middle gauge: middle, then sums of the pairs at distance
/// 1, 2, 3, then differences (+ side minus - side) of the same pairs, then that of the outer pair, 0 without.
/// Folding halves the table (offsets of the other sign are the mirrored signal) and lets a scan share its
/// products. Aligned for loads of two words at once.
struct alignas(8) FoldedWeights : std::array<std::int16_t, 8> {};

/// Three gauges of a window, by their distance from its middle gauge.
using GaugeTriple = std::array<std::int8_t, 3>;
inline constexpr int kTriples = 35;

/// All triples of a window, in ascending order: {-3, -2, -1}, {-3, -2, 0} .. {1, 2, 3}.
inline constexpr std::array<GaugeTriple, kTriples> kTripleList = [] {
  std::array<GaugeTriple, kTriples> list{};
  std::size_t next = 0;
  for (int a = -kWindowReach; a <= kWindowReach; ++a)
    for (int b = a + 1; b <= kWindowReach; ++b)
      for (int c = b + 1; c <= kWindowReach; ++c)
        list[next++] = {static_cast<std::int8_t>(a), static_cast<std::int8_t>(b),
                        static_cast<std::int8_t>(c)};
  return list;
}();

/// Number of {-1, 0, 1}: the middle gauge and its neighbours.
inline constexpr std::uint8_t kNearTriple = 25;
static_assert(kTripleList[kNearTriple] == GaugeTriple{-1, 0, 1});

/// Which way the tangential load pulls, seen from the window's middle gauge: three readings that see the
/// offset well for one sense are nearly blind for the other, so each has its own triples.
enum FitSense : std::uint8_t { kWithOffset = 0, kAgainstOffset = 1 };

/// The linear algebra of a fit with the contact at one offset, per unit amplitude of the response's peak.
/// B = [normal response, tangential response] over the window and, over sqrt(2), of the outer pair's
/// difference (8 x 2), B = U R (QR), ' = d/d(offset in pitches), W = (1 - U U^T) B' R^-1.
struct FitRow {
  std::array<FoldedWeights, 2> basis;           ///< columns of U [* 2^15]
  std::array<FoldedWeights, 2> gradient;        ///< columns of W, each of length 1 [* 2^15]; 0: W_i is 0
  std::array<std::int16_t, 2> gradient_length;  ///< |W_i| [* 2^(15 - gradient_exponent)], the longer >= 2^14
  std::int16_t gradient_cosine;                 ///< W_1 . W_2 / (|W_1| |W_2|) [* 2^15]
  std::int8_t gradient_exponent;
  std::int8_t reserved;                    ///< 0
  std::array<std::int16_t, 3> load;        ///< R^-1: 11, 12, 22 [* 2^amplitude_exponent]
  std::array<std::uint8_t, 2> triple;      ///< by FitSense: number in kTripleList of the best conditioned
  std::array<std::int16_t, 4> load_slope;  ///< d(R^-1 U^T)/d(offset) U, per row spacing, row-major, as `load`
};

using FitTable = std::array<FitRow, kFitRows>;

/// Near rows: contact offsets 0, 1/32, .. 12/32 of a pitch. Beyond, three readings around the contact hardly
/// tell its loads.
inline constexpr int kNearRows = 13;
inline constexpr int kNearStride = 2;  ///< rows of the fit table from one to the next

/// What the middle reading and the two beside it tell of a contact at one offset, folded. As the loads change
/// they span a plane, whose normal is the cross product of the responses to a unit of either. The loads are
/// those of middle and difference, times 1 - offset / near_pole: what they grow by near the pole, where these
/// two no longer tell them apart, is left to the firmware. The last tangential one 0: this row and those
/// behind it don't tell.
struct alignas(8) NearRow {
  std::array<std::int16_t, 4> normal;           ///< middle, sum, difference, 0 [* 2^14; the longest 1]
  std::array<std::int16_t, 2> normal_load;      ///< middle, difference [* 2^(amplitude_exponent - 1)]
  std::array<std::int16_t, 2> tangential_load;  ///< the same

  constexpr bool tells() const { return tangential_load[1] != 0; }
};

using NearTable = std::array<NearRow, kNearRows>;

/// How sensitive each gauge is, from calibration: gauge i's gain is reading_gain (1 + correction_i
/// 2^-exponent). One exponent for all, so that a ring whose gauges are alike to 12 % has steps of 0.1 %.
struct GaugeGains {
  std::array<std::int8_t, kMaxGauges> correction;
  std::uint8_t exponent;                 ///< 0: not calibrated, and no gauge is corrected
  std::array<std::uint8_t, 7> reserved;  ///< 0

  constexpr bool isCalibrated() const { return exponent != 0; }
  constexpr std::int64_t gainOf(std::int32_t readingGain, std::size_t gauge) const {
    return readingGain + (std::int64_t{readingGain} * correction[gauge] >> exponent);
  }
  bool operator==(const GaugeGains&) const = default;
};

inline constexpr int kLeastGainExponent = 6;  ///< corrections up to 127/64, for gains down to 1/2
inline constexpr int kMostGainExponent = 15;

struct TableImage {
  std::uint32_t magic;
  std::uint16_t format;
  std::uint16_t reserved;     ///< 0
  std::uint32_t image_bytes;  ///< all of it
  std::uint32_t crc32;        ///< of everything behind this field
  TableParameters parameters;
  TableConstants constants;
  std::array<StartWeights, kShares> start;
  FitTable rows;
  NearTable near;
  GaugeGains gains;
};

static_assert(std::is_trivially_copyable_v<TableImage>);
static_assert(sizeof(TableParameters) == 104 && sizeof(TableConstants) == 72 && sizeof(FitRow) == 88 &&
              sizeof(NearRow) == 16 && sizeof(GaugeGains) == 40);
static_assert(sizeof(TableImage) == 16 + 104 + 72 + 8 * kShares + 88 * kFitRows + 16 * kNearRows + 40,
              "no padding anywhere");

/// Why an image was refused. The numbers go on the bus and into exit statuses: never reuse one.
enum class TableFault : std::uint8_t {
  kNone = 0,
  kTooShort = 1,  ///< not even a header
  kMagic = 2,
  kFormat = 3,  ///< another format than kTableFormat
  kLength = 4,
  kChecksum = 5,
  kConstants = 6,  ///< checksum right, but a number is outside what the firmware can work with
};

/// Magic, format, length and checksum: what must be there before an image can be judged.
inline constexpr std::size_t kTableHeaderBytes = offsetof(TableImage, parameters);

/// Bytes that the checksum covers: all behind the header.
inline std::span<const std::byte> checkedBytes(const TableImage& image) {
  return std::as_bytes(std::span(&image, 1)).subspan(kTableHeaderBytes);
}

/// Steps are scaled by shifts that these bound.
inline constexpr int kLeastGradientExponent = -3;
inline constexpr int kMostGradientExponent = 12;

/// Strains stay below 2^(15 + this): sums of their squares, and four of them, fit their words.
inline constexpr int kMostGateShift = 14;

/// Strains of any code and zero stay smaller than 2^(15 + gate_shift).
constexpr bool usableGain(std::int64_t gain, int gateShift) {
  return gain >= 0 && gain <= (std::int64_t{1} << (16 + gateShift)) - 2;
}

/// Gains of all gauges, in use or not, are usable; none is corrected without an exponent.
constexpr bool usable(const GaugeGains& gains, const TableConstants& constants) {
  const bool inDomain =
      gains.isCalibrated()
          ? gains.exponent >= kLeastGainExponent && gains.exponent <= kMostGainExponent
          : std::all_of(gains.correction.begin(), gains.correction.end(), [](int each) { return each == 0; });
  if (!inDomain) return false;
  for (std::size_t i = 0; i < gains.correction.size(); ++i)
    if (!usableGain(gains.gainOf(constants.reading_gain, i), constants.gate_shift)) return false;
  return true;
}

constexpr bool isSign(int value) { return value == 1 || value == -1; }

/// Scans end within the table, and step as their rows do.
constexpr bool usable(ScanSpan span) {
  const auto isStart = [](int row) {
    return row >= kFirstScanRow && row <= kLastScanRow && (row - kFirstScanRow) % kMaxScanStep == 0;
  };
  return isStart(span.first()) && (span.last() == 0 || (isStart(span.last()) && span.last() >= span.first()));
}

/// Less is in doubt whatever it is (mayBeAlias()); energies have 28 bits, and noise is told by 2^5 variances.
inline constexpr int kLeastFirmExponent = 13;
inline constexpr int kMostFirmExponent = 31;

/// Variances have 24 bits; 2^24 is what rounding makes of the largest.
inline constexpr std::uint32_t kMostNoiseVariance = std::uint32_t{1} << 24;

/// Exponents with which a reading's standard deviation is a number below 2^31 and shifted by less than 32.
inline constexpr int kLeastNoiseExponent = -62;
inline constexpr int kMostNoiseExponent = 36;

constexpr bool usableNoise(std::uint32_t variance, int exponent) {
  return variance <= kMostNoiseVariance && exponent >= kLeastNoiseExponent && exponent <= kMostNoiseExponent;
}

/// Loads are amplitudes times load_scale shifted right: readings are divided by up to 2^(gate_shift + 2).
constexpr bool usableLoads(int loadExponent, int gateShift) { return loadExponent < -2 - gateShift; }

template <typename Rows>
constexpr bool allUsable(const Rows& rows) {
  return std::all_of(rows.begin(), rows.end(), [](const auto& row) { return usable(row); });
}

/// Near rows end before their pole.
inline constexpr int kLeastNearPole_q15 = kNearRows * (1 << 10);

/// What the firmware's loops and shifts rely on, and names that have a meaning.
constexpr bool usable(const TableParameters& parameters, const TableConstants& constants) {
  return parameters.component <= StrainComponent::kShear && constants.gauge_count >= kMinGauges &&
         constants.gauge_count <= kMaxGauges && constants.gauge_count % 2 == 0 &&
         constants.gate_shift <= kMostGateShift && usableGain(constants.reading_gain, constants.gate_shift) &&
         usableNoise(constants.noise_variance, constants.noise_variance_exponent) &&
         usableLoads(constants.load_exponent, constants.gate_shift) && isSign(constants.mirror_sign) &&
         isSign(constants.anchor_sign) && constants.anchor_rule <= AnchorRule::kExhaustive &&
         (constants.scan_step == kMinScanStep || constants.scan_step == kMaxScanStep) &&
         constants.firm_exponent >= kLeastFirmExponent && constants.firm_exponent <= kMostFirmExponent &&
         constants.near_pole_q15 >= kLeastNearPole_q15 && allUsable(constants.scan_span);
}

/// Products of readings with a column of weights fit their words if its length is 1, but for rounding.
inline constexpr std::int64_t kMostWeightEnergy = (std::int64_t{1} << 30) + (1 << 18);

/// Squared length [* 2^30] of weights before they were folded.
constexpr std::int64_t unfoldedEnergy(const FoldedWeights& weights) {
  std::int64_t pairs = 0;
  for (std::size_t i = 1; i < weights.size(); ++i) pairs += std::int64_t{weights[i]} * weights[i];
  return std::int64_t{weights[0]} * weights[0] + 2 * pairs;
}

/// What the firmware multiplies, shifts by and looks up.
constexpr bool usable(const FitRow& row) {
  const auto fits = [](const FoldedWeights& weights) { return unfoldedEnergy(weights) <= kMostWeightEnergy; };
  return fits(row.basis[0]) && fits(row.basis[1]) && fits(row.gradient[0]) && fits(row.gradient[1]) &&
         row.gradient_exponent >= kLeastGradientExponent && row.gradient_exponent <= kMostGradientExponent &&
         row.triple[0] < kTriples && row.triple[1] < kTriples;
}

/// The sum of what is divided by the deepest reading fits its word.
constexpr bool usable(const StartWeights& weights) {
  return unfoldedEnergy({{0, 0, 0, 0, weights[0], weights[1], weights[2], weights[3]}}) <= kMostWeightEnergy;
}

/// Three near rows' products with readings, and differences of them, fit their words if they are no longer
/// than 1/2, but for rounding.
inline constexpr std::int64_t kMostNearEnergy = (std::int64_t{1} << 28) + (1 << 17);

constexpr bool usable(const NearRow& row) {
  const auto fits = [](std::int16_t middle, std::int16_t sum, std::int16_t difference) {
    return unfoldedEnergy({{middle, sum, 0, 0, difference, 0, 0, 0}}) <= kMostNearEnergy;
  };
  return fits(row.normal[0], row.normal[1], row.normal[2]) && row.normal[3] == 0 &&
         fits(row.normal_load[0], 0, row.normal_load[1]) &&
         fits(row.tangential_load[0], 0, row.tangential_load[1]);
}

/// Where every window is looked at, no start is told.
constexpr bool agree(const std::array<StartWeights, kShares>& start, AnchorRule rule) {
  return rule != AnchorRule::kExhaustive ||
         std::none_of(start.begin(), start.end(), [](const auto& weights) { return weights.tell(); });
}

/// Looks at everything that can be wrong with an image of the right size. Cost: one pass over its bytes.
inline TableFault checkTableImage(const TableImage& image) {
  if (image.magic != kTableMagic) return TableFault::kMagic;
  if (image.format != kTableFormat || image.reserved != 0) return TableFault::kFormat;
  if (image.image_bytes != sizeof(TableImage)) return TableFault::kLength;
  if (image.crc32 != crc32(checkedBytes(image))) return TableFault::kChecksum;
  const bool works = usable(image.parameters, image.constants) && usable(image.gains, image.constants) &&
                     allUsable(image.start) && allUsable(image.rows) && allUsable(image.near) &&
                     agree(image.start, image.constants.anchor_rule);
  return works ? TableFault::kNone : TableFault::kConstants;
}

}  // namespace strainfinger
