#pragma once
// Files that are there whole or not at all.

#include <string>
#include <string_view>

namespace strainfinger {

/// Writes `content` beside `path` and renames it there: readers see the old file or the new one, and a
/// failure leaves the old one. The new one may be read and written by whoever might the old one. A symbolic
/// link stays, and what it leads to is replaced. What is there and no regular file (a device, a pipe,
/// /dev/stdout) is written to as it is, not replaced. Throws Failure(kFailure) with the path and the system's
/// reason. "-" is no special name.
void writeFileAtomically(const std::string& path, std::string_view content);

/// The folder in which that makes a file and renames it; empty where it would write to what is there. Throws
/// Failure(kFailure) where the current folder has been removed.
std::string folderWrittenIn(const std::string& path);

}  // namespace strainfinger
