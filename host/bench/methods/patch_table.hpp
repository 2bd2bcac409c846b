#pragma once
// The firmware's table of responses in floating point: what fits of the width read.

#include <algorithm>
#include <cmath>

#include "host/bench/methods/sample.hpp"

namespace strainfinger::bench {

/// A contact of some width.
template <typename Real>
struct WidePlace {
  Place<Real> place;
  Real moment;  ///< second moment of its pressure, a fraction of the widest one's: 0 .. 1
};

/// What a gauge reads per N/m, and its derivatives by the distance to the contact in pitches and by moment.
template <typename Real>
struct SpreadResponse {
  Real value, slope, widening;
};

template <typename Real>
struct PatchTable {
  static constexpr int kNodes = 100;  ///< over half a revolution
  static constexpr int kCells = 10;
  static constexpr Real kFriction = 1;

  /// Weights of 1, s, t, t^2, s t, s^2, as in ResponsePatch.
  using Patch = std::array<Real, 6>;
  struct Pair {
    Patch normal, tangential;
  };

  std::array<Real, kCells + 1> edge;        ///< of the cells of the moment
  std::array<Pair, kNodes * kCells> patch;  ///< node by node [strain per N/m]

  struct Both {
    SpreadResponse<Real> normal, tangential;
  };

  /// Of a gauge so many pitches beyond the contact, within two revolutions. The tangential load's moment is
  /// by Mindlin's relation.
  Both at(Real pitches, const WidePlace<Real>& contact) const {
    const Real part = 1 - slip(contact.place) / 2;  // of twice the pressure's moment
    const Node node = nodeOf(pitches);
    const Cell normal = cellOf(contact.moment), tangential = cellOf(contact.moment * part);
    Both both{response(pairAt(node, normal).normal, normal, node),
              response(pairAt(node, tangential).tangential, tangential, node)};
    both.tangential.widening *= part;
    if (node.mirrored) {
      both.tangential.value = -both.tangential.value;
      both.tangential.widening = -both.tangential.widening;
      both.normal.slope = -both.normal.slope;
    }
    return both;
  }

  /// |tangential| / (friction * normal), at most 1: how much of the contact slips.
  static Real slip(const Place<Real>& place) {
    const Real most = kFriction * place.normal, pull = std::abs(place.tangential);
    return pull < most ? pull / most : Real{1};
  }

 private:
  struct Cell {
    int number;
    Real s, rate;  ///< -1 .. 1 over the cell; ds / d(moment)
  };
  struct Node {
    int number;
    Real t;  ///< -1 .. 1 over the node's angles
    bool mirrored;
  };
  static constexpr Real kNodesPerPitch = Real{2} * kNodes / kGauges;

  Cell cellOf(Real moment) const {
    int cell = 0;
    while (cell + 1 < kCells && moment >= edge[static_cast<std::size_t>(cell + 1)]) ++cell;
    const Real low = edge[static_cast<std::size_t>(cell)], high = edge[static_cast<std::size_t>(cell + 1)];
    const Real rate = 2 / (high - low);
    return {cell, (moment - (low + high) / 2) * rate, rate};
  }
  static Node nodeOf(Real pitches) {
    constexpr Real kRing = kGauges;
    Real distance = pitches;
    while (distance > kRing / 2) distance -= kRing;
    while (distance < -kRing / 2) distance += kRing;
    const Real position = std::abs(distance) * kNodesPerPitch;
    const int node = std::min(static_cast<int>(position), kNodes - 1);
    return {node, 2 * (position - static_cast<Real>(node)) - 1, distance < 0};
  }
  const Pair& pairAt(const Node& node, const Cell& cell) const {
    return patch[static_cast<std::size_t>(node.number * kCells + cell.number)];
  }
  static SpreadResponse<Real> response(const Patch& w, const Cell& cell, const Node& node) {
    const Real s = cell.s, t = node.t;
    return {w[0] + s * (w[1] + s * w[5] + t * w[4]) + t * (w[2] + t * w[3]),
            (w[2] + 2 * t * w[3] + s * w[4]) * 2 * kNodesPerPitch,
            (w[1] + 2 * s * w[5] + t * w[4]) * cell.rate};
  }
};

}  // namespace strainfinger::bench
