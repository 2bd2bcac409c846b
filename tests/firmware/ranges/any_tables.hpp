#pragma once
// Tables at the ends of what checkTableImage() accepts. What is looked up is linear in a patch's weights,
// whose sizes add up to less than 2^15: it is largest and smallest where one weight is as large as it may be.

#include <array>
#include <cstdint>
#include <memory>

#include "common/table_image.hpp"

namespace strainfinger::firmware {

/// Calls visit for each patch of one weight, of either sign.
template <typename Visit>
void forEachPatch(Visit visit) {
  for (std::size_t weight = 0; weight < ResponsePatch{}.size(); ++weight)
    for (const int sign : {-1, 1}) {
      ResponsePatch patch{};
      patch[weight] = static_cast<std::int16_t>(sign * 32767);
      visit(patch);
    }
}

/// Accepted tables for a ring of that many gauges: the narrowest cell that there can be, and one of all the
/// rest; rates as high as they may be.
inline std::unique_ptr<TableImage> tablesOf(const PatchPair& patches, int gauges = kMaxGauges) {
  auto image = std::make_unique<TableImage>();
  image->magic = kTableMagic;
  image->format = kTableFormat;
  image->image_bytes = sizeof(TableImage);
  TableConstants& constants = image->constants;
  constants.gauge_count = static_cast<std::uint8_t>(gauges);
  constants.gate_shift = kMostGateShift;
  constants.load_exponent = -3 - kMostGateShift;
  constants.mirror_sign = constants.peak_sign = 1;
  constants.cone_q8 = constants.friction_q8 = 0xFFFF;
  constants.node_count = kLeastNodes;
  constants.cell_count = 2;
  constants.cell_edge_q15 = {0, 1, 1 << 15};
  constants.cell_rate_q8 = {0xFFFF, (2 << 23) / ((1 << 15) - 1) + 1};
  constants.reach_q32 = 0x7FFFFFFF;
  for (std::size_t i = 0; i < static_cast<std::size_t>(gauges); ++i)
    image->gauge_angle_q32[i] = static_cast<std::uint32_t>(i) << 27;
  image->patches.fill(patches);
  image->crc32 = crc32(checkedBytes(*image));
  return image;
}

}  // namespace strainfinger::firmware
