#include "host/cli/request.hpp"

#include <fmt/format.h>

#include <chrono>
#include <optional>
#include <random>

#include "host/base/failure.hpp"
#include "host/base/notice.hpp"
#include "host/base/table_writer.hpp"
#include "host/can/frame_catalogue.hpp"
#include "host/can/open_bus.hpp"
#include "host/can/remedies.hpp"
#include "host/cli/bus_option.hpp"

namespace strainfinger::cli {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr int kMostSilences = 3;  ///< after others have asked

std::string commandName(Command command) { return can::nameText(kCommandNames, static_cast<int>(command)); }
std::string statusName(CommandStatus status) {
  return can::nameText(kCommandStatusNames, static_cast<int>(status));
}

/// Shows every finger of the bus, whatever carries it.
std::string monitorCommand(const can::BusPort& bus) {
  return fmt::format("`strainfinger monitor --can {}`", bus.name());
}

std::string placeOf(const can::BusPort& bus, std::uint8_t node) {
  return fmt::format("{} node {}", bus.name(), node);
}

Failure refusal(const ResponseFrame& response, Command command, const can::BusPort& bus, std::uint8_t node) {
  const bool saysWhen = response.status == CommandStatus::kWait;
  const std::string remedy = saysWhen ? "" : can::forNode(can::remedyFor(response.status), bus.name(), node);
  return Failure(
      ExitCode::kFailure,
      fmt::format("{}: {}: {} ({}){}{}", placeOf(bus, node), commandName(command), can::meaningOf(response),
                  statusName(response.status), remedy.empty() ? "" : ": ", remedy));
}

std::string twinText(const can::BusPort& bus, std::uint8_t node) {
  return fmt::format("{}: {}", can::kTwinText, can::forNode(can::kTwinRemedy, bus.name(), node));
}

Failure silence(const can::Reply& reply, const can::BusPort& bus, const std::string& where) {
  const auto waited_ms = reply.waited.count();
  if (!reply.sent)
    return Failure(ExitCode::kNoInterface, fmt::format("{}: {} took no frame in {} ms: {}", where, bus.name(),
                                                       waited_ms, bus.hints().whenBlocked));
  if (!reply.heartbeat)
    return Failure(
        ExitCode::kNoNode,
        fmt::format("{}: no answer within {} ms and no HEARTBEAT: {} {} shows the fingers that are there",
                    where, waited_ms, bus.hints().whenSilent, monitorCommand(bus)));
  const HeartbeatFrame& heartbeat = *reply.heartbeat;
  if (heartbeat.protocol != kProtocolVersion)
    return Failure(ExitCode::kMismatch, fmt::format("{}: {}", where, can::foreignText(heartbeat.protocol)));
  return Failure(
      ExitCode::kNoNode,
      fmt::format("{}: no answer within {} ms, though it is alive: state {}; its firmware may be older than "
                  "this command",
                  where, waited_ms, can::nameText(kFingerStateNames, static_cast<int>(heartbeat.state))));
}

/// Frames are passed over for a time that differs from program to program: two that have begun at once don't
/// ask at once again.
void letOthersAsk(can::BusPort& bus, const std::function<bool()>& goOn) {
  std::random_device random;
  const auto end = Clock::now() + std::uniform_int_distribution<>{100, 500}(random)*1ms;
  for (auto now = Clock::now(); now < end && (!goOn || goOn()); now = Clock::now()) {
    bus.waitReadable(std::chrono::ceil<std::chrono::milliseconds>(end - now));
    while (bus.receive()) {}
  }
}

/// Fingers cannot tell callers apart, so two programs would take each other's answers for their own.
can::Reply askOnceOthersHaveEnded(can::BusPort& bus, std::uint8_t node, const std::function<bool()>& goOn,
                                  std::chrono::milliseconds othersMayAskFor) {
  const auto end = Clock::now() + othersMayAskFor;
  can::Reply reply = can::askWhoIsThere(bus, node, goOn);
  if (reply.othersAsk)
    tell("strainfinger: {}: another program asks this finger: waiting until it has ended\n",
         placeOf(bus, node));
  const bool waits = reply.othersAsk;
  // What they asked may have been a restart, during which it doesn't answer.
  for (int silences = 0; waits && (reply.othersAsk || (!reply.response && silences < kMostSilences)) &&
                         Clock::now() < end && (!goOn || goOn());) {
    letOthersAsk(bus, goOn);
    reply = can::askWhoIsThere(bus, node, goOn);
    silences += reply.response ? 0 : 1;
  }
  return reply;
}

void requireNoTwinOf(can::BusPort& bus, std::uint8_t node, const RequestFrame& request) {
  const auto wanted = static_cast<std::uint8_t>(request.argument & ~kNodeEvenWhileTouched);
  if (request.command == Command::kNode && wanted != node) requireNobody(bus, wanted);
}

}  // namespace

RequestOptions::RequestOptions(CLI::App& command) : common(command) {
  addBusOption(command, bus)->required();
  command.add_option("-n,--node", node, "Node number in place of the config's")->check(isNode());
}

void requireDone(const can::Reply& reply, Command command, const can::BusPort& bus, std::uint8_t node) {
  const std::string where = placeOf(bus, node);
  if (!reply.response) throw silence(reply, bus, where);
  if (reply.hasTwin())
    throw Failure(ExitCode::kFailure, fmt::format("{}: {}: both have answered: {}", where,
                                                  commandName(command), twinText(bus, node)));
  const CommandStatus status = reply.response->status;
  if (status == CommandStatus::kDoneTouched)
    tell("strainfinger: {}: {}: {}\n", where, commandName(command), can::meaningOf(*reply.response));
  else if (status != CommandStatus::kDone)
    throw refusal(*reply.response, command, bus, node);
}

Failure twinFailure(const can::BusPort& bus, std::uint8_t node) {
  return Failure(ExitCode::kFailure, fmt::format("{}: {}", placeOf(bus, node), twinText(bus, node)));
}

can::Reply requireOneFinger(can::BusPort& bus, std::uint8_t node, const std::function<bool()>& goOn,
                            std::chrono::milliseconds othersMayAskFor) {
  const can::Reply reply = askOnceOthersHaveEnded(bus, node, goOn, othersMayAskFor);
  const bool isInterrupted = goOn && !goOn();
  if (isInterrupted && (reply.othersAsk || !reply.response))
    throw Failure(ExitCode::kInterrupted,
                  fmt::format("{}: interrupted before it answered", placeOf(bus, node)));
  if (reply.othersAsk)
    throw Failure(ExitCode::kFailure,
                  fmt::format("{}: another program asks this finger, and has not ended "
                              "within {} s: {}",
                              placeOf(bus, node), othersMayAskFor / 1.0s, can::kOthersAskRemedy));
  if (reply.hasTwin()) throw twinFailure(bus, node);
  if (!reply.response) throw silence(reply, bus, placeOf(bus, node));
  return reply;
}

void requireNobody(can::BusPort& bus, std::uint8_t node) {
  const can::Reply reply = can::askWhoIsThere(bus, node);
  if (reply.response || reply.heartbeat)
    throw Failure(ExitCode::kFailure,
                  fmt::format("{}: there is a finger of this number already: choose another; `strainfinger "
                              "discover --can {}` shows those that are there",
                              placeOf(bus, node), bus.name()));
}

void request(const RequestOptions& options, const std::vector<RequestFrame>& requests) {
  const config::Can can = options.common.config().can;
  const std::uint8_t node = nodeOf(options.node, can);
  const auto port = can::openBus(options.bus, can.bitrate);
  requireOneFinger(*port, node);
  for (const RequestFrame& request : requests) requireNoTwinOf(*port, node, request);
  std::optional<TableWriter> table;  // nothing is printed before there is a row
  for (const RequestFrame& request : requests) {
    const can::Reply reply = can::ask(*port, node, request);
    requireDone(reply, request.command, *port, node);
    if (!table)
      table.emplace(stdout, options.common.format(),
                    std::vector<std::string>{"interface", "node", "command", "status"});
    table->row(
        {options.bus, std::int64_t{node}, commandName(request.command), statusName(reply.response->status)});
  }
}

}  // namespace strainfinger::cli
