#include "firmware/core/gauge_watch.hpp"

#include <bit>

namespace strainfinger::firmware {
namespace {

/// Places less than this apart are one and the same [turns * 2^32]: half a pitch of a ring of 16.
constexpr std::uint32_t kOnePlace_q32 = (std::uint32_t{1} << 28) / 2;

}  // namespace

void GaugeWatch::suspect(GaugeSet gauge, std::uint32_t angle_q32) {
  if (gauge == 0) return;
  const auto i = index(std::countr_zero(gauge));
  const std::uint32_t moved = angle_q32 - lastPlace_q32_[i];
  const bool isElsewhere = moved + kOnePlace_q32 > 2 * kOnePlace_q32;
  if ((suspects_ & gauge) != 0 && !isElsewhere) return;
  if ((suspects_ & gauge) == 0) places_[i] = 0;
  suspects_ |= gauge;
  lastPlace_q32_[i] = angle_q32;
  if (++places_[i] >= kPlaces) outOfUse_ |= gauge;
}

void GaugeWatch::vindicate(GaugeSet right, GaugeSet wrong) {
  suspects_ &= ~right | outOfUse_;
  for (GaugeSet left = wrong; left != 0; left &= left - 1) right_[index(std::countr_zero(left))] = 0;
  for (GaugeSet left = right & outOfUse_; left != 0; left &= left - 1) {
    const auto i = index(std::countr_zero(left));
    if (++right_[i] < kConvincing) continue;
    right_[i] = 0;
    suspects_ &= ~(GaugeSet{1} << i);
    outOfUse_ &= ~(GaugeSet{1} << i);
  }
}

}  // namespace strainfinger::firmware
