#pragma once
// The frames of a log, for who needs every one of them.

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "host/base/line_reader.hpp"
#include "host/can/candump_text.hpp"
#include "host/can/log_times.hpp"
#include "host/can/time_window.hpp"

namespace strainfinger::can {

/// What of a log is read.
struct LogPart {
  std::string interface;  ///< of this one alone; "": of all
  TimeWindow window;
};

/// The time of a frame, which stands in the last line. Throws Failure(kFailure) where it has none.
std::int64_t requireTime(const TextFrame& frame, const LineReader& lines);

class LogReader {
 public:
  /// Reads `path`, in any text form of candump; "-" is stdin. Throws Failure(kFailure) if it cannot be
  /// opened.
  explicit LogReader(const std::string& path, LogPart part = {}) : lines_(path), part_(std::move(part)) {}

  /// The next classic data frame of an 11-bit identifier; nothing at the end. Throws Failure(kFailure) with
  /// file:line:column for a line that cannot be read, and for a frame without a time; but a last line behind
  /// others that breaks off, so that it cannot be read or is a finger's frame cut short, is left out: a
  /// logger that is killed or loses power leaves one.
  std::optional<TextFrame> next();

  /// Frames of other kinds so far, of the part that is read.
  std::uint64_t skipped() const { return skipped_; }

  /// What to tell, once all is read, of a last line that was left out, and of times that run backwards.
  std::vector<std::string> warnings() const;

  /// Once all is read: throws Failure(kFailure) where nothing was of the interface that is read.
  void requireInterface() const;
  /// The same where there were frames, but none of the part that is read.
  void requireAny() const;

  /// Of the log's first frame, whether it is of the part that is read or not; nothing before that.
  std::optional<std::int64_t> first_ns() const { return part_.window.first_ns(); }

  /// "x.log:3", of the last line.
  std::string place() const { return lines_.place(); }

 private:
  std::optional<std::string_view> nextLine();
  std::optional<TextFrame> frameOf(std::string_view line);
  bool isOfInterface(std::string_view interface) const;

  LineReader lines_;
  LogPart part_;
  LogLine parsed_;  ///< what the last frame points into where its line was not plain
  std::uint64_t skipped_ = 0;
  bool isWhole_ = true;    ///< the last line ended with a line end
  bool anyFrame_ = false;  ///< was read
  bool isCutOff_ = false;
  bool anyWanted_ = false;    ///< of the interface that is read, at whatever time
  bool anyRead_ = false;      ///< of the part that is read
  std::int64_t last_ns_ = 0;  ///< of the frames of the interface
  LogTimes times_{LogTimes::Order::kOfAll};
};

}  // namespace strainfinger::can
