#pragma once
// A finger that sends its readings (RAW) while somebody listens.

#include <cstdint>

#include "common/commands.hpp"
#include "host/base/notice.hpp"
#include "host/can/ask.hpp"
#include "host/cli/request.hpp"
#include "host/system/postponed_signal.hpp"
#include "host/system/stop_signal.hpp"

namespace strainfinger::cli {

/// From the request for RAW to its end.
class RawStream {
 public:
  /// Throws as requireOneFinger() and requireDone() do.
  RawStream(can::BusPort& bus, std::uint8_t node, int rate_hz, const system::StopSignal& stop)
      : bus_(bus), node_(node), rate_hz_(rate_hz) {
    if (requireOneFinger(bus_, node_, [&stop] { return !stop.asked(); }).sendsRaw)
      tell(
          "strainfinger: {} node {} sends RAW already: if another program asked for it, that one gets {} "
          "sample sets a second now, and none once this one ends\n",
          bus_.name(), node_, rate_hz_);
    try {
      askAgain();
    } catch (...) {
      ask(0);  // its answer may be what was lost
      throw;
    }
  }
  /// Best effort: whoever ends it by force leaves the finger sending until its next start.
  ~RawStream() { ask(0); }
  RawStream(const RawStream&) = delete;
  RawStream& operator=(const RawStream&) = delete;

  /// Asks once more: a finger that was switched off and on sends no RAW. Throws as requireDone() does.
  void askAgain() { requireDone(ask(rate_hz_), Command::kRaw, bus_, node_); }

 private:
  can::Reply ask(int rate_hz) {
    return can::ask(bus_, node_, rawRequest(static_cast<std::uint16_t>(rate_hz)));
  }

  system::PostponedSignal readerGone_{SIGPIPE};  // until the finger has been told to stop: `strains | head`
  can::BusPort& bus_;
  std::uint8_t node_;
  int rate_hz_;
};

}  // namespace strainfinger::cli
