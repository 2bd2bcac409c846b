#include "host/can/log_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>
#include <variant>

#include "host/base/excerpt.hpp"
#include "host/base/failure.hpp"
#include "host/can/frame_catalogue.hpp"

namespace strainfinger::can {
namespace {

constexpr std::chrono::milliseconds kAtATime{1000};

/// Frames of several interfaces may be logged a little out of order; clocks that are set jump by more.
constexpr std::int64_t kOutOfOrder_ns = 1'000'000'000;
/// Where more than one frame in so many is earlier than the one before it, times are differences.
constexpr std::uint64_t kMostOutOfOrder = 4;

bool hasFrame(const LogLine& line) {
  return line.kind != LineKind::kNothing && line.kind != LineKind::kDropped;
}

/// Of a finger's identifier, and not one of its frames.
bool isTooShort(const CanFrame& frame) {
  const auto has = [&](const FrameEntry& entry) { return nodeOf(frame.id, entry.spec.function).has_value(); };
  return (std::ranges::any_of(frameCatalogue(), has) || std::ranges::any_of(commandCatalogue(), has)) &&
         findAnyFrame(frame) == nullptr;
}

}  // namespace

std::optional<TextFrame> LogReader::next() {
  while (const auto line = nextLine()) {
    const auto frame = frameOf(*line);
    if (!frame) continue;
    isCutOff_ = !isWhole_ && isTooShort(frame->frame);
    if (isCutOff_) continue;
    anyFrame_ = true;
    if (!frame->time_ns)
      throw Failure(
          ExitCode::kFailure,
          fmt::format("{}: a frame without a time: log with `candump -L`, or `candump -ta`", place()));
    watchTime(*frame->time_ns);
    if (!isWanted(frame->interface)) continue;
    watchOrder(*frame);
    return frame;
  }
  return std::nullopt;
}

bool LogReader::isWanted(std::string_view interface) const {
  return interface_.empty() || interface == interface_;
}

/// Each interface has a clock of its own.
void LogReader::watchOrder(const TextFrame& frame) {
  auto last = last_ns_.find(frame.interface);
  if (last == last_ns_.end()) last = last_ns_.emplace(frame.interface, *frame.time_ns).first;
  ++times_;
  if (*frame.time_ns < last->second) ++timesBack_;
  last->second = *frame.time_ns;
}

void LogReader::requireInterface() const {
  if (!interface_.empty() && times_ == 0)
    throw Failure(ExitCode::kFailure,
                  fmt::format("{}: no frame of {} in it", lines_.name(), excerpt(interface_)));
}

void LogReader::watchTime(std::int64_t time_ns) {
  const std::int64_t latest_ns = latest_ns_.value_or(time_ns);
  if (timesGoBack_.empty() && time_ns < latest_ns - kOutOfOrder_ns)
    timesGoBack_ = fmt::format(
        "{}: the times go back by {:.3g} s here: the clock was set, logs of several runs were joined, or "
        "they are differences (candump -td)",
        place(), 1e-9 * static_cast<double>(latest_ns - time_ns));
  latest_ns_ = std::max(latest_ns, time_ns);
}

std::optional<TextFrame> LogReader::frameOf(std::string_view line) {
  if (const auto plain = parsePlainLine(line)) return plain;
  auto parsed = parseLogLine(line);
  if (const auto* error = std::get_if<LogError>(&parsed)) {
    isCutOff_ = !isWhole_ && anyFrame_;
    if (isCutOff_) return std::nullopt;
    throw Failure(ExitCode::kFailure, fmt::format("{}:{}: {}", place(), error->column, error->reason));
  }
  parsed_ = std::move(std::get<LogLine>(parsed));
  const auto frame = classicFrame(parsed_);
  if (frame) return TextFrame{parsed_.time_ns, parsed_.interface, *frame};
  if (hasFrame(parsed_) && isWanted(parsed_.interface)) ++skipped_;
  return std::nullopt;
}

std::optional<std::string_view> LogReader::nextLine() {
  for (;;) {
    const auto line = lines_.next();
    if (line) isWhole_ = true;
    if (line) return line;
    if (lines_.read(kAtATime) != LineReader::Got::kEnd) continue;
    isWhole_ = false;
    return lines_.rest();
  }
}

std::vector<std::string> LogReader::warnings() const {
  std::vector<std::string> warnings;
  if (!timesGoBack_.empty())
    warnings.push_back(timesGoBack_);
  else if (timesBack_ > times_ / kMostOutOfOrder && timesBack_ > 1)
    warnings.push_back(
        fmt::format("{}: {} of {} frames have an earlier time than the one before: they are differences, it "
                    "seems (candump -td), which tell no times: log with `candump -L`, or `candump -ta`",
                    lines_.name(), timesBack_, times_));
  if (isCutOff_)
    warnings.push_back(fmt::format("{}: the log breaks off in this line, which is left out", place()));
  return warnings;
}

}  // namespace strainfinger::can
