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
#include "hal/clock.hpp"

namespace strainfinger::firmware {

/// How a finger comes to have none.
struct NoTables {
  std::uint8_t node;
  bool isLoading;  ///< it was told to `load`, and has answered, while it had some
  EraseBudget budget;
  std::uint32_t uptime_s;
};

/// Obeys `load`, `word` and `restart`; to other requests it is busy. It leaves by itself if nobody sends the
/// first word within kCallerGone_s of a `load` that stopped it, because then its tables are still whole. Port
/// and store are held by reference.
template <hal::CanPort Can, hal::NonVolatile Store>
class WithoutTables {
 public:
  WithoutTables(const NoTables& from, Can& can, Store& store, std::uint32_t now_us)
      : node_(from.node),
        hasMemory_(store.size() >= sizeof(TableImage)),
        can_(can),
        loader_(store),
        budget_(from.budget),
        heartbeat_(withoutTables(), from.node, now_us),
        second_us_(now_us),
        uptime_s_(from.uptime_s),
        isCalled_(from.isLoading),
        calledAt_s_(from.uptime_s) {
    if (from.isLoading) loader_.begin();
  }

  static constexpr std::uint32_t kCallerGone_s = 30;

  /// One turn of the main loop. Blocks for as long as the memory takes to write 8 bytes or to erase a page.
  void step(std::uint32_t now_us) {
    for (; now_us - second_us_ >= hal::kSecond_us; second_us_ += hal::kSecond_us) ++uptime_s_;
    heartbeat_.step(can_, now_us);
    if (response_ && now_us - requestedAt_us_ >= std::uint32_t{kAnswerWithin_ms} * 1000) response_.reset();
    if (!response_ && !isLeaving_) {
      requestedAt_us_ = now_us;
      if (const auto request = nextRequest(can_, node_)) response_ = obey(*request);
    }
    isCalled_ &= loader_.isFresh();
    if (isCalled_ && uptime_s_ - calledAt_s_ >= kCallerGone_s) isLeaving_ = true;
    if (response_ && can_.send(encode(*response_, node_))) response_.reset();
  }

  /// It is to start anew, and has answered if it was told to, or could not in kAnswerWithin_ms.
  bool isLeaving() const { return isLeaving_ && !response_; }

 private:
  ResponseFrame obey(const RequestFrame& request) {
    const CommandStatus fault = checkRequest(request);
    if (fault != CommandStatus::kDone) return responseTo(request.command, fault);
    if (request.command == Command::kWord) return loader_.take(request.argument, request.word);
    if (request.command == Command::kLoad) return load();
    if (request.command != Command::kRestart) return responseTo(request.command, CommandStatus::kBusy);
    isLeaving_ = true;
    return responseTo(request.command, CommandStatus::kDone);
  }

  /// One whose answer was lost may be said again.
  ResponseFrame load() {
    if (!hasMemory_) return responseTo(Command::kLoad, CommandStatus::kNotKept);
    calledAt_s_ = uptime_s_;
    if (loader_.isFresh()) return responseTo(Command::kLoad, CommandStatus::kDone);
    if (const std::uint32_t wait_s = budget_.wait_s(uptime_s_); wait_s > 0)
      return responseTo(Command::kLoad, CommandStatus::kWait, wait_s);
    budget_.spend(uptime_s_);
    loader_.begin();
    return responseTo(Command::kLoad, CommandStatus::kDone);
  }

  std::uint8_t node_;
  bool isLeaving_ = false;
  bool hasMemory_;
  Can& can_;
  TableLoader<Store> loader_;
  EraseBudget budget_;
  Announcement<HeartbeatFrame> heartbeat_;
  std::optional<ResponseFrame> response_;  ///< that the port hasn't taken yet
  std::uint32_t requestedAt_us_ = 0;
  std::uint32_t second_us_;  ///< when the last whole second ended
  std::uint32_t uptime_s_;
  bool isCalled_;             ///< by a `load` that stopped it, and no word has come
  std::uint32_t calledAt_s_;  ///< by the last `load`
};

}  // namespace strainfinger::firmware
