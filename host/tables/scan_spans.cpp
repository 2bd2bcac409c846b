#include "host/tables/scan_spans.hpp"

#include <algorithm>
#include <cmath>

#include "host/tables/pressed_ring.hpp"

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

void noteContact(const PressedRing& ring, std::array<Distances, kShares>& distances) {
  if (ring.share() == 0) return;
  note(distances, ring.share(), std::abs(ring.offset_pitch()) * kRowsPerPitch,
       std::abs(ring.position_pitch) * kRowsPerPitch);
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
  for (int step = -kSpanOffsets; step <= kSpanOffsets; ++step) {
    const RingResponse here(response, gaugeCount, 0.5 * step / kSpanOffsets);
    for (int direction = -kSpanDirections; direction <= kSpanDirections; ++direction)
      noteContact(here.pressed(widest * direction / kSpanDirections), distances);
  }
  std::array<ScanSpan, kShares> spans{};
  std::transform(distances.begin(), distances.end(), spans.begin(), spanOf);
  return spans;
}

}  // namespace strainfinger::tables
