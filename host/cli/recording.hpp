#pragma once
// A bus, written down: a log, and notes on it beside it.

#include <cstdint>
#include <string>
#include <vector>

#include "host/can/bus_port.hpp"
#include "host/can/log_writer.hpp"
#include "host/cli/recording_notes.hpp"
#include "host/config/finger_config.hpp"

namespace strainfinger::cli {

/// From its construction on. The notes are in place from the start, so that a recording that is cut off has
/// them too; they lack its end then.
class Recording {
 public:
  /// Makes `path` and, in its place with .toml at the end, the notes. Throws Failure(kUsage) when the path
  /// itself ends in .toml, Failure(kFailure) when there is a file of either name already or one cannot be
  /// made; then neither stays. `port` is where the frames come from; it must outlive the recording.
  Recording(can::BusPort& port, const config::FingerConfig& config, const std::string& path);

  /// Takes what the port received, in that order.
  void take(const can::TimedFrame& timed);
  void take(const can::OtherFrame& other);

  /// Looks whether the bus is there, for the notes: to be called several times a second. True: it has gone or
  /// come back since the last call.
  bool lookAtBus();
  bool isBusThere() const { return isBusThere_; }

  /// Hands what was heard to the system: a killed program loses what came since. Throws Failure(kFailure)
  /// when the disk is full, and when others have removed the log or cut it.
  void flush();

  /// The last flush(); completes the notes. Throws like it.
  void end();

  /// See RecordingNotes.
  std::vector<std::uint8_t> nodesOfOtherTables(std::uint32_t tables_crc32) const {
    return notes_.nodesOfOtherTables(tables_crc32);
  }
  const RecordingProgress& progress() const { return progress_; }
  const std::string& path() const { return path_; }
  const std::string& notesPath() const { return notesPath_; }
  /// See can::LogWriter.
  std::string renamedTo() const { return log_.renamedTo(); }

 private:
  void writeNotes() const;

  can::BusPort& port_;
  std::string path_;
  std::string notesPath_;
  can::LogWriter log_;
  RecordingNotes notes_;
  RecordingProgress progress_;
  std::uint32_t missedBefore_;  ///< frames that the port had missed when this began
  std::uint32_t timesAway_;     ///< of the port, when it was last looked at
  std::int64_t looked_ns_;      ///< when that was
  bool isBusThere_ = true;
  bool isNew_ = false;  ///< the notes have to be written again
};

}  // namespace strainfinger::cli
