#include "host/live/log_watch.hpp"

#include <variant>

namespace strainfinger::live {

std::optional<can::LogError> LogWatch::take(std::string_view line) {
  const auto parsed = can::parseLogLine(line);
  if (const auto* error = std::get_if<can::LogError>(&parsed)) return *error;
  const auto& logged = std::get<can::LogLine>(parsed);
  if (logged.kind != can::LineKind::kData && logged.kind != can::LineKind::kRemote) return std::nullopt;
  time_us_ = logged.time_ns ? clock_.at(*logged.time_ns / 1000) : time_us_.value_or(0);
  Fleet& fleet = buses_.try_emplace(logged.interface, logged.interface, config_, tables_crc32_).first->second;
  if (const auto frame = can::classicFrame(logged))
    fleet.take(*time_us_, *frame);
  else
    fleet.takeOther(*time_us_, {.isRemote = logged.kind == can::LineKind::kRemote, .frame = logged.frame});
  return std::nullopt;
}

std::vector<BusView> LogWatch::views(std::int64_t now_us) {
  std::vector<BusView> views;
  for (auto& [name, fleet] : buses_) views.push_back(fleet.view(now_us));
  return views;
}

}  // namespace strainfinger::live
