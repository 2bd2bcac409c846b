#pragma once
// What subcommands that ask something of a finger share.

#include <CLI/CLI.hpp>
#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "host/base/failure.hpp"
#include "host/can/ask.hpp"
#include "host/cli/command.hpp"

namespace strainfinger::cli {

struct RequestOptions {
  explicit RequestOptions(CLI::App& command);
  CommonOptions common;
  std::string bus;
  int node = 0;  ///< 0: the config's
};

/// Sends the requests one after the other and prints what became of each: a row
/// interface,node,command,status. Stops at the first that fails and throws Failure with what to do about it
/// when it was refused (kFailure), nobody answered (kNoNode), the interface is none or takes nothing
/// (kNoInterface), or the finger speaks another protocol (kMismatch). Sends none where two fingers would obey
/// (kFailure), or where it is to become a node (nodeRequest()) that there is already (kFailure).
void request(const RequestOptions& options, const std::vector<RequestFrame>& requests);

/// Node of -n, else (0) of the config.
inline std::uint8_t nodeOf(int node, const config::Can& can) {
  return static_cast<std::uint8_t>(node != 0 ? node : can.node);
}

/// Throws as request() does where the reply, which came over `bus`, is none or refuses; warns on stderr where
/// it was done although something touches the finger.
void requireDone(const can::Reply& reply, Command command, const can::BusPort& bus, std::uint8_t node);

/// A push of all tables over a bus of 125 kbit/s takes less.
inline constexpr std::chrono::milliseconds kOthersMayAskFor = std::chrono::seconds(30);

/// Before a request that changes something: waits while another program asks this finger, `othersMayAskFor`
/// at most (kFailure). Throws as request() does where nobody would obey, or two fingers;
/// Failure(kInterrupted) where `goOn()`, asked ten times a second at least, is false before an answer.
/// Returns its answer.
can::Reply requireOneFinger(can::BusPort& bus, std::uint8_t node, const std::function<bool()>& goOn = {},
                            std::chrono::milliseconds othersMayAskFor = kOthersMayAskFor);

/// Before a finger becomes this node. Throws Failure(kFailure) where another answers or beats as it.
void requireNobody(can::BusPort& bus, std::uint8_t node);

/// That two fingers have this number.
Failure twinFailure(const can::BusPort& bus, std::uint8_t node);

}  // namespace strainfinger::cli
