#include "host/base/atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>

#include "host/base/failure.hpp"

namespace strainfinger {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& path, int error) {
  throw Failure(ExitCode::kFailure, fmt::format("cannot write {}: {}", path, std::strerror(error)));
}

/// What /dev/stdout and its like lead to. The name that such a link has in turn may be none, or another
/// file's by now.
bool isOpenFile(const fs::path& path) {
  std::error_code error;
  return fs::is_symlink(path, error) && fs::equivalent(path.parent_path(), "/proc/self/fd", error);
}

/// Where symbolic links lead, be there something or not.
fs::path destinationOf(fs::path path) {
  constexpr int kMostLinks = 40;  // Linux follows no more
  std::error_code error;
  for (int links = 0; links < kMostLinks && fs::is_symlink(path, error) && !isOpenFile(path); ++links)
    path = path.parent_path() / fs::read_symlink(path, error);
  return path;
}

bool isRegularOrAbsent(const fs::path& path) {
  struct stat status {};
  return stat(path.c_str(), &status) == 0 ? S_ISREG(status.st_mode) : errno == ENOENT;
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
  return true;
}

bool makeOrdinary(int file) { return fchmod(file, ordinaryMode()) == 0 && fsync(file) == 0; }

/// The system's reason why not; 0: done.
int closeAfter(bool done, int file) {
  const int error = done ? 0 : errno;
  return close(file) != 0 && error == 0 ? errno : error;
}

int writeStraight(int file, std::string_view content) {
  if (file < 0) return errno;
  return closeAfter(writeAll(file, content), file);
}

int replace(const fs::path& path, std::string_view content) {
  std::string temporary = path.string().append(".XXXXXX");
  const int file = mkstemp(temporary.data());
  if (file < 0) return errno;
  int error = closeAfter(writeAll(file, content) && makeOrdinary(file), file);
  if (error == 0 && std::rename(temporary.c_str(), path.c_str()) != 0) error = errno;
  if (error != 0) unlink(temporary.c_str());
  return error;
}

int writeTo(const fs::path& path, std::string_view content) {
  if (isOpenFile(path)) return writeStraight(dup(std::atoi(path.filename().c_str())), content);
  if (isRegularOrAbsent(path)) return replace(path, content);
  return writeStraight(open(path.c_str(), O_WRONLY), content);
}

}  // namespace

void writeFileAtomically(const std::string& path, std::string_view content) {
  if (const int error = writeTo(destinationOf(path), content); error != 0) fail(path, error);
}

}  // namespace strainfinger
