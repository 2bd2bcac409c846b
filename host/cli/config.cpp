#include <fmt/format.h>

#include <optional>
#include <vector>

#include "host/base/failure.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/request.hpp"
#include "host/config/bus_load.hpp"

namespace strainfinger::cli {
namespace {

constexpr const char* kConfigHelp =
    "Changes settings of a finger on the bus: the contact rate until its next start, or for ever with "
    "--keep; its node number from its next start on; or has it start anew.\n"
    "Prints interface,node,command,status. Exit status: 1 refused, or another finger has the number, 3 no "
    "interface, 4 no such node.";

struct ConfigOptions {
  explicit ConfigOptions(CLI::App& command) : request(command) {
    command.add_option("--contact-rate-hz", contactRate_hz, "Send at most so many CONTACT a second")
        ->type_name("HZ")
        ->check(isWhole(int{kSlowestContactRate_hz}, int{kFastestContactRate_hz}));
    command.add_flag("--keep", keep, "Keep the contact rate for the next starts");
    command.add_option("--set-node", node, "Be this node from the next start on")
        ->type_name("NODE")
        ->check(isNode());
    command.add_flag("--restart", restart,
                     "Then start anew, so that a new node number holds at once; do not touch it");
    command.add_flag("--force", force, "Keep it, or restart, even while something touches the finger");
  }
  RequestOptions request;
  std::optional<int> contactRate_hz;
  bool keep = false;
  std::optional<int> node;
  bool restart = false;
  bool force = false;
};

/// The finger doesn't know the bus' bit rate.
void requireRoomOnTheBus(const config::Can& can, int rate_hz) {
  const int fastest_hz = config::fastestContactRate_hz(can);
  if (rate_hz <= fastest_hz) return;
  throw Failure(ExitCode::kUsage,
                fmt::format("config: --contact-rate-hz {}: at can.bitrate = {} the bus carries {} at most",
                            rate_hz, can.bitrate, fastest_hz));
}

void runConfig(const ConfigOptions& options) {
  std::vector<RequestFrame> requests;
  if (options.contactRate_hz && options.restart && !options.keep)
    throw Failure(
        ExitCode::kUsage,
        "config: --restart forgets --contact-rate-hz: give --keep as well, or leave one of them out");
  if (options.contactRate_hz) {
    requireRoomOnTheBus(options.request.common.config().can, *options.contactRate_hz);
    requests.push_back(contactRateRequest(static_cast<std::uint16_t>(*options.contactRate_hz)));
  }
  if (options.keep) requests.push_back(keepRequest(options.force));
  if (options.node) requests.push_back(nodeRequest(static_cast<std::uint8_t>(*options.node), options.force));
  if (options.restart) requests.push_back(restartRequest(options.force));
  if (requests.empty())
    throw Failure(ExitCode::kUsage,
                  "config: nothing to change: give --contact-rate-hz, --keep, --set-node or --restart");
  request(options.request, requests);
}

}  // namespace

void addConfig(CLI::App& app) { addCommand<ConfigOptions>(app, "config", kConfigHelp, runConfig); }

}  // namespace strainfinger::cli
