#pragma once
// Files as a whole.

#include <cstddef>
#include <string>

#include "host/base/failure.hpp"

namespace strainfinger {

inline constexpr std::size_t kLargestFile = std::size_t{1} << 28;  ///< [bytes]: a device has no end

/// All bytes of a file. Throws Failure(`unreadable`) with the path and the system's reason, or where there
/// are more than kLargestFile.
std::string readFile(const std::string& path, ExitCode unreadable);

}  // namespace strainfinger
