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
      missedBefore_(port.status().missed) {
  progress_.start_ns = now_ns();
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
