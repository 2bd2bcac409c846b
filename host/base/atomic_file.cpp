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
#include <system_error>

#include "host/base/failure.hpp"
#include "host/base/write_all.hpp"

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
  return stat(path.c_str(), &status) == 0 ? S_ISREG(status.st_mode)
                                          : errno == ENOENT || errno == ENOTDIR || errno == EACCES;
}

/// A new file beside `path`, as ordinary as the system makes it; its name in `name`.
int createBeside(const fs::path& path, std::string& name) {
  constexpr int kMostTries = 1000;  // a program of this number that was killed may have left some
  for (int i = 0; i < kMostTries; ++i) {
    name = fmt::format("{}.{}-{}", path.string(), getpid(), i);
    const int file = open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file >= 0 || errno != EEXIST) return file;
  }
  return -1;
}

/// Whoever may read and write the file that is replaced, and nobody else; it may be another user's.
bool takeOver(const fs::path& path, int file) {
  struct stat old {};
  if (stat(path.c_str(), &old) != 0) return errno == ENOENT;
  const bool isSameOwner = fchown(file, old.st_uid, old.st_gid) == 0;
  return fchmod(file, old.st_mode & (isSameOwner ? 07777 : 0777)) == 0;
}

bool writeWhole(int file, std::string_view content) { return writeAll(file, content) == content.size(); }

/// The system's reason why not; 0: done.
int closeAfter(bool done, int file) {
  const int error = done ? 0 : errno;
  return close(file) != 0 && error == 0 ? errno : error;
}

int writeStraight(int file, std::string_view content) {
  if (file < 0) return errno;
  return closeAfter(writeWhole(file, content), file);
}

int replace(const fs::path& path, std::string_view content) {
  std::string temporary;
  const int file = createBeside(path, temporary);
  if (file < 0) return errno;
  int error = closeAfter(takeOver(path, file) && writeWhole(file, content) && fsync(file) == 0, file);
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

std::string folderWrittenIn(const std::string& path) {
  const fs::path target = destinationOf(path);
  if (isOpenFile(target) || !isRegularOrAbsent(target)) return "";
  std::error_code error;
  const fs::path whole = fs::absolute(target, error);
  if (error)
    throw Failure(ExitCode::kFailure,
                  fmt::format("{}: the current folder is not there any more ({}): change to another", path,
                              error.message()));
  return whole.parent_path().string();
}

void writeFileAtomically(const std::string& path, std::string_view content) {
  if (const int error = writeTo(destinationOf(path), content); error != 0) fail(path, error);
}

}  // namespace strainfinger
