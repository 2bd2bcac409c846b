#pragma once
// A request to a finger, and what comes of it.

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "common/commands.hpp"
#include "host/can/bus_port.hpp"

namespace strainfinger::can {

/// Twice the time a finger has to answer; ten heartbeats.
inline constexpr std::chrono::milliseconds kAskFor{2 * kAnswerWithin_ms};

/// After a first answer a second finger of the same number gives its own within this time: both got the
/// request at once.
inline constexpr std::chrono::milliseconds kTwinWithin{50};

/// While it is waited, it is asked so often at least whether to go on.
inline constexpr std::chrono::milliseconds kGoOnEvery{100};

struct Patience {
  std::chrono::milliseconds longest = kAskFor;  ///< for the first response
  std::chrono::milliseconds afterwards{0};      ///< then listen so long for a second one
  std::function<bool()> goOn{};  ///< asked every kGoOnEvery at least; false ends it; empty: go on
};

struct Reply {
  bool sent = false;  ///< false: the interface did not take the request in all that time
  std::optional<ResponseFrame> response{};  ///< the last
  int responses = 0;
  bool sendsRaw = false;   ///< the node does meanwhile
  bool othersAsk = false;  ///< somebody else asked the same node meanwhile: the response may be theirs
  std::optional<HeartbeatFrame> heartbeat{};  ///< the last of that node meanwhile
  std::chrono::milliseconds waited{0};        ///< for a response

  /// A finger answers once.
  bool hasTwin() const { return responses > 1 && !othersAsk; }
};

/// What became of a request, for people: "Refused: something touches the finger", with what its value means.
std::string meaningOf(const ResponseFrame& response);

/// Sends the request to node 1 .. 63 and waits for its response. Fingers cannot tell callers
/// apart: one at a time asks a node. Frames of others meanwhile are read and gone.
Reply ask(BusPort& port, std::uint8_t node, const RequestFrame& request, const Patience& patience = {});

/// Of each finger that is heard in so long the last HEARTBEAT, by node. What `goOn` is: see Patience.
std::map<std::uint8_t, HeartbeatFrame> listenForFingers(BusPort& port, std::chrono::milliseconds time,
                                                        const std::function<bool()>& goOn = {});

/// Asks for something that changes nothing, before what does: nobody may be there, or two fingers of this
/// number, who would both obey. It takes kTwinWithin.
Reply askWhoIsThere(BusPort& port, std::uint8_t node, const std::function<bool()>& goOn = {});

}  // namespace strainfinger::can
