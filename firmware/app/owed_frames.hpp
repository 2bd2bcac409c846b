#pragma once
// The frames of a touch that follow its CONTACT.

#include <array>
#include <cstdint>

#include "common/frames.hpp"
#include "firmware/core/report.hpp"
#include "hal/can_port.hpp"

namespace strainfinger::firmware {

/// What belongs to a CONTACT that went out, in the order of sending: FORCE, PATCH, then a second contact's
/// CONTACT2 and FORCE2. What the port can't take is tried again for a while, and dropped when it has become
/// old, or when the node has left the bus since: its CONTACT may be lost.
class OwedFrames {
 public:
  enum class Outcome : std::uint8_t { kWaiting, kAllSent, kDropped };

  /// `busOffs`: the port's, before it took the CONTACT.
  void owe(const TouchFrames& frames, std::uint8_t node, std::uint32_t now_us, std::uint32_t busOffs) {
    count_ = sent_ = 0;
    contactAt_us_ = now_us;
    busOffs_ = busOffs;
    add(frames.force, node);
    add(frames.patch, node);
    if (!frames.second) return;
    add(frames.second->contact, node);
    add(frames.second->force, node);
  }

  bool any() const { return sent_ < count_; }

  /// Sends what the port takes. Nothing is owed any more unless the outcome is kWaiting.
  template <hal::CanPort Can>
  Outcome send(Can& can, std::uint32_t now_us) {
    const bool isOld = now_us - contactAt_us_ >= std::uint32_t{kContactPeriod_ms} * 1000;
    if (isOld || can.status().busOffs != busOffs_) {
      sent_ = count_;
      return Outcome::kDropped;
    }
    while (any() && can.send(frames_[sent_])) ++sent_;
    return any() ? Outcome::kWaiting : Outcome::kAllSent;
  }

 private:
  template <typename Frame>
  void add(const Frame& frame, std::uint8_t node) {
    frames_[count_++] = encode(frame, node);
  }

  std::array<CanFrame, 4> frames_{};
  std::uint8_t count_ = 0;
  std::uint8_t sent_ = 0;  ///< of these
  std::uint32_t contactAt_us_ = 0;
  std::uint32_t busOffs_ = 0;  ///< of the port, then
};

}  // namespace strainfinger::firmware
