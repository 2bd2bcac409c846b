#pragma once
// Writing to open files, by descriptor.

#include <cstddef>
#include <string>
#include <string_view>

namespace strainfinger {

/// How many bytes of it were written: all, or fewer after an error, which errno has then.
std::size_t writeAll(int file, std::string_view content);

/// Appends whole lines to the regular file `path`, which is open as `file`. Throws Failure(kFailure) when the
/// disk is full or broken; then the file ends with the last whole line that it took.
void appendLines(int file, const std::string& path, std::string_view lines);

}  // namespace strainfinger
