// The firmware's codec as a filter, for tests with other people's tools. A line in, a line out:
//   encode FRAME NODE RAW...   the raw values of the fields in the order of the table -> IDENTIFIER#DATA
//   decode IDENTIFIER#DATA     -> FRAME NODE RAW..., or "none"

#include <fmt/format.h>

#include <cstdint>
#include <iostream>
#include <optional>
#include <sstream>
#include <string>
#include <variant>

#include "common/commands.hpp"
#include "common/frames.hpp"
#include "host/can/candump_text.hpp"

namespace {

using namespace strainfinger;

std::string compact(const CanFrame& frame) {
  const std::string line = can::formatLogLine(0, "x", frame);
  return line.substr(line.rfind(' ') + 1);
}

template <typename Frame>
std::string encodeLine(std::istringstream& words) {
  unsigned node = 0;
  words >> node;
  Frame values;
  const auto take = [&](const auto& field) {
    std::int64_t raw = 0;
    words >> raw;
    values.*field.member = memberOf<std::remove_reference_t<decltype(values.*field.member)>>(raw);
  };
  std::apply([&take](const auto&... field) { (take(field), ...); }, kLayout<Frame>.fields);
  return words ? compact(encode(values, static_cast<std::uint8_t>(node))) : "bad line";
}

template <typename Frame>
std::optional<std::string> decodeAs(const CanFrame& frame) {
  const std::optional<Frame> values = decode<Frame>(frame);
  if (!values) return std::nullopt;
  std::string text =
      fmt::format("{} {}", kLayout<Frame>.spec.name, *nodeOf(frame.id, kLayout<Frame>.spec.function));
  const auto append = [&](const auto& field) { text += fmt::format(" {}", rawOf(*values.*field.member)); };
  std::apply([&append](const auto&... field) { (append(field), ...); }, kLayout<Frame>.fields);
  return text;
}

std::string decodeLine(const std::string& frameText) {
  const auto parsed = can::parseLogLine(std::string("(0.000000) x ").append(frameText));
  const auto* line = std::get_if<can::LogLine>(&parsed);
  const std::optional<CanFrame> frame = line != nullptr ? can::classicFrame(*line) : std::nullopt;
  if (!frame) return "bad line";
  if (const auto contact = decodeAs<ContactFrame>(*frame)) return *contact;
  if (const auto force = decodeAs<ForceFrame>(*frame)) return *force;
  if (const auto heartbeat = decodeAs<HeartbeatFrame>(*frame)) return *heartbeat;
  if (const auto info = decodeAs<InfoFrame>(*frame)) return *info;
  if (const auto gauges = decodeAs<GaugesFrame>(*frame)) return *gauges;
  if (const auto request = decodeAs<RequestFrame>(*frame)) return *request;
  return decodeAs<ResponseFrame>(*frame).value_or("none");
}

std::string answer(const std::string& line) {
  std::istringstream words(line);
  std::string verb, what;
  words >> verb >> what;
  if (verb == "decode") return decodeLine(what);
  if (what == "CONTACT") return encodeLine<ContactFrame>(words);
  if (what == "FORCE") return encodeLine<ForceFrame>(words);
  if (what == "INFO") return encodeLine<InfoFrame>(words);
  if (what == "GAUGES") return encodeLine<GaugesFrame>(words);
  if (what == "REQUEST") return encodeLine<RequestFrame>(words);
  if (what == "RESPONSE") return encodeLine<ResponseFrame>(words);
  return what == "HEARTBEAT" ? encodeLine<HeartbeatFrame>(words) : "bad line";
}

}  // namespace

int main() {
  for (std::string line; std::getline(std::cin, line);) fmt::print("{}\n", answer(line));
}
