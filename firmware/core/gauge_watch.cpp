#include "firmware/core/gauge_watch.hpp"

#include <bit>

namespace strainfinger::firmware {
namespace {

/// Places less than this apart are one and the same [turns * 2^32]: half a pitch of a ring of 16.
constexpr std::uint32_t kOnePlace_q32 = (std::uint32_t{1} << 28) / 2;

}  // namespace

void GaugeWatch::suspect(GaugeSet gauge, std::uint32_t angle_q32) {
  if (gauge == 0) return;
  const auto i = static_cast<std::size_t>(std::countr_zero(gauge));
  const std::uint32_t moved = angle_q32 - lastPlace_q32_[i];
  const bool isElsewhere = moved + kOnePlace_q32 > 2 * kOnePlace_q32;
  if (places_[i] != 0 && !isElsewhere) return;
  lastPlace_q32_[i] = angle_q32;
  if (++places_[i] >= kPlaces) outOfUse_ |= gauge;
}

void GaugeWatch::vindicate(GaugeSet gauges) {
  for (std::size_t i = 0; gauges != 0; ++i, gauges >>= 1) {
    if ((gauges & 1) == 0) continue;
    if (!contains(outOfUse_, static_cast<int>(i))) {
      places_[i] = 0;
    } else if (++right_[i] >= kConvincing) {
      right_[i] = places_[i] = 0;
      outOfUse_ &= ~(GaugeSet{1} << i);
    }
  }
}

}  // namespace strainfinger::firmware
