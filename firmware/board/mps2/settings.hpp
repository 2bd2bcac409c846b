#pragma once
// What an emulated finger is: shared with who wants to know what it will say.

#include <charconv>
#include <optional>
#include <string_view>

#include "firmware/app/finger.hpp"
#include "firmware/board/mps2/world_record.hpp"

namespace strainfinger::mps2 {

/// Of node `node`; domain: kFirstNode .. kLastNode.
constexpr firmware::FingerSettings settingsOf(std::uint8_t node) {
  return {.node = node,
          .samplePeriod_us = kRecordPeriod_us,
          .standingFlags = {FingerFlag::kUncalibrated, FingerFlag::kSimulated}};
}

/// N of "node=N" at the end of the emulator's command line, so that one image serves every finger of a bus;
/// kFirstNode when it isn't there. Nothing for what is no node.
inline std::optional<std::uint8_t> nodeOf(std::string_view commandLine) {
  constexpr std::string_view kKey = "node=";
  const std::size_t at = commandLine.find(kKey);
  if (at == std::string_view::npos) return kFirstNode;
  const std::string_view digits = commandLine.substr(at + kKey.size());
  std::uint8_t node = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), node);
  const bool isNode =
      error == std::errc{} && end == digits.data() + digits.size() && node >= kFirstNode && node <= kLastNode;
  return isNode ? std::optional(node) : std::nullopt;
}

/// "time=timer" on the command line: time is the board's, for people who try it by hand; else it is the
/// number of records, so that a run is the same every time.
constexpr bool isTimed(std::string_view commandLine) {
  return commandLine.find("time=timer") != std::string_view::npos;
}

}  // namespace strainfinger::mps2
