#pragma once
// What a gauge reads of a unit load, looked up in the tables at the gauge's own distance from the contact.

#include "common/table_image.hpp"
#include "firmware/core/integers.hpp"

namespace strainfinger::firmware {

/// Where a second moment lies in the tables.
struct MomentCell {
  int cell;
  Number s_q15;    ///< from the cell's middle, -2^15 .. 2^15 over the cell
  Number rate_q8;  ///< ds / d(moment)
};

inline MomentCell momentCell(const TableConstants& constants, Number moment_q20) {
  constexpr int kUp = kMomentBits - 15;
  int cell = 0;
  while (cell + 1 < constants.cell_count &&
         moment_q20 >= constants.cell_edge_q15[static_cast<std::size_t>(cell + 1)] << kUp)
    ++cell;
  const auto at = static_cast<std::size_t>(cell);
  const Number middle = (constants.cell_edge_q15[at] + constants.cell_edge_q15[at + 1]) << (kUp - 1);
  const Number rate_q8 = constants.cell_rate_q8[at];
  return {cell, limited(scaled<kMomentBits + 8 - 15>(moment_q20 - middle, rate_q8), 1 << 15), rate_q8};
}

/// Where a distance lies in the tables.
struct AngleNode {
  int node;
  Number t_q15;   ///< from the node, -2^15 .. 2^15 half way to its neighbours
  bool mirrored;  ///< the gauge is on the contact's clockwise side
};

/// `distance_q32`: the gauge's angle minus the contact's, TurnQ32.
inline AngleNode angleNode(const TableConstants& constants, std::uint32_t distance_q32) {
  const bool mirrored = distance_q32 >> 31 != 0;
  const std::uint32_t size = mirrored ? 0 - distance_q32 : distance_q32;
  const std::uint64_t position = std::uint64_t{size} * constants.node_count;  // [nodes * 2^31]
  const auto node = static_cast<int>(position >> 31);
  if (node >= constants.node_count) return {constants.node_count - 1, (1 << 15) - 1, mirrored};
  return {node, static_cast<Number>(static_cast<std::uint32_t>(position >> 15) & 0xFFFF) - (1 << 15),
          mirrored};
}

/// Turns [* 2^32] of t = 1: half the angle between two nodes.
inline Number halfNode_q32(const TableConstants& constants) {
  return static_cast<Number>((std::uint32_t{1} << 30) / constants.node_count);
}

/// Where a distance lies in the shapes of what a gauge's depth adds.
struct ShapePoint {
  std::size_t part;
  Number along_q15;  ///< from its first point, 0 .. 2^15 at its second
};

/// `distance_q32` as in angleNode(); shapes are the same on either side.
inline ShapePoint shapePoint(std::uint32_t distance_q32) {
  constexpr std::uint32_t kParts = kDepthShapePoints - 1;
  const std::uint32_t size = distance_q32 >> 31 != 0 ? 0 - distance_q32 : distance_q32;
  const std::uint64_t position = std::uint64_t{size} * kParts;  // [parts * 2^31]
  const auto part = static_cast<std::uint32_t>(position >> 31);
  if (part >= kParts) return {kParts - 1, 1 << 15};
  return {part, static_cast<Number>(static_cast<std::uint32_t>(position >> 16) & 0x7FFF)};
}

/// |value| <= 2^(7 + shift).
inline Number shapeAt(const GaugeDepths::Shape& shape, int shift, const ShapePoint& point) {
  const Number from = shape[point.part], to = shape[point.part + 1];
  return ((from * (1 << 15) + (to - from) * point.along_q15) * (1 << shift)) >> 15;
}

/// [* 2^15 of the largest response]: |value| < 2^15, |slope| and |widening| < 2^16.
struct Response {
  Number value;
  Number slope;     ///< d value / dt
  Number widening;  ///< d value / ds
};

/// Of a patch whose weights' sizes add up to less than 2^15 (usable()): each sum stays below 2^31.
inline Number valueOf(const ResponsePatch& patch, Number s, Number t) {
  return ((patch[0] << 15) + (1 << 14) + patch[1] * s + patch[2] * t + patch[3] * (t * t >> 15) +
          patch[4] * (s * t >> 15) + patch[5] * (s * s >> 15)) >>
         15;
}
inline Number slopeOf(const ResponsePatch& patch, Number s, Number t) {
  return patch[2] + ((2 * patch[3] * t + patch[4] * s) >> 15);
}
inline Response responseOf(const ResponsePatch& patch, Number s, Number t) {
  return {valueOf(patch, s, t), slopeOf(patch, s, t), patch[1] + ((2 * patch[5] * s + patch[4] * t) >> 15)};
}

}  // namespace strainfinger::firmware
