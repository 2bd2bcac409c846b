#include "host/tables/scan_spans.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace strainfinger::tables {
namespace {

constexpr int kSpanOffsets = 64;
constexpr int kSpanDirections = 64;
constexpr double kLeastSpanCone = 1;  ///< without friction, noise is still taken for tangential loads
constexpr double kShareMargin = 1.0 / 64;

/// A step finds the maximum from a little farther than half a spacing of the scan's rows.
constexpr double kSlack_rows = 2;

/// Distances that contacts of a share may have.
struct Distances {
  double least = kRowsPerPitch;  ///< from the deepest gauge ..
  double most = 0;
  double nearest = kRowsPerPitch / 2;  ///< .. and the least from any [rows]
};

/// A ring's readings of unit normal and tangential loads, from the gauge nearest to the contact on.
struct PressedRing {
  PressedRing(const model::ImpulseResponse& response, int gaugeCount, double offset_pitch) {
    for (int gauge = 0; gauge < gaugeCount; ++gauge) {
      const auto value = response.at((gauge - offset_pitch) * 2 * std::numbers::pi / gaugeCount);
      normal.push_back(value.normal);
      tangential.push_back(value.tangential);
    }
  }
  std::vector<double> normal, tangential;
};

void note(std::array<Distances, kShares>& distances, double share, double fromDeepest_rows,
          double fromNearest_rows) {
  const auto bin = [](double value) {
    return static_cast<std::size_t>(std::clamp(value * kShares, 0.0, kShares - 1.0));
  };
  for (std::size_t i = bin(share - kShareMargin); i <= bin(share + kShareMargin); ++i) {
    Distances& each = distances[i];
    each.least = std::min(each.least, fromDeepest_rows);
    each.most = std::max(each.most, fromDeepest_rows);
    each.nearest = std::min(each.nearest, fromNearest_rows);
  }
}

void noteContact(const PressedRing& ring, double sign, double direction, double offset_pitch,
                 std::array<Distances, kShares>& distances) {
  double energy = 0, deepest = 0;
  std::size_t gauge = 0;
  for (std::size_t i = 0; i < ring.normal.size(); ++i) {
    const double reading = sign * (ring.normal[i] + direction * ring.tangential[i]);
    energy += reading * reading;
    if (reading > deepest) {
      deepest = reading;
      gauge = i;
    }
  }
  if (energy == 0) return;
  const double apart =
      std::remainder(static_cast<double>(gauge) - offset_pitch, static_cast<double>(ring.normal.size()));
  note(distances, deepest * deepest / energy, std::abs(apart) * kRowsPerPitch,
       std::abs(offset_pitch) * kRowsPerPitch);
}

/// The row of a scan from whose half spacing on an offset lies.
int rowFrom(double offset_rows) {
  const double spacings = std::floor((offset_rows + kSlack_rows) / kMaxScanStep);
  return std::min(kFirstScanRow + kMaxScanStep * static_cast<int>(std::max(spacings, 0.0)), kLastScanRow);
}
int rowTo(double offset_rows) {
  const double spacings = std::ceil((offset_rows - kSlack_rows) / kMaxScanStep);
  return std::max(kFirstScanRow, kMaxScanStep * static_cast<int>(spacings) - kFirstScanRow);
}

ScanSpan spanOf(const Distances& distances) {
  if (distances.most == 0) return ScanSpan::of(kFirstScanRow, kLastScanRow);  // no contact has this share
  const int last = rowTo(distances.most);
  if (last > kLastScanRow) return ScanSpan::of(rowFrom(distances.nearest), 0);
  return ScanSpan::of(std::min(rowFrom(distances.least), last), last);
}

}  // namespace

std::array<ScanSpan, kShares> scanSpans(const model::ImpulseResponse& response, int gaugeCount, double cone) {
  const double widest = std::max(cone, kLeastSpanCone);
  std::array<Distances, kShares> distances;
  const double sign = response.at(0).normal < 0 ? -1 : 1;
  for (int step = -kSpanOffsets; step <= kSpanOffsets; ++step) {
    const double offset_pitch = 0.5 * step / kSpanOffsets;
    const PressedRing ring(response, gaugeCount, offset_pitch);
    for (int direction = -kSpanDirections; direction <= kSpanDirections; ++direction)
      noteContact(ring, sign, widest * direction / kSpanDirections, offset_pitch, distances);
  }
  std::array<ScanSpan, kShares> spans{};
  std::transform(distances.begin(), distances.end(), spans.begin(), spanOf);
  return spans;
}

}  // namespace strainfinger::tables
