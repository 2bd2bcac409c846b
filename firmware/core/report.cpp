#include "firmware/core/report.hpp"

#include <algorithm>
#include <bit>
#include <cstdlib>

#include "firmware/core/units.hpp"

namespace strainfinger::firmware {
namespace {

constexpr int kQualityStep = 10;  ///< percent that count as a change

std::int64_t forceOf(const TableConstants& constants, LineLoadQ12 load, int halvings) {
  static_assert(LineLoadQ12::kFracBits == 12);
  return force(constants.force_per_load_q16, load.raw(), halvings);
}

/// Saturates into a field, without the extreme value that is reserved for "not known".
template <typename Raw>
Raw known(std::int64_t value) {
  constexpr Raw kReserved = kNotKnown<Raw>;
  const Raw saturated = saturate<Raw>(value);
  if (saturated != kReserved) return saturated;
  return static_cast<Raw>(kReserved < 0 ? kReserved + 1 : kReserved - 1);
}

/// An error is at least 1: the field's own step is part of it.
template <typename Raw>
Raw knownError(std::int64_t value) {
  return known<Raw>(value < 1 ? 1 : value);
}

std::int8_t alternativeDegrees(const Contact& contact) {
  return known<std::int8_t>(
      wholeDegrees(static_cast<std::int32_t>(contact.alternative.raw() - contact.angle.raw())));
}

std::int32_t angleBetween_cdeg(std::uint16_t a, std::uint16_t b) {
  const std::int32_t apart = std::abs(std::int32_t{a} - b);
  return apart > 18000 ? 36000 - apart : apart;
}

/// A change of a value is news if it exceeds the part of the value's error that is noise.
class News {
 public:
  explicit News(std::uint32_t noiseShare_q8) : noiseShare_q8_(static_cast<std::int32_t>(noiseShare_q8)) {}

  bool in(const ContactFrame& contact, const ContactFrame& last) const {
    return moved(angleBetween_cdeg(contact.angle_cdeg, last.angle_cdeg), contact.sigma_angle_cdeg) ||
           std::abs(contact.quality_percent - last.quality_percent) >= kQualityStep;
  }
  bool in(const ForceFrame& force, const ForceFrame& last) const {
    return moved(std::abs(force.normal_mN - last.normal_mN), force.sigma_normal_half_mN / 2) ||
           moved(std::abs(force.tangential_mN - last.tangential_mN), force.sigma_tangential_half_mN / 2);
  }
  bool in(const PatchFrame& patch, const PatchFrame& last) const {
    constexpr std::uint16_t kUnknown = kNotKnown<std::uint16_t>;
    if ((patch.width_um == kUnknown) != (last.width_um == kUnknown)) return true;
    return moved(std::abs(patch.width_um - last.width_um), patch.sigma_width_um);
  }
  bool in(const SecondContactFrames& second, const SecondContactFrames& last) const {
    return in(second.contact, last.contact) || in(second.force, last.force);
  }

 private:
  bool moved(std::int32_t by, std::int32_t sigma) const { return by > 0 && by > sigma * noiseShare_q8_ >> 8; }

  std::int32_t noiseShare_q8_;
};

ContactFrame contactFrame(const Contact& contact) {
  ContactFrame frame;
  frame.angle_cdeg = static_cast<std::uint16_t>(centidegrees(contact.angle.raw()) % 36000);
  frame.sigma_angle_cdeg = knownError<std::uint16_t>(centidegrees(contact.sigmaAngle.raw()));
  if (contact.ambiguous) frame.alternative_deg = alternativeDegrees(contact);
  frame.quality_percent = contact.quality;
  return frame;
}

ForceFrame forceFrame(const TableConstants& constants, const Contact& contact) {
  ForceFrame frame;
  frame.normal_mN = known<std::int16_t>(forceOf(constants, contact.normal, 0));
  frame.tangential_mN = known<std::int16_t>(forceOf(constants, contact.tangential, 0));
  frame.sigma_normal_half_mN = knownError<std::uint8_t>(forceOf(constants, contact.sigmaNormal, 1));
  frame.sigma_tangential_half_mN = knownError<std::uint8_t>(forceOf(constants, contact.sigmaTangential, 1));
  return frame;
}

PatchFrame patchFrame(const Contact& contact) {
  PatchFrame frame;
  if (contact.width_um != kWidthNotFitted) {
    frame.width_um = known<std::uint16_t>(contact.width_um);
    frame.sigma_width_um = knownError<std::uint16_t>(contact.sigmaWidth_um);
  }
  if (contact.chi_q4 != kNoChi) frame.chi_sixteenths = known<std::uint8_t>(contact.chi_q4);
  return frame;
}

/// Gives each frame the same flags and sequence number.
void label(TouchFrames& frames, FingerFlags flags, std::uint8_t sequence) {
  const auto each = [flags, sequence](auto& frame) {
    frame.flags = flags;
    frame.sequence = sequence;
  };
  each(frames.contact);
  each(frames.force);
  each(frames.patch);
  if (!frames.second) return;
  each(frames.second->contact);
  each(frames.second->force);
}

/// Standard deviation of the noise over that of all errors of the largest reading [* 2^8].
std::uint32_t noiseShare_q8(const Answer& answer) {
  const int down = std::max(16 - std::countl_zero(answer.variances.largest_q4), 0);  // to 16 bits
  const std::uint32_t variance = answer.variances.largest_q4 >> down,
                      noise = answer.variances.noise_q4 >> down;
  return integerRoot((noise << 16) / variance);
}

}  // namespace

TouchFrames touchFrames(const TableConstants& constants, const Contact& contact,
                        const std::optional<Contact>& second, FingerFlags flags, std::uint8_t sequence) {
  TouchFrames frames{contactFrame(contact), forceFrame(constants, contact), patchFrame(contact), {}};
  if (second) frames.second = {{contactFrame(*second)}, {forceFrame(constants, *second)}};
  frames.patch.contacts = second ? 2 : 1;
  label(frames, flags, sequence);
  return frames;
}

TouchFrames releaseFrames(FingerFlags flags, std::uint8_t sequence) {
  TouchFrames frames;
  frames.force.normal_mN = frames.force.tangential_mN = 0;
  label(frames, flags, sequence);
  return frames;
}

GaugesFrame gaugesFrame(GaugeSet outOfUse, const ZeroTracker& tracker, std::uint32_t setsPerSecond) {
  GaugesFrame frame;
  frame.out_of_use = outOfUse;
  if (setsPerSecond == 0) return frame;
  frame.zero_age_s = known<std::uint16_t>(tracker.age_sets() / setsPerSecond);
  if (!tracker.lastChange_q32()) return frame;
  // 10^-9 strain an interval: 10^9 * change / 2^32, with 10^9 = 1953125 * 2^9. A change of 2^28 is beyond
  // every gauge's range.
  const std::int64_t change =
      std::min<std::int32_t>(*tracker.lastChange_q32(), 1 << 28) * std::int64_t{1953125};
  constexpr int kDown = 32 - 9;
  frame.zero_rate_nano_per_s =
      known<std::uint16_t>((change >> kDown) * setsPerSecond / ZeroTracker::kInterval);
  return frame;
}

bool isNews(const TouchFrames& frames, const TouchFrames& last, std::uint32_t noiseShare_q8) {
  if (frames.contact.flags != last.contact.flags) return true;
  if (frames.second.has_value() != last.second.has_value()) return true;
  const News news(noiseShare_q8);
  return news.in(frames.contact, last.contact) || news.in(frames.force, last.force) ||
         news.in(frames.patch, last.patch) || (frames.second && news.in(*frames.second, *last.second));
}

bool TouchReporter::mustBeRepeated(std::uint32_t now_us) const {
  return !any_ || now_us - sentAt_us_ >= std::uint32_t{kContactPeriod_ms} * 1000;
}

FingerFlags TouchReporter::flagsOf(const Observation& observation) const {
  FingerFlags flags = standing_;
  const GaugeSet saturated = observation.saturated & ~observation.outOfUse;
  flags.set(FingerFlag::kContact, observation.touched);
  flags.set(FingerFlag::kSaturated, saturated != 0);
  flags.set(FingerFlag::kDegraded, ((observation.outOfUse | observation.leftOut) & ~saturated) != 0);
  flags.set(FingerFlag::kSeveralContacts, observation.several);
  flags.set(FingerFlag::kStaleZero, observation.staleZero);
  return flags;
}

std::optional<TouchFrames> TouchReporter::frames(const TableConstants& constants,
                                                 const Observation& observation, const Answer& answer,
                                                 const Linearisation& linearisation, std::uint32_t now_us) {
  if (!due(now_us)) {
    isLookedAt_ &= observation.unchanged;
    return std::nullopt;
  }
  const auto next = static_cast<std::uint8_t>(last_.contact.sequence + (any_ ? 1 : 0));
  if (!observation.touched && !isEndOwed_) return std::nullopt;
  if (observation.unchanged && isLookedAt_ && !mustBeRepeated(now_us)) return std::nullopt;
  FingerFlags flags = flagsOf(observation);
  if (!observation.touched) return releaseFrames(flags, next);
  if (!unitErrors_.areOf(linearisation)) unitErrors_ = unitErrors(linearisation);
  const Contact contact = estimate(constants, answer, unitErrors_, 0);
  std::optional<Contact> second;
  if (answer.solution.hypothesis.contacts > 1) second = estimate(constants, answer, unitErrors_, 1);
  flags.set(FingerFlag::kUncertain,
            contact.uncertain || observation.tooFewGauges || (second && second->uncertain));
  const TouchFrames frames = touchFrames(constants, contact, second, flags, next);
  isLookedAt_ = !mustBeRepeated(now_us) && !isNews(frames, last_, noiseShare_q8(answer));
  if (isLookedAt_) return std::nullopt;
  return frames;
}

void TouchReporter::sent(const TouchFrames& frames, std::uint32_t now_us) {
  last_ = frames;
  sentAt_us_ = now_us;
  any_ = isLookedAt_ = true;
  isEndOwed_ = frames.contact.flags.has(FingerFlag::kContact);
}

void TouchReporter::lost() { isEndOwed_ |= any_; }

}  // namespace strainfinger::firmware
