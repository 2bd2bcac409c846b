#pragma once
// Frames that go out once in a while whatever happens.

#include <cstdint>

#include "common/frames.hpp"
#include "firmware/app/crash_record.hpp"
#include "hal/can_port.hpp"

namespace strainfinger::firmware {

/// A frame that is due at once and then every period; one that the port can't take stays due.
template <typename Frame>
class Announcement {
 public:
  Announcement(const Frame& frame, std::uint8_t node, std::uint32_t now_us)
      : frame_(encode(frame, node)), sentAt_us_(now_us - kPeriod_us) {}

  template <hal::CanPort Can>
  void step(Can& can, std::uint32_t now_us) {
    if (now_us - sentAt_us_ >= kPeriod_us && can.send(frame_)) sentAt_us_ = now_us;
  }

 private:
  static constexpr std::uint32_t kPeriod_us = std::uint32_t{kLayout<Frame>.spec.period_ms} * 1000;
  CanFrame frame_;
  std::uint32_t sentAt_us_;
};

/// Versions are numbers here and not text, as everything on the bus.
struct Version {
  std::uint8_t major = 0;
  std::uint8_t minor = 0;
};

constexpr InfoFrame infoFrame(ResetCause cause, const LastRun& last, Version version, std::uint8_t board) {
  return {.reset_cause = cause,
          .crash = last.crash,
          .restarts = last.restarts,
          .version_major = version.major,
          .version_minor = version.minor,
          .crash_address = last.crash_address & 0xFFFFFF,
          .board = board};
}

/// The heartbeat of a finger that has no tables to work with.
constexpr HeartbeatFrame withoutTables() {
  HeartbeatFrame frame;
  frame.state = FingerState::kFault;
  frame.faults.set(FingerFault::kTables);
  return frame;
}

}  // namespace strainfinger::firmware
