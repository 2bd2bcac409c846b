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

std::int64_t requireTime(const TextFrame& frame, const LineReader& lines) {
  if (!frame.time_ns)
    throw Failure(
        ExitCode::kFailure,
        fmt::format("{}: a frame without a time: log with `candump -L`, or `candump -ta`", lines.place()));
  return *frame.time_ns;
}

std::optional<TextFrame> LogReader::next() {
  while (const auto line = nextLine()) {
    const auto frame = frameOf(*line);
    if (!frame) continue;
    isCutOff_ = !isWhole_ && isTooShort(frame->frame);
    if (isCutOff_) continue;
    anyFrame_ = true;
    const std::int64_t time_ns = requireTime(*frame, lines_);
    times_.watch(frame->interface, time_ns, lines_);
    const bool isInWindow = part_.window.has(time_ns);
    if (!isOfInterface(frame->interface)) continue;
    anyWanted_ = true;
    last_ns_ = time_ns;
    if (!isInWindow) continue;
    anyRead_ = true;
    return frame;
  }
  return std::nullopt;
}

bool LogReader::isOfInterface(std::string_view interface) const {
  return part_.interface.empty() || interface == part_.interface;
}

void LogReader::requireInterface() const {
  if (!part_.interface.empty() && !anyWanted_)
    throw Failure(ExitCode::kFailure,
                  fmt::format("{}: no frame of {} in it", lines_.name(), excerpt(part_.interface)));
}

void LogReader::requireAny() const {
  requireInterface();
  if (part_.window.isWhole() || anyRead_ || !anyWanted_) return;
  throw Failure(ExitCode::kFailure,
                fmt::format("{}: no frame of it is of that time: it is from {} to {}", lines_.name(),
                            timeText(first_ns().value_or(0)), timeText(last_ns_)));
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
  const bool isInWindow = !hasFrame(parsed_) || !parsed_.time_ns || part_.window.has(*parsed_.time_ns);
  if (hasFrame(parsed_) && isInWindow && isOfInterface(parsed_.interface)) ++skipped_;
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
  if (const std::string warning = times_.warning(); !warning.empty()) warnings.push_back(warning);
  if (isCutOff_)
    warnings.push_back(fmt::format("{}: the log breaks off in this line, which is left out", place()));
  return warnings;
}

}  // namespace strainfinger::can
