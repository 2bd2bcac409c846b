#pragma once
// What a watched bus says, written into a log.

#include <cstdint>
#include <string>
#include <utility>

#include "host/can/log_writer.hpp"
#include "host/live/bus_watch.hpp"

namespace strainfinger::live {

/// Records from construction to destruction.
class Recording {
 public:
  /// Throws Failure(kFailure) when the file is there already or cannot be made. `bus` is what the log calls
  /// the bus; `watch` must outlive it.
  Recording(BusWatch& watch, std::string bus, const std::string& path)
      : watch_(watch), bus_(std::move(bus)), path_(path), log_(path) {
    watch_.setTap([this](const can::TimedFrame& timed) {
      log_.add(timed.time_ns, bus_, timed.frame);
      ++frames_;
    });
  }
  ~Recording() { watch_.setTap({}); }
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;

  /// Hands what was heard to the system: a killed program loses what came since. Throws Failure(kFailure)
  /// when the disk is full.
  void flush() { log_.flush(); }

  const std::string& path() const { return path_; }
  std::uint64_t frames() const { return frames_; }

 private:
  BusWatch& watch_;
  std::string bus_;
  std::string path_;
  can::LogWriter log_;
  std::uint64_t frames_ = 0;
};

}  // namespace strainfinger::live
