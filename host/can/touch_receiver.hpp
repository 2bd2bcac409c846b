#pragma once
// What a finger says of a touch, put together again from its two frames.

#include <cstdint>
#include <optional>

#include "common/can_frame.hpp"
#include "common/frames.hpp"
#include "host/base/no_value.hpp"

namespace strainfinger::can {

/// A CONTACT and its FORCE in physical units; kNoValue where the finger says so.
struct TouchReport {
  double angle_deg = kNoValue;
  double sigmaAngle_deg = kNoValue;
  double normal_n = kNoValue;
  double sigmaNormal_n = kNoValue;
  double tangential_n = kNoValue;
  double sigmaTangential_n = kNoValue;
  double quality_percent = kNoValue;
  FingerFlags flags{};
  std::uint8_t sequence = 0;
};

/// Listens to one node.
class TouchReceiver {
 public:
  explicit TouchReceiver(std::uint8_t node) : node_(node) {}

  /// Takes any frame in the order of the bus; a report when it is the FORCE of the last CONTACT. A FORCE of
  /// another sequence number than that CONTACT's is none's and gives nothing.
  std::optional<TouchReport> take(const CanFrame& frame);

 private:
  std::uint8_t node_;
  std::optional<ContactFrame> contact_;  ///< without its FORCE so far
};

}  // namespace strainfinger::can
