#pragma once
// Files that are there whole or not at all.

#include <string>
#include <string_view>

namespace strainfinger {

/// Writes `content` beside `path` and renames it there: readers see the old file or the new one, and a
/// failure leaves the old one. Throws Failure(kFailure) with the path and the system's reason. "-" is no
/// special name.
void writeFileAtomically(const std::string& path, std::string_view content);

}  // namespace strainfinger
