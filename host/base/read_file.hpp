#pragma once
// Files as a whole.

#include <string>

#include "host/base/failure.hpp"

namespace strainfinger {

/// All bytes of a file. Throws Failure(`unreadable`) with the path and the system's reason.
std::string readFile(const std::string& path, ExitCode unreadable);

}  // namespace strainfinger
