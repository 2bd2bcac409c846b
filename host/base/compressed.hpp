#pragma once
// Compressed files that are given where text is read.

#include <string>
#include <string_view>

namespace strainfinger {

/// Throws Failure(kFailure) with what would unpack it where a file begins as those of gzip, xz and zstd do.
/// `name`: its path, or "stdin".
void requireUncompressed(const std::string& name, std::string_view beginning);

}  // namespace strainfinger
