#pragma once
// A live bus, watched: what is heard goes to a Fleet, requests go out beside it.

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "host/can/bus_port.hpp"
#include "host/live/fleet.hpp"
#include "host/live/onward_clock.hpp"
#include "host/live/pending_request.hpp"

namespace strainfinger::live {

class BusWatch {
 public:
  using Tap = std::function<void(const can::TimedFrame&)>;

  /// `port` must outlive it. The others are for a Fleet.
  BusWatch(can::BusPort& port, const config::FingerConfig& config,
           std::optional<std::uint32_t> tables_crc32 = std::nullopt);
  ~BusWatch() { port_.hearOthers({}); }
  BusWatch(const BusWatch&) = delete;
  BusWatch& operator=(const BusWatch&) = delete;

  /// Takes what comes for so long. Frames are fetched a few milliseconds' worth at a time: a wake-up for each
  /// would cost more than they do. Their times are those of their arrival all the same.
  void listen(std::chrono::milliseconds time);

  /// How things are now. The machine's clock may be set meanwhile: OnwardClock.
  BusView view();

  /// Asks a finger for something. A node has one request at a time: another of one that waits is dropped. One
  /// to a number that two fingers were heard to have is not sent, as both would obey.
  void request(std::uint8_t node, const RequestFrame& request);
  /// What became of requests since the last call.
  std::vector<Outcome> outcomes() { return std::exchange(outcomes_, {}); }

  /// They also get every frame, one those that a CanFrame can hold and one the others; empty ones end that.
  void setTap(Tap tap, can::BusPort::OtherTap others) {
    tap_ = std::move(tap);
    otherTap_ = std::move(others);
  }

 private:
  void fetch();
  void sendRequests();

  can::BusPort& port_;
  OnwardClock clock_;  ///< of what goes to `fleet_`
  Fleet fleet_;
  std::vector<PendingRequest> requests_;
  std::vector<Outcome> outcomes_;
  Tap tap_;
  can::BusPort::OtherTap otherTap_;
};

}  // namespace strainfinger::live
