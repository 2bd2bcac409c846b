#pragma once
// Rows out of a recording of a bus.

#include <cstdint>
#include <string>
#include <vector>

#include "host/config/finger_config.hpp"
#include "host/session/rows.hpp"

namespace strainfinger::session {

/// Whether the first line of a file (no pipe) with anything in it is one of candump's, in any of its forms.
bool isRecording(const std::string& path);

struct Recorded {
  Rows rows;                          ///< thinned, of unknown touches
  std::uint64_t sets = 0;             ///< that were whole
  std::vector<std::string> warnings;  ///< as can::LogReader has them
};

/// The readings (RAW) of a node on an interface of the log ("": on any), thinned as a session's are. Throws
/// Failure(kFailure) as can::LogReader does, when there are none, and when none is a touch; kMismatch as
/// can::RawReceiver does; kUsage as can::OneFinger does.
Recorded readRecording(const std::string& path, const config::FingerConfig& config, std::uint8_t node,
                       const std::string& interface = "");

}  // namespace strainfinger::session
