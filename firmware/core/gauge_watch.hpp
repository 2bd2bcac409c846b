#pragma once
// Which gauges are not to be trusted.

#include <array>
#include <bit>
#include <cstdint>

#include "firmware/core/hypothesis.hpp"

namespace strainfinger::firmware {

/// Takes a gauge out of use when it alone explains what is wrong with the readings at several places, when it
/// is at a rail and the others leave no doubt that it should not be, or when its zero is at a rail. Several
/// places, because a second contact, a wide one or a finger that differs from its drawing may look like a
/// failing gauge at one place, but like another gauge's failure at the next.
class GaugeWatch {
 public:
  GaugeSet outOfUse() const { return outOfUse_; }
  /// Gauges that touches may clear: suspects, and those out of use.
  GaugeSet watched() const { return suspects_ | outOfUse_; }

  /// Gauges that are known not to work.
  void takeOut(GaugeSet gauges) { outOfUse_ |= gauges; }
  /// Once a touched sample set, and after lookBack(): the suspect, if there is one, and the contact's angle.
  void suspect(GaugeSet gauge, std::uint32_t angle_q32);
  /// Gauges at a rail that should be well within their range: two sets in a row take them out of use. Returns
  /// true if that takes out any.
  bool implausiblyAtRail(GaugeSet gauges) {
    const GaugeSet out = gauges & atRail_ & ~outOfUse_;
    atRail_ = gauges;
    if (out == 0) return false;
    outOfUse_ |= out;
    railed_ |= out;
    return true;
  }
  /// Of these, those that are out of use because they were at a rail come back.
  void noLongerAtRail(GaugeSet gauges) { comeBack(gauges & railed_); }
  /// Gauges that feel a touch and read what they should, or are `wrong`. A right one in use is no longer
  /// suspect; one out of use comes back after kConvincing such sets with none between in which it was wrong.
  void vindicate(GaugeSet right, GaugeSet wrong);

  static constexpr int kPlaces = 3;       ///< in a row at which a gauge is suspected before it is out of use
  static constexpr int kConvincing = 64;  ///< right sets that bring one back

 private:
  void comeBack(GaugeSet gauges) {
    suspects_ &= ~gauges;
    outOfUse_ &= ~gauges;
    railed_ &= ~gauges;
    forget(gauges);
  }
  void forget(GaugeSet gauges) {
    for (GaugeSet left = gauges; left != 0; left &= left - 1) right_[index(std::countr_zero(left))] = 0;
  }

  /// A place no further than this from the last one is the same [turns * 2^16]: half a pitch of a ring of 16.
  /// Back at an earlier one it is another touch, which counts: two places to and fro are three.
  static constexpr std::uint16_t kOnePlace_q16 = (1 << 12) / 2;

  std::array<std::uint8_t, kMaxGauges> places_{};
  std::array<std::uint8_t, kMaxGauges> right_{};  ///< right sets of gauges out of use
  std::array<std::uint16_t, kMaxGauges> lastPlace_q16_{};
  GaugeSet outOfUse_ = 0;
  GaugeSet suspects_ = 0;  ///< at one place or more
  GaugeSet atRail_ = 0;    ///< in the last set
  GaugeSet railed_ = 0;    ///< out of use because they were, and for no other reason
};

inline void GaugeWatch::suspect(GaugeSet gauge, std::uint32_t angle_q32) {
  if (gauge == 0) return;
  const auto i = index(std::countr_zero(gauge));
  const auto place_q16 = static_cast<std::uint16_t>(angle_q32 >> 16);
  const auto moved_q16 = static_cast<std::uint16_t>(place_q16 - lastPlace_q16_[i] + kOnePlace_q16);
  const bool isElsewhere = moved_q16 > 2 * kOnePlace_q16;
  if ((suspects_ & gauge) != 0 && !isElsewhere) return;
  if ((suspects_ & gauge) == 0) places_[i] = 0;
  suspects_ |= gauge;
  lastPlace_q16_[i] = place_q16;
  if (++places_[i] >= kPlaces) outOfUse_ |= gauge;
}

inline void GaugeWatch::vindicate(GaugeSet right, GaugeSet wrong) {
  suspects_ &= ~right | outOfUse_;
  forget(wrong);
  for (GaugeSet left = right & outOfUse_; left != 0; left &= left - 1) {
    const auto i = index(std::countr_zero(left));
    if (++right_[i] == kConvincing) comeBack(GaugeSet{1} << i);
  }
}

}  // namespace strainfinger::firmware
