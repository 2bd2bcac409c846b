#include "host/base/read_file.hpp"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

namespace strainfinger {

std::string readFile(const std::string& path, ExitCode unreadable) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
  std::string bytes;
  std::array<char, 4096> block;
  for (std::size_t count = 1; file && count > 0; bytes.append(block.data(), count)) {
    if (bytes.size() > kLargestFile)
      throw Failure(unreadable,
                    fmt::format("{}: more than {} bytes: is it the right file?", path, kLargestFile));
    count = std::fread(block.data(), 1, block.size(), file.get());
  }
  if (file && std::ferror(file.get()) == 0) return bytes;
  throw Failure(unreadable, fmt::format("{}: cannot read the file: {}", path, std::strerror(errno)));
}

}  // namespace strainfinger
