#pragma once
// A finger that has no tables to work with: it says so, and takes some.

#include <cstdint>
#include <optional>

#include "common/commands.hpp"
#include "firmware/app/announce.hpp"
#include "firmware/app/erase_budget.hpp"
#include "firmware/app/next_request.hpp"
#include "firmware/app/table_loader.hpp"
#include "hal/can_port.hpp"

namespace strainfinger::firmware {

/// Obeys `load`, `word` and `restart`; to other requests it is busy. Port and store are held by reference.
/// `isLoading`: it was told to `load`, and has answered, while it had tables. `budget`: of further ones.
template <hal::CanPort Can, hal::NonVolatile Store>
class WithoutTables {
 public:
  WithoutTables(std::uint8_t node, Can& can, Store& store, std::uint32_t now_us, bool isLoading,
                EraseBudget budget)
      : node_(node),
        can_(can),
        loader_(store),
        budget_(budget),
        heartbeat_(withoutTables(), node, now_us),
        second_us_(now_us) {
    if (isLoading) loader_.begin();
  }

  /// One turn of the main loop. Blocks for as long as the memory takes to write 8 bytes or to erase a page.
  void step(std::uint32_t now_us) {
    for (; now_us - second_us_ >= 1'000'000; second_us_ += 1'000'000) ++seconds_;
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
    if (request.command == Command::kLoad) return load();
    isLeaving_ = request.command == Command::kRestart;
    return responseTo(request.command, isLeaving_ ? CommandStatus::kDone : CommandStatus::kBusy);
  }

  ResponseFrame load() {
    if (const std::uint32_t wait_s = budget_.wait_s(seconds_); wait_s > 0)
      return responseTo(Command::kLoad, CommandStatus::kWait, wait_s);
    budget_.spend(seconds_);
    loader_.begin();
    return responseTo(Command::kLoad, CommandStatus::kDone);
  }

  std::uint8_t node_;
  bool isLeaving_ = false;
  Can& can_;
  TableLoader<Store> loader_;
  EraseBudget budget_;
  Announcement<HeartbeatFrame> heartbeat_;
  std::optional<ResponseFrame> response_;  ///< that the port hasn't taken yet
  std::uint32_t answeredAt_us_ = 0;
  std::uint32_t second_us_;    ///< when the last whole second ended
  std::uint32_t seconds_ = 0;  ///< since it was made
};

}  // namespace strainfinger::firmware
