// The firmware's codec as a filter, for tests with other people's tools. A line in, a line out:
//   encode FRAME NODE RAW...   the raw values of the fields in the order of the table -> IDENTIFIER#DATA
//   decode IDENTIFIER#DATA     -> FRAME NODE RAW..., or "none"

#include <fmt/format.h>

#include <cstdint>
#include <iostream>
#include <optional>
#include <sstream>
#include <string>
#include <tuple>
#include <type_traits>
#include <variant>

#include "common/commands.hpp"
#include "common/frames.hpp"
#include "host/can/candump_text.hpp"

namespace {

using namespace strainfinger;

constexpr std::type_identity<decltype(std::tuple_cat(FingerFrames{}, CommandFrames{}))> kAllFrames;

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
  std::optional<std::string> text;
  const auto is = [&]<typename... Frames>(std::type_identity<std::tuple<Frames...>>) {
    return ((text = decodeAs<Frames>(*frame)) || ...);
  };
  return is(kAllFrames) ? *text : "none";
}

std::string answer(const std::string& line) {
  std::istringstream words(line);
  std::string verb, what;
  words >> verb >> what;
  if (verb == "decode") return decodeLine(what);
  std::string text = "bad line";
  const auto tryEach = [&]<typename... Frames>(std::type_identity<std::tuple<Frames...>>) {
    return ((what == kLayout<Frames>.spec.name && (text = encodeLine<Frames>(words), true)) || ...);
  };
  tryEach(kAllFrames);
  return text;
}

}  // namespace

int main() {
  for (std::string line; std::getline(std::cin, line);) fmt::print("{}\n", answer(line));
}
