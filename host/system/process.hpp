#pragma once
// Running another program to its end.

#include <string>
#include <vector>

namespace strainfinger::system {

/// Runs `command` (found in PATH, no shell) in `folder`, waits, and returns what it wrote to stdout. Throws
/// Failure(kFailure) when it is not installed (naming the Debian `package` that has it), cannot be started,
/// or fails, with what it wrote to stderr.
std::string runIn(const std::string& folder, const std::vector<std::string>& command,
                  const std::string& package);

}  // namespace strainfinger::system
