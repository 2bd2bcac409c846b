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

namespace strainfinger::can {

class LogReader {
 public:
  /// Reads `path`, in any text form of candump; "-" is stdin. `interface`: give the frames of this one alone;
  /// "": of all. Throws Failure(kFailure) if it cannot be opened.
  explicit LogReader(const std::string& path, std::string interface = "")
      : lines_(path), interface_(std::move(interface)) {}

  /// The next classic data frame of an 11-bit identifier; nothing at the end. Throws Failure(kFailure) with
  /// file:line:column for a line that cannot be read, and for a frame without a time; but a last line behind
  /// others that breaks off, so that it cannot be read or is a finger's frame cut short, is left out: a
  /// logger that is killed or loses power leaves one.
  std::optional<TextFrame> next();

  /// Frames of other kinds so far, of the interface that is read.
  std::uint64_t skipped() const { return skipped_; }

  /// What to tell, once all is read, of a last line that was left out, and of times that run backwards.
  std::vector<std::string> warnings() const;

  /// Once all is read: throws Failure(kFailure) where nothing was of the interface that is read.
  void requireInterface() const;

  /// "x.log:3", of the last line.
  std::string place() const { return lines_.place(); }

 private:
  std::optional<std::string_view> nextLine();
  std::optional<TextFrame> frameOf(std::string_view line);
  bool isWanted(std::string_view interface) const;

  LineReader lines_;
  std::string interface_;
  LogLine parsed_;  ///< what the last frame points into where its line was not plain
  std::uint64_t skipped_ = 0;
  bool isWhole_ = true;    ///< the last line ended with a line end
  bool anyFrame_ = false;  ///< was read
  bool isCutOff_ = false;
  bool anyWanted_ = false;  ///< of the interface that is read
  LogTimes times_{LogTimes::Order::kOfAll};
};

}  // namespace strainfinger::can
