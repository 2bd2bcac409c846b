#include "host/base/atomic_file.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>

#include "host/base/failure.hpp"

namespace strainfinger {
namespace {

[[noreturn]] void fail(const std::string& path, int error) {
  throw Failure(ExitCode::kFailure, fmt::format("cannot write {}: {}", path, std::strerror(error)));
}

/// mkstemp makes files only their owner can read; what was asked for is an ordinary one.
mode_t ordinaryMode() {
  const mode_t mask = umask(0);
  umask(mask);
  return 0666 & ~mask;
}

bool writeAll(int file, std::string_view content) {
  while (!content.empty()) {
    const ssize_t written = ::write(file, content.data(), content.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    content.remove_prefix(static_cast<std::size_t>(written));
  }
  return fchmod(file, ordinaryMode()) == 0 && fsync(file) == 0;
}

}  // namespace

void writeFileAtomically(const std::string& path, std::string_view content) {
  std::string temporary = path;
  temporary.append(".XXXXXX");
  const int file = mkstemp(temporary.data());
  if (file < 0) fail(path, errno);
  int error = writeAll(file, content) ? 0 : errno;
  if (close(file) != 0 && error == 0) error = errno;
  if (error == 0 && std::rename(temporary.c_str(), path.c_str()) != 0) error = errno;
  if (error == 0) return;
  unlink(temporary.c_str());
  fail(path, error);
}

}  // namespace strainfinger
