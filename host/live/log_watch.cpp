#include "host/live/log_watch.hpp"

#include <algorithm>
#include <variant>

namespace strainfinger::live {

std::optional<can::LogError> LogWatch::take(std::string_view line) {
  const auto parsed = can::parseLogLine(line);
  if (const auto* error = std::get_if<can::LogError>(&parsed)) return *error;
  const auto& logged = std::get<can::LogLine>(parsed);
  const auto frame = can::classicFrame(logged);
  if (!frame) return std::nullopt;
  const std::int64_t before_us = time_us_.value_or(0);
  time_us_ = std::max(before_us, logged.time_ns ? *logged.time_ns / 1000 : before_us);
  Fleet& fleet = buses_.try_emplace(logged.interface, logged.interface, config_, tables_crc32_).first->second;
  fleet.take(*time_us_, *frame);
  return std::nullopt;
}

std::vector<BusView> LogWatch::views(std::int64_t now_us) {
  std::vector<BusView> views;
  for (auto& [name, fleet] : buses_) views.push_back(fleet.view(now_us));
  return views;
}

}  // namespace strainfinger::live
