#include "host/health/can_links.hpp"

#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "host/base/failure.hpp"

namespace strainfinger::health {
namespace {

using Json = nlohmann::json;

template <typename Number>
std::optional<Number> numberAt(const Json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end()) return std::nullopt;
  if (found->is_number()) return found->get<Number>();
  // iproute2 6.1 prints fractions as text.
  if (found->is_string()) return static_cast<Number>(std::stod(found->get<std::string>()));
  return std::nullopt;
}

CanLink linkOf(const Json& json) {
  CanLink link{.name = json.at("ifname")};
  for (const Json& flag : json.at("flags")) link.isUp = link.isUp || flag == "UP";
  const Json info = json.value("linkinfo", Json::object()).value("info_data", Json::object());
  link.state = info.value("state", "");
  for (const Json& mode : info.value("ctrlmode", Json::array())) link.isListenOnly |= mode == "LISTEN-ONLY";
  link.restart_ms = numberAt<int>(info, "restart_ms");
  const Json timing = info.value("bittiming", Json::object());
  link.bitrate = numberAt<int>(timing, "bitrate");
  if (!link.bitrate) link.bitrate = numberAt<int>(info, "bittiming_bitrate");  // of a list of fixed ones
  link.samplePoint = numberAt<double>(timing, "sample_point");
  const Json errors = info.value("berr_counter", Json::object());
  link.txErrors = numberAt<int>(errors, "tx");
  link.rxErrors = numberAt<int>(errors, "rx");
  return link;
}

/// What a command prints; nothing where it fails.
std::optional<std::string> outputOf(const char* command) {
  std::FILE* const pipe = ::popen(command, "r");
  if (pipe == nullptr) return std::nullopt;
  std::string text;
  std::array<char, 4096> block;
  while (const std::size_t count = std::fread(block.data(), 1, block.size(), pipe))
    text.append(block.data(), count);
  return ::pclose(pipe) == 0 ? std::optional(text) : std::nullopt;
}

}  // namespace

std::vector<CanLink> parseCanLinks(std::string_view json) try {
  std::vector<CanLink> links;
  for (const Json& link : Json::parse(json))
    if (link.value("link_type", "") == "can") links.push_back(linkOf(link));
  return links;
} catch (const std::exception&) {
  throw Failure(ExitCode::kFailure,
                "`ip -details -json link show` prints something unknown: iproute2 5.16 or newer is needed");
}

std::vector<CanLink> canLinks() {
  const auto text = outputOf("ip -details -json link show 2>/dev/null");
  if (!text)
    throw Failure(ExitCode::kFailure,
                  "`ip` cannot be run, which lists the CAN interfaces: apt install iproute2, or name the bus "
                  "with --can");
  return parseCanLinks(*text);
}

}  // namespace strainfinger::health
