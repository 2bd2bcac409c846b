#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <climits>
#include <cstdlib>
#include <random>
#include <string>
#include <string_view>

#include "common/frames.hpp"
#include "host/base/excerpt.hpp"
#include "host/base/failure.hpp"
#include "host/base/notice.hpp"
#include "host/can/open_bus.hpp"
#include "host/cli/bus_option.hpp"
#include "host/cli/command.hpp"
#include "host/cli/commands.hpp"
#include "host/live/bus_watch.hpp"
#include "host/live/page_server.hpp"
#include "host/live/view_json.hpp"
#include "host/simulation/strain_fit.hpp"
#include "host/system/stop_signal.hpp"
#include "host/tables/table_builder.hpp"

namespace strainfinger::cli {
namespace {

constexpr const char* kServeHelp =
    "The fingers of a bus, live in a browser: strainfinger serve --can can0, then open the address that it "
    "prints.\n"
    "Only this machine reaches it unless --address says otherwise (0.0.0.0: every interface); commands then "
    "need a token, which is part of the printed address. The page itself has no password: who reaches it "
    "reads it.\n"
    "A token of your own (8 characters or more) stays the same when this is started again. The list of "
    "processes shows --token to everybody on this machine, the environment's STRAINFINGER_TOKEN to you "
    "only.\n"
    "From another machine without opening a port: ssh -L 8080:localhost:8080 HOST\n"
    "For programs: GET /state is one JSON object, GET /events a stream of them (server-sent events), "
    "POST /fingers/NODE/tare with header X-Strainfinger zeroes gauges.\n"
    "Ctrl-C ends it, with exit status 130.";

/// A touch is on the page within two of these and what a browser takes to draw.
constexpr std::chrono::milliseconds kPublishEvery{40};

constexpr const char* kTokenVariable = "STRAINFINGER_TOKEN";
constexpr std::size_t kShortestToken = 8;  // characters

struct ServeOptions {
  explicit ServeOptions(CLI::App& command) : common(command) {
    addBusOption(command, bus)->required();
    command
        .add_option("--port", server.port,
                    fmt::format("TCP port (default {}); 0: any that is free", server.port))
        ->check(isWhole(0, 65535));
    command.add_option("--address", server.address, "To listen on; 127.0.0.1 is this machine only")
        ->capture_default_str();
    token = command
                .add_option("--token", server.token,
                            fmt::format("What commands need, or {} of the environment (default: none here, "
                                        "else a random one)",
                                        kTokenVariable))
                ->type_name("TEXT")
                ->envname(kTokenVariable);
  }
  /// It may be given and empty. CLI11 takes an empty variable for none.
  bool isTokenGiven() const { return token->count() > 0 || std::getenv(kTokenVariable) != nullptr; }

  CommonOptions common;
  std::string bus;
  live::PageServerOptions server;
  const CLI::Option* token;
};

std::string randomToken() {
  std::random_device random;  // the kernel's
  std::string token;
  for (int i = 0; i < 4; ++i) token += fmt::format("{:08x}", random());
  return token;
}

/// What the page has to know beforehand.
std::string shapeJson(const config::FingerConfig& config, bool needsToken) {
  auto json = live::toJson(config);
  json["needs_token"] = needsToken;
  const auto explain = [&json](const auto& names) {
    for (const ValueName& name : names) json["words"][name.name] = name.comment;
  };
  explain(kFingerFlagNames);
  explain(kFingerFaultNames);
  return json.dump();
}

/// Throws Failure(kUsage) for what no machine has.
void requireAddress(const std::string& address) {
  if (address.empty())
    throw Failure(ExitCode::kUsage,
                  "serve: --address is empty: 127.0.0.1 is this machine only, 0.0.0.0 every interface");
  if (address.starts_with('['))
    throw Failure(ExitCode::kUsage,
                  fmt::format("serve: --address {} is no address: brackets are for a browser, leave them out",
                              excerpt(address)));
}

/// Throws Failure(kUsage) for a token that protects nothing, or that no command could have.
void requireGoodToken(const ServeOptions& options) {
  const std::string& token = options.server.token;
  if (token.empty() && options.isTokenGiven() && !live::isLocalAddress(options.server.address))
    throw Failure(ExitCode::kUsage,
                  fmt::format("serve: the token (--token, {}) is empty, and others reach {}: give one, or "
                              "leave it out for a random one",
                              kTokenVariable, options.server.address));
  if (!token.empty() && token.size() < kShortestToken)
    throw Failure(ExitCode::kUsage,
                  fmt::format("serve: the token (--token, {}) has {} characters and can be guessed: it must "
                              "have {} at least",
                              kTokenVariable, token.size(), kShortestToken));
  // The HTTP library takes %41 in a header for A.
  const auto isCarried = [](char each) { return each >= ' ' && each <= '~' && each != '%'; };
  if (!std::ranges::all_of(token, isCarried) || token.starts_with(' ') || token.ends_with(' '))
    throw Failure(
        ExitCode::kUsage,
        fmt::format("serve: the token (--token, {}) must be printable ASCII without % and without a "
                    "space at either end: it is sent in a header",
                    kTokenVariable));
}

live::PageServerOptions serverOptions(const ServeOptions& options, const config::FingerConfig& config) {
  live::PageServerOptions server = options.server;
  if (server.token.empty() && !live::isLocalAddress(server.address)) server.token = randomToken();
  server.shapeJson = shapeJson(config, !server.token.empty());
  return server;
}

std::string machineName() {
  std::array<char, HOST_NAME_MAX + 1> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "localhost";
}

/// What a browser may be given for the address that is listened on: this machine's name for "every
/// interface".
std::string hostOf(const std::string& address) {
  if (address == "0.0.0.0" || address == "::") return machineName();
  return address.find(':') != std::string::npos ? "[" + address + "]" : address;
}

/// As a URL's fragment has it (RFC 3986): what is not unreserved as %XX.
std::string percentEncoded(const std::string& text) {
  constexpr std::string_view kUnreserved =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-._~";
  std::string encoded;
  for (const char each : text)
    encoded += kUnreserved.find(each) != kUnreserved.npos
                   ? std::string(1, each)
                   : fmt::format("%{:02X}", static_cast<unsigned char>(each));
  return encoded;
}

std::string urlOf(const live::PageServerOptions& server, int port) {
  return fmt::format("http://{}:{}/{}{}", hostOf(server.address), port, server.token.empty() ? "" : "#",
                     percentEncoded(server.token));
}

/// The newest view as JSON.
std::string viewJson(live::BusWatch& watch, const simulation::StrainFit& fit) {
  live::BusView view = watch.view();
  for (live::FingerView& finger : view.fingers)
    if (!finger.strains.empty() && finger.isTouched()) finger.fitted = fit.readings(*finger.touch);
  return live::toJson(view).dump();
}

void serve(live::BusWatch& watch, live::PageServer& server, const simulation::StrainFit& fit) {
  const system::StopSignal stop;
  while (!stop.asked()) {
    for (const std::uint8_t node : server.takeTares()) watch.request(node, tareRequest(false));
    watch.listen(kPublishEvery);
    for (const live::Outcome& outcome : watch.outcomes()) server.answer(outcome);
    if (server.isRead()) server.publish(viewJson(watch, fit));
  }
}

void runServe(const ServeOptions& options) {
  requireAddress(options.server.address);
  requireGoodToken(options);
  const config::FingerConfig config = options.common.config();
  const auto port = can::openBus(options.bus, config.can.bitrate);
  std::optional<std::uint32_t> tables_crc32;
  if (options.common.hasConfig()) tables_crc32 = tables::buildTableImage(config).crc32;
  live::BusWatch watch(*port, config, tables_crc32);
  const live::PageServerOptions serverOptionsNow = serverOptions(options, config);
  live::PageServer server(serverOptionsNow);
  tell("serve: {} shows {}; Ctrl-C ends\n", urlOf(serverOptionsNow, server.port()), options.bus);
  serve(watch, server, simulation::StrainFit(config));
  throw Failure(ExitCode::kInterrupted, "serve: interrupted");
}

}  // namespace

void addServe(CLI::App& app) { addCommand<ServeOptions>(app, "serve", kServeHelp, runServe); }

}  // namespace strainfinger::cli
