#pragma once
// From observations to frames worth sending.

#include <cstdint>
#include <optional>

#include "common/contact.hpp"
#include "common/frames.hpp"
#include "common/table_image.hpp"
#include "firmware/core/estimate.hpp"
#include "firmware/core/pipeline.hpp"

namespace strainfinger::firmware {

/// The frames of a second contact.
struct SecondContactFrames {
  Contact2Frame contact;
  Force2Frame force;
  bool operator==(const SecondContactFrames&) const = default;
};

/// All frames of one sequence number. They have the same flags.
struct TouchFrames {
  ContactFrame contact;
  ForceFrame force;
  PatchFrame patch;
  std::optional<SecondContactFrames> second;
};

/// The frames' integers: rounded to nearest, saturating at the ends of their fields. The patch is that of the
/// first contact.
TouchFrames touchFrames(const TableConstants& constants, const Contact& contact,
                        const std::optional<Contact>& second, FingerFlags flags, std::uint8_t sequence);

/// What is said once when nothing touches the finger any more: no force, and a place and a width that are not
/// known.
TouchFrames releaseFrames(FingerFlags flags, std::uint8_t sequence);

/// What a GAUGES frame says; age and rate are not known before there are sample sets by the second.
GaugesFrame gaugesFrame(GaugeSet outOfUse, const ZeroTracker& tracker, std::uint32_t setsPerSecond);

/// All of a value's error is noise.
inline constexpr std::uint32_t kOnlyNoise_q8 = 1 << 8;

/// Whether something changed by more than its own error's part that is noise, a quality by ten percent, or a
/// flag, the number of contacts or whether the width is known at all.
bool isNews(const TouchFrames& frames, const TouchFrames& last, std::uint32_t noiseShare_q8 = kOnlyNoise_q8);

/// When to say something: at most at the contact rate; when there is news; at least every kContactPeriod_ms
/// in contact; once when contact ends. Otherwise never.
class TouchReporter {
 public:
  /// `standing`: flags that hold for every frame (simulated, uncalibrated ..). `isEndOwed`: somebody may have
  /// said a touch before.
  TouchReporter(std::uint32_t shortestPeriod_us, FingerFlags standing, bool isEndOwed = false)
      : shortestPeriod_us_(shortestPeriod_us), standing_(standing), isEndOwed_(isEndOwed) {}

  /// The frames to send for an observation, if any. The caller says with sent() that they went out;
  /// otherwise the next observation replaces them, so that nothing old is ever sent.
  std::optional<TouchFrames> frames(const TableConstants& constants, const Observation& observation,
                                    const Answer& answer, const Linearisation& linearisation,
                                    std::uint32_t now_us);
  void sent(const TouchFrames& frames, std::uint32_t now_us);
  /// A set of readings that nothing could be said of.
  void missed() { isLookedAt_ = false; }
  /// What was sent last may never have been on the bus: the end of a touch is said again.
  void lost();
  void setShortestPeriod(std::uint32_t period_us) { shortestPeriod_us_ = period_us; }

 private:
  FingerFlags flagsOf(const Observation& observation) const;
  bool due(std::uint32_t now_us) const { return !any_ || now_us - sentAt_us_ >= shortestPeriod_us_; }
  bool mustBeRepeated(std::uint32_t now_us) const;

  std::uint32_t shortestPeriod_us_;
  FingerFlags standing_;
  TouchFrames last_{};
  UnitErrors unitErrors_;  ///< of the last linearisation that frames were made of
  std::uint32_t sentAt_us_ = 0;
  bool any_ = false;
  bool isEndOwed_;           ///< what was said last is a touch, or not known
  bool isLookedAt_ = false;  ///< nothing is left to say of these codes
};

}  // namespace strainfinger::firmware
