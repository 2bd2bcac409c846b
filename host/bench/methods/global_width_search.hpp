#pragma once
// Maximum likelihood over the whole ring, all places and all widths.

#include <algorithm>
#include <limits>

#include "host/bench/methods/width_fit.hpp"

namespace strainfinger::bench {

template <typename Real>
struct WidthBank {
  static constexpr std::size_t kPerPitch = 16, kWidths = 8;
  /// Of a contact `place` / kPerPitch pitches beyond gauge 0 that half slips, with moments as below.
  std::array<std::array<Projection<Real, kGauges>, kWidths>, kPerPitch> rows;

  /// Even steps of the width.
  static constexpr Real momentOf(std::size_t width) {
    const Real part = (static_cast<Real>(width) + Real{0.5}) / kWidths;
    return part * part;
  }
};

/// Explained energy on a grid of 256 places and 8 widths; every maximum that explains at least half as much
/// as the best is stepped to its end over all gauges, and the possible one that leaves least is the answer.
template <typename Real>
class GlobalWidthSearch {
 public:
  GlobalWidthSearch(const PatchTable<Real>& table, const WidthBank<Real>& bank)
      : table_(table), bank_(bank) {}

  Place<Real> operator()(const Ring<Real>& strain) {
    const Real worthwhile = project(strain) / 2;
    WideMinimum<Real> best{{placeWithoutLoads(std::numeric_limits<Real>::quiet_NaN()), 0}, kNothing};
    for (int point = 0; point < kPoints; ++point)
      for (int width = 0; width < kWidths; ++width) {
        if (energyAt(point, width) < worthwhile || !isMaximum(point, width)) continue;
        const auto end =
            fitWidth<kGauges, Real>(table_, strain, {placeAt(point, width), momentOf(width)}, kSteps);
        if (isPossible(end.contact.place) && end.residual < best.residual) best = end;
      }
    return best.contact.place;
  }

 private:
  using Bank = WidthBank<Real>;
  using Shadow = typename Projection<Real, kGauges>::Shadow;
  static constexpr int kPerPitch = Bank::kPerPitch, kWidths = Bank::kWidths;
  static constexpr int kPoints = kPerPitch * kGauges;
  static constexpr int kSteps = 20;
  static constexpr Real kNothing = std::numeric_limits<Real>::max();

  static Real momentOf(int width) { return Bank::momentOf(static_cast<std::size_t>(width)); }
  static std::size_t indexOf(int point, int width) {
    return static_cast<std::size_t>((point + kPoints) % kPoints * kWidths + width);
  }
  const auto& rowOf(int point, int width) const {
    return bank_.rows[static_cast<std::size_t>(point % kPerPitch)][static_cast<std::size_t>(width)];
  }
  Real energyAt(int point, int width) const { return shadow_[indexOf(point, width)].energy(); }
  Place<Real> placeAt(int point, int width) const {
    return rowOf(point, width).placeOf(static_cast<Real>(point) / kPerPitch, shadow_[indexOf(point, width)]);
  }
  bool isMaximum(int point, int width) const {
    const Real here = energyAt(point, width);
    for (int beside = -1; beside <= 1; ++beside)
      for (int other = std::max(width - 1, 0); other <= std::min(width + 1, kWidths - 1); ++other)
        if (energyAt(point + beside, other) > here) return false;
    return true;
  }

  /// The most that any point explains.
  Real project(const Ring<Real>& strain) {
    Ring<Real> turned = strain;
    Real most{};
    for (int point = 0; point < kPoints; ++point) {
      for (int width = 0; width < kWidths; ++width) {
        shadow_[indexOf(point, width)] = rowOf(point, width).of(turned);
        most = std::max(most, energyAt(point, width));
      }
      if ((point + 1) % kPerPitch == 0) std::rotate(turned.begin(), turned.begin() + 1, turned.end());
    }
    return most;
  }

  const PatchTable<Real>& table_;
  const Bank& bank_;
  std::array<Shadow, static_cast<std::size_t>(kPoints* kWidths)> shadow_;
};

}  // namespace strainfinger::bench
