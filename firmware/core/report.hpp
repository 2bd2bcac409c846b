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

/// What is sent once when a touch has ended: no force; place and width are not known.
TouchFrames releaseFrames(FingerFlags flags, std::uint8_t sequence);

/// The contents of a GAUGES frame. Age and rate of the zeros are not known while `setsPerSecond` is 0.
GaugesFrame gaugesFrame(GaugeSet outOfUse, const ZeroTracker& tracker, std::uint32_t setsPerSecond);

/// Whether a value changed by more than the noise's share of its standard error, a quality by ten percent, or
/// a flag, the number of contacts, or whether the width is known.
bool isNews(const TouchFrames& frames, const TouchFrames& last, std::uint32_t noiseShare_q8);

/// Decides when to send: when there is news, but at most at the contact rate; at least every
/// kContactPeriod_ms in contact; once when contact ends.
class TouchReporter {
 public:
  /// `standing`: flags that hold for every frame (simulated, uncalibrated ..). `isEndOwed`: a touch may have
  /// been sent before, by an earlier run, so that its end is to be sent.
  TouchReporter(std::uint32_t shortestPeriod_us, FingerFlags standing, bool isEndOwed = false)
      : shortestPeriod_us_(shortestPeriod_us), standing_(standing), isEndOwed_(isEndOwed) {}

  /// The frames to send for an observation, if any. The caller says with sent() that they went out;
  /// otherwise the next observation replaces them, so that nothing old is ever sent.
  std::optional<TouchFrames> frames(const TableConstants& constants, const Observation& observation,
                                    const Answer& answer, const Linearisation& linearisation,
                                    std::uint32_t now_us);
  void sent(const TouchFrames& frames, std::uint32_t now_us);
  /// Nothing could be sent about this set of readings.
  void missed() { isLookedAt_ = false; }
  /// What was sent last may have been lost before the bus: the end of a touch is sent again.
  void lost();
  /// What was sent last is a touch, or not known: listeners take it for one that goes on.
  bool owesEnd() const { return isEndOwed_; }
  void setShortestPeriod(std::uint32_t period_us) { shortestPeriod_us_ = period_us; }

 private:
  FingerFlags flagsOf(const Observation& observation) const;
  bool due(std::uint32_t now_us) const { return !any_ || now_us - sentAt_us_ >= shortestPeriod_us_; }
  bool mustBeRepeated(std::uint32_t now_us) const;

  std::uint32_t shortestPeriod_us_;
  FingerFlags standing_;
  TouchFrames last_{};
  UnitErrors unitErrors_;  ///< of the last linearisation that frames were made from
  std::uint32_t sentAt_us_ = 0;
  bool any_ = false;
  bool isEndOwed_;           ///< owesEnd()
  bool isLookedAt_ = false;  ///< nothing is left to send about these codes
};

}  // namespace strainfinger::firmware
