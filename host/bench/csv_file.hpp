#pragma once
// A benchmark's figures as a file.

#include <cstdio>
#include <string>

#include "host/base/failure.hpp"

namespace strainfinger::bench {

/// write(file) fills it. Throws Failure(kFailure) with the path where it cannot be made or filled.
template <typename Write>
void writeCsvFile(const std::string& path, Write write) {
  std::FILE* const file = std::fopen(path.c_str(), "w");
  if (file == nullptr) throw Failure(ExitCode::kFailure, path + ": cannot write the file");
  write(file);
  const bool isFilled = std::ferror(file) == 0;
  if (std::fclose(file) != 0 || !isFilled)
    throw Failure(ExitCode::kFailure, path + ": cannot write the whole file");
}

}  // namespace strainfinger::bench
