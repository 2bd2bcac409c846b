#pragma once
// A finger that has no tables to work with: it says so, and takes some.

#include <cstdint>
#include <optional>

#include "common/commands.hpp"
#include "firmware/app/announce.hpp"
#include "firmware/app/next_request.hpp"
#include "firmware/app/table_loader.hpp"
#include "hal/can_port.hpp"

namespace strainfinger::firmware {

/// Obeys `load`, `word` and `restart`; to other requests it is busy. Port and store are held by reference.
template <hal::CanPort Can, hal::NonVolatile Store>
class WithoutTables {
 public:
  WithoutTables(std::uint8_t node, Can& can, Store& store, std::uint32_t now_us)
      : node_(node), can_(can), loader_(store), heartbeat_(withoutTables(), node, now_us) {}

  /// One turn of the main loop. Blocks for as long as the memory takes to write 8 bytes or to erase a page.
  void step(std::uint32_t now_us) {
    heartbeat_.step(can_, now_us);
    if (response_ && now_us - answeredAt_us_ >= std::uint32_t{kAnswerWithin_ms} * 1000) response_.reset();
    if (!response_) {
      answeredAt_us_ = now_us;
      if (const auto request = nextRequest(can_, node_)) response_ = obey(*request);
    }
    if (response_ && can_.send(encode(*response_, node_))) response_.reset();
  }

  /// It was told to start anew, and has answered.
  bool isLeaving() const { return isLeaving_ && !response_; }

 private:
  ResponseFrame obey(const RequestFrame& request) {
    const CommandStatus fault = checkRequest(request);
    if (fault != CommandStatus::kDone) return responseTo(request.command, fault);
    if (request.command == Command::kWord) return loader_.take(request.argument, request.value);
    if (request.command == Command::kLoad) {
      loader_.begin();
    } else if (request.command == Command::kRestart) {
      isLeaving_ = true;
    } else {
      return responseTo(request.command, CommandStatus::kBusy);
    }
    return responseTo(request.command, CommandStatus::kDone);
  }

  std::uint8_t node_;
  bool isLeaving_ = false;
  Can& can_;
  TableLoader<Store> loader_;
  Announcement<HeartbeatFrame> heartbeat_;
  std::optional<ResponseFrame> response_;  ///< that the port hasn't taken yet
  std::uint32_t answeredAt_us_ = 0;
};

}  // namespace strainfinger::firmware
