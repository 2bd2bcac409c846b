#pragma once
// What a finger says of a touch, put together again from its frames.

#include <concepts>
#include <cstdint>
#include <optional>

#include "common/can_frame.hpp"
#include "common/frames.hpp"
#include "host/base/no_value.hpp"

namespace strainfinger::can {

/// A CONTACT and its FORCE, or a CONTACT2 and its FORCE2, in physical units; kNoValue where the finger says
/// so.
struct ContactReport {
  double angle_deg = kNoValue;
  double sigmaAngle_deg = kNoValue;
  double normal_n = kNoValue;
  double sigmaNormal_n = kNoValue;
  double tangential_n = kNoValue;
  double sigmaTangential_n = kNoValue;
  double quality_percent = kNoValue;
  double alternative_deg = kNoValue;  ///< another angle that fits as well, relative to angle_deg
};

/// All frames of one sequence number.
struct TouchReport : ContactReport {
  double width_m = kNoValue;
  double sigmaWidth_m = kNoValue;
  double chi = kNoValue;
  double contacts = kNoValue;  ///< how many there are
  std::optional<ContactReport> second{};
  std::optional<ContactReport> secondsEnd{};  ///< no place and no force: it was there in the touch before
  FingerFlags flags{};
  std::uint8_t sequence = 0;
};

/// The largest values that a finger can say of a touch, just as a report has them: each stands for anything
/// beyond it too (common/BUS.md, "or more").
struct LargestValues {
  double normal_n;  ///< of either sign, as of the tangential force
  double tangential_n;
  double sigmaAngle_deg;
  double alternative_deg;  ///< of either sign
  double sigmaNormal_n;
  double sigmaTangential_n;
  double width_m;
  double sigmaWidth_m;
  double chi;
};
const LargestValues& largestValues();

/// A raw value is the largest that its field can say, of fields that may be not known: it stands for anything
/// beyond it too.
template <std::unsigned_integral Raw>
constexpr bool isLargest(Raw raw) {
  return raw == kNotKnown<Raw> - 1;
}

/// Listens to one node.
class TouchReceiver {
 public:
  explicit TouchReceiver(std::uint8_t node) : node_(node) {}

  /// Takes any frame in the order of the bus; a report when it completes what the last CONTACT began. What
  /// follows a CONTACT may come in any order: a controller sends the lowest identifier first. Frames of
  /// another sequence number than that CONTACT's are left out; a touch that lost a frame gives nothing here.
  std::optional<TouchReport> take(const CanFrame& frame);

  /// What there is of the last CONTACT's touch, if it is not complete: what was lost is kNoValue. It is given
  /// up then: of what comes of it later nothing is given.
  std::optional<TouchReport> giveUp();

 private:
  /// The frames of one sequence number so far. Where a second contact ends, its CONTACT2 and FORCE2 come once
  /// more. A report needs the CONTACT.
  struct Touch {
    std::optional<ContactFrame> contact{};
    std::optional<ForceFrame> force{};
    std::optional<PatchFrame> patch{};
    std::optional<Contact2Frame> contact2{};
    std::optional<Force2Frame> force2{};
    bool followsSecond = false;  ///< there was one in the touch before
    bool isComplete() const;
    bool hasSecond() const;
    TouchReport report() const;
  };
  TouchReport finish();
  template <typename Frame>
  bool keep(const CanFrame& frame, std::optional<Frame>& place) const;

  std::uint8_t node_;
  Touch touch_;
  bool hadSecond_ = false;  ///< the touch before
};

}  // namespace strainfinger::can
