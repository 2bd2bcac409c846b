#include "host/health/can_links.hpp"

#include <fmt/format.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "host/base/failure.hpp"
#include "host/base/parse_number.hpp"
#include "host/system/process.hpp"

namespace strainfinger::health {
namespace {

using Json = nlohmann::json;

/// Throws where a text is no number.
double numberIn(const Json& value) {
  if (value.is_number()) return value.get<double>();
  const auto& text = value.get_ref<const std::string&>();  // iproute2 6.1 prints fractions so
  if (const auto number = parseNumber<double>(text)) return *number;
  throw std::invalid_argument(text);
}

template <typename Number>
std::optional<Number> numberAt(const Json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end() || !(found->is_number() || found->is_string())) return std::nullopt;
  const double number = numberIn(*found);
  using Limits = std::numeric_limits<Number>;
  if (!(number >= Limits::lowest() && number <= Limits::max())) throw std::out_of_range(key);
  return static_cast<Number>(number);
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

namespace {

std::string linksAsIpShowsThem() try {
  return system::runIn(".", {"ip", "-details", "-json", "link", "show"}, "iproute2");
} catch (const Failure& failure) {
  throw Failure(
      failure.code(),
      fmt::format("the CAN interfaces cannot be listed, name the bus with --can: {}", failure.what()));
}

}  // namespace

std::vector<CanLink> canLinks() { return parseCanLinks(linksAsIpShowsThem()); }

}  // namespace strainfinger::health
