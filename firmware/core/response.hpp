#pragma once
// A gauge's reading of a unit load, looked up in the tables at the gauge's own angle from the contact.

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

/// Where an angle between gauge and contact lies in the tables.
struct AngleNode {
  int node;
  Number t_q15;   ///< from the node; +-2^15 is half way to a neighbour
  bool mirrored;  ///< the gauge is on the contact's clockwise side
};

/// `distance_q32`: the gauge's angle minus the contact's, TurnQ32.
inline AngleNode angleNode(const TableConstants& constants, std::uint32_t distance_q32) {
  const bool mirrored = distance_q32 >> 31 != 0;
  std::uint32_t size = mirrored ? 0 - distance_q32 : distance_q32;
  size -= size >> 31;  // so that half a revolution belongs to the last node
  const std::uint64_t position = std::uint64_t{2 * size} * constants.node_count;  // [nodes * 2^32]
  return {static_cast<int>(position >> 32),
          static_cast<Number>(static_cast<std::uint32_t>(position) >> 16) - (1 << 15), mirrored};
}

/// The angle [turns * 2^32] that t = 1 stands for, half of that between two nodes.
inline Number halfNode_q32(const TableConstants& constants) {
  return static_cast<Number>((std::uint32_t{1} << 30) / constants.node_count);
}

/// Where an angle lies in the shapes of what a gauge's own depth adds to its responses (GaugeDepths).
struct ShapePoint {
  std::size_t part;
  Number along_q15;  ///< from its first point, 0 .. 2^15 at its second
};

/// `distance_q32` as in angleNode(); the shapes are the same on both sides of the contact.
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

/// In units of the largest response [* 2^30]: |value| < 2^30, |slope| and |widening| < 2^31.
struct Response {
  Number value_q30;
  Number slope_q30;     ///< d value / dt
  Number widening_q30;  ///< d value / ds
};

/// The patch's weights add up to less than 2^15 in magnitude, as usable() checks: no sum here overflows.
inline Response responseOf(const ResponsePatch& patch, Number s, Number t) {
  const Number curved = patch[3] * t;
  const Number along_q30 = patch[2] * (1 << 15) + patch[4] * s + curved;
  return {patch[0] * (1 << 15) + patch[1] * s + patch[5] * (s * s >> 15) + t * (along_q30 >> 15),
          along_q30 + curved, patch[1] * (1 << 15) + 2 * (patch[5] * s) + patch[4] * t};
}

}  // namespace strainfinger::firmware
