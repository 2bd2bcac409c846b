#pragma once
// What a finger says of a touch, put together again from its two frames.

#include <cstdint>
#include <optional>

#include "common/can_frame.hpp"
#include "common/frames.hpp"
#include "host/base/unknown.hpp"

namespace strainfinger::can {

/// A CONTACT and its FORCE in physical units; kUnknown where the finger says so.
struct TouchReport {
  double angle_deg = kUnknown;
  double sigmaAngle_deg = kUnknown;
  double normal_n = kUnknown;
  double sigmaNormal_n = kUnknown;
  double tangential_n = kUnknown;
  double sigmaTangential_n = kUnknown;
  double quality_percent = kUnknown;
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
