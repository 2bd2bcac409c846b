#include "host/live/plain_report.hpp"

#include <fmt/format.h>

#include <string>

#include "host/base/text_output.hpp"
#include "host/base/text_parts.hpp"
#include "host/live/value_text.hpp"
#include "host/live/view_json.hpp"

namespace strainfinger::live {
namespace {

std::string plainLines(const BusView& bus) {
  if (bus.fingers.empty())
    return fmt::format("{:.3f} s  {}  no finger heard yet\n", static_cast<double>(bus.time_us) / 1e6,
                       bus.name);
  std::string lines;
  for (const FingerView& finger : bus.fingers) lines += plainLine(bus, finger) + "\n";
  return lines;
}

}  // namespace

std::optional<std::int64_t> PlainReport::due(std::int64_t time_us) {
  if (!next_us_) next_us_ = time_us + every_us_;
  if (time_us < *next_us_) return std::nullopt;
  const std::int64_t last_us = time_us - (time_us - *next_us_) % every_us_;
  next_us_ = last_us + every_us_;
  return last_us;
}

void PlainReport::print(std::span<const BusView> buses) const {
  std::string text;
  for (const BusView& bus : buses) {
    if (format_ == TableFormat::kJson)
      text += toJson(bus).dump() + "\n";
    else
      text += unicode_ ? plainLines(bus) : replacedAll(plainLines(bus), "±", "+-");
  }
  writeAndFlush(stream_, text);
}

}  // namespace strainfinger::live
