#include "host/cli/recording.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <system_error>
#include <utility>

#include "host/base/atomic_file.hpp"
#include "host/base/failure.hpp"
#include "host/base/utc_text.hpp"

namespace strainfinger::cli {
namespace {

/// Of the gaps that the notes list: a bus that comes and goes all day must not make them large.
constexpr std::size_t kMostGaps = 100;

/// Where nothing is yet: the notes might replace the very config that they quote.
std::string newNotesPath(const std::string& path) {
  const auto notes = std::filesystem::path(path).replace_extension(".toml").string();
  if (notes == path)
    throw Failure(ExitCode::kUsage, fmt::format("{}: a log cannot end in .toml: its notes do", path));
  std::error_code unknown;  // a folder that cannot be looked into is one where the log cannot be made either
  if (std::filesystem::exists(notes, unknown))
    throw Failure(
        ExitCode::kFailure,
        fmt::format("{}: there is such a file already, where the notes of {} belong: write to another file",
                    notes, path));
  return notes;
}

}  // namespace

Recording::Recording(can::BusPort& port, const config::FingerConfig& config, const std::string& path)
    : port_(port),
      path_(path),
      notesPath_(newNotesPath(path)),
      log_(path),
      notes_(port.name(), config),
      missedBefore_(port.status().missed),
      timesAway_(port.status().busOffs),
      looked_ns_(now_ns()) {
  progress_.start_ns = looked_ns_;
  try {
    writeNotes();
  } catch (...) {
    std::remove(path_.c_str());  // it would be in the way of the next attempt
    throw;
  }
}

void Recording::take(const can::TimedFrame& timed) {
  log_.add(timed.time_ns, port_.name(), timed.frame);
  ++progress_.frames;
  isNew_ |= notes_.note(timed.frame);
}

void Recording::take(const can::OtherFrame& other) {
  log_.add(port_.name(), other);
  ++progress_.frames;
}

bool Recording::lookAtBus() {
  const hal::CanStatus status = port_.status();
  const std::int64_t before_ns = std::exchange(looked_ns_, now_ns());
  const bool hasGone = std::exchange(timesAway_, status.busOffs) != status.busOffs;
  const bool isThere = status.state != hal::CanState::kDown && status.state != hal::CanState::kBusOff;
  const bool wasThere = std::exchange(isBusThere_, isThere);
  if (isThere == wasThere && !(isThere && hasGone)) return false;  // it may be back already
  if (wasThere && ++progress_.gaps <= kMostGaps) progress_.firstGaps.push_back({.start_ns = before_ns});
  if (isThere && progress_.gaps <= kMostGaps) progress_.firstGaps.back().end_ns = looked_ns_;
  isNew_ |= progress_.gaps <= kMostGaps;
  return true;
}

void Recording::flush() {
  log_.flush();
  if (std::exchange(isNew_, false)) writeNotes();
}

void Recording::end() {
  log_.flush();
  progress_.end_ns = now_ns();
  progress_.missed = port_.status().missed - missedBefore_;
  writeNotes();
}

void Recording::writeNotes() const { writeFileAtomically(notesPath_, notes_.toml(progress_)); }

}  // namespace strainfinger::cli
