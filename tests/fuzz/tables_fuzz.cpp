// Any codes for any tables that checkTableImage() accepts: the default ones, with groups of their numbers
// replaced by any that are in their domain, or near it.

#include <algorithm>
#include <bit>
#include <memory>

#include "default_tables.hpp"
#include "tests/fuzz/driven_pipeline.hpp"

using namespace strainfinger;
using namespace strainfinger::fuzz;

namespace {

/// Of a patch too long to be usable, as much as is.
void shorten(ResponsePatch& patch) {
  while (!usable(patch))
    for (std::int16_t& weight : patch) weight = static_cast<std::int16_t>(weight / 2);
}

/// Some patches of the table, or all of them, replaced by a few others.
void changePatches(Input& input, TableImage& image) {
  std::array<PatchPair, 6> others;
  const auto kinds = static_cast<std::size_t>(input.within(1, int{others.size()}));
  for (PatchPair& other : std::span(others).first(kinds)) {
    other = input.any<PatchPair>();
    shorten(other.normal);
    shorten(other.tangential);
  }
  const auto every = static_cast<std::size_t>(input.within(1, 16)),
             first = static_cast<std::size_t>(input.within(0, 15));
  for (std::size_t i = first; i < image.patches.size(); i += every)
    image.patches[i] = others[i / every % kinds];
}

void changeNoise(Input& input, TableConstants& constants) {
  constants.noise_variance = input.within<std::uint32_t>(0, kMostNoiseVariance);
  constants.noise_variance_exponent =
      static_cast<std::int8_t>(input.within(kLeastNoiseExponent, kMostNoiseExponent));
  constants.gate_on = input.any<std::uint32_t>();
  constants.gate_off = input.any<std::uint32_t>();
  constants.model_error_q16 = input.any<std::uint16_t>();
}

void changeErrors(Input& input, TableConstants& constants) {
  constants.place_error_q32 = input.within<std::uint32_t>(0, kMostPlaceError_q32);
  constants.load_scale_error_q16 = input.any<std::uint16_t>();
  constants.load_error_q16 = input.any<std::uint16_t>();
  constants.moment_error_q16 = input.any<std::uint16_t>();
}

void changeScales(Input& input, TableConstants& constants) {
  constants.gate_shift = static_cast<std::uint8_t>(input.within(0, kMostGateShift));
  constants.reading_gain = input.within<std::int32_t>(0, (1 << (16 + constants.gate_shift)) - 2);
  constants.load_scale = input.any<std::int32_t>();
  constants.load_exponent =
      static_cast<std::int16_t>(-3 - constants.gate_shift - input.any<std::uint16_t>() / 2);
  constants.force_per_load_q16 = input.any<std::uint32_t>();
  constants.adc_rail = input.any<std::uint16_t>();
}

/// Edges of cells in any order would hardly ever ascend.
void changeCells(Input& input, TableConstants& constants) {
  constants.cell_count = static_cast<std::uint8_t>(input.within(1, kMostCells));
  constants.node_count =
      static_cast<std::uint16_t>(input.within(kLeastNodes, kMostPatches / constants.cell_count));
  const auto edges = std::span(constants.cell_edge_q15).first(constants.cell_count + std::size_t{1});
  for (std::uint16_t& edge : edges) edge = input.within<std::uint16_t>(1, (1 << 15) - 1);
  edges.front() = 0;
  edges.back() = 1 << 15;
  std::sort(edges.begin(), edges.end());
  for (std::uint16_t& rate : constants.cell_rate_q8) rate = input.any<std::uint16_t>();
}

void changeAngles(Input& input, TableImage& image) {
  image.constants.gauge_count = static_cast<std::uint8_t>(2 * input.within(kMinGauges / 2, kMaxGauges / 2));
  const std::uint32_t first = input.any<std::uint32_t>(), step = input.any<std::uint32_t>();
  for (std::size_t i = 0; i < image.gauge_angle_q32.size(); ++i)
    image.gauge_angle_q32[i] = first + static_cast<std::uint32_t>(i) * step;
  image.constants.reach_q32 = input.any<std::uint32_t>();
}

void changeGains(Input& input, GaugeGains& gains) {
  gains.are_known = static_cast<std::uint8_t>(input.within(0, 1));
  for (std::int16_t& each : gains.correction_q14) each = input.any<std::int16_t>();
}

void changeDepths(Input& input, GaugeDepths& depths) {
  depths.step_nm = input.any<std::uint16_t>();
  for (std::int16_t* slope : {&depths.normal_turn_q11, &depths.tangential_turn_q11, &depths.tangential_q15})
    *slope = input.any<std::int16_t>();
  depths.shape_shift = static_cast<std::uint8_t>(input.within(0, kMostDepthShapeShift));
  for (GaugeDepths::Shape* shape : {&depths.normal_shape, &depths.tangential_shape})
    for (std::int8_t& each : *shape) each = input.any<std::int8_t>();
  for (std::int8_t& each : depths.steps) each = input.any<std::int8_t>();
}

void changeContacts(Input& input, TableConstants& constants) {
  constants.width_is_known = static_cast<std::uint8_t>(input.within(0, 1));
  constants.known_moment_q20 = input.within<std::uint32_t>(0, 1 << kMomentBits);
  constants.largest_moment_um2 = input.any<std::uint32_t>();
  constants.friction_q8 = input.any<std::uint16_t>();
  constants.cone_q8 = input.any<std::uint16_t>();
  constants.mirror_sign = static_cast<std::int8_t>(2 * input.within(0, 1) - 1);
  constants.peak_sign = static_cast<std::int8_t>(2 * input.within(0, 1) - 1);
}

/// Bit i of the first byte: the i-th group is changed.
void change(Input& input, TableImage& image) {
  const auto groups = input.any<std::uint8_t>();
  const auto isChanged = [groups](int group) { return (groups >> group & 1) != 0; };
  if (isChanged(0)) changeNoise(input, image.constants);
  if (isChanged(1)) changeScales(input, image.constants);
  if (isChanged(2)) changeCells(input, image.constants);
  if (isChanged(3)) changeAngles(input, image);
  if (isChanged(4)) changeGains(input, image.gains);
  if (isChanged(5)) changeContacts(input, image.constants);
  if (isChanged(6)) changePatches(input, image);
  if (isChanged(7)) {
    changeErrors(input, image.constants);
    changeDepths(input, image.depths);
  }
  image.crc32 = crc32(checkedBytes(image));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const TableImage defaults = std::bit_cast<TableImage>(kDefaultTableBytes);
  Input input({data, size});
  const auto image = std::make_unique<TableImage>(defaults);
  change(input, *image);
  if (checkTableImage(*image) == TableFault::kNone) DrivenPipeline(*image, input).run();
  return 0;
}
