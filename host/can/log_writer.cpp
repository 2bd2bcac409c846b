#include "host/can/log_writer.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

#include "host/base/failure.hpp"
#include "host/base/utc_text.hpp"
#include "host/base/write_all.hpp"
#include "host/can/candump_text.hpp"

namespace strainfinger::can {
namespace {

/// A device, a pipe or a link is not to be removed.
const char* remedyForExisting(const std::string& path) {
  struct stat existing {};
  if (::lstat(path.c_str(), &existing) == 0 && S_ISREG(existing.st_mode))
    return ": remove it, or write to another file";
  return ": a log needs a regular file of its own; `candump -L can0 | zstd >x.log.zst` is for pipes";
}

int createFile(const std::string& path) {
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor >= 0) return descriptor;
  const int error = errno;
  throw Failure(ExitCode::kFailure, fmt::format("{}: cannot make the file: {}{}", path, std::strerror(error),
                                                error == EEXIST ? remedyForExisting(path) : ""));
}

}  // namespace

LogWriter::LogWriter(const std::string& path) : path_(path), descriptor_(createFile(path)) {}

LogWriter::~LogWriter() { ::close(descriptor_); }

void LogWriter::add(std::int64_t time_ns, std::string_view interface, const CanFrame& frame) {
  text_.append(formatLogLine(time_ns / 1000, interface, frame)).push_back('\n');
}

void LogWriter::add(std::string_view interface, const OtherFrame& other) {
  text_.append(formatLogLine(other.time_ns / 1000, interface, other.frame, other.isRemote)).push_back('\n');
}

void LogWriter::flush() {
  const std::string text = std::exchange(text_, {});
  appendLines(descriptor_, path_, text);
  written_bytes_ += text.size();
  requireWhole(text.size());
}

/// `last_bytes`: what was appended just now, behind whatever was left of it.
void LogWriter::requireWhole(std::size_t last_bytes) const {
  struct stat file {};
  if (::fstat(descriptor_, &file) != 0) return;
  const auto size_bytes = static_cast<std::size_t>(file.st_size);
  if (file.st_nlink == 0)
    throw Failure(ExitCode::kFailure,
                  fmt::format("{}: it was removed while it was written: all its frames, up to {}, are lost; "
                              "record into another file",
                              path_, utcText(now_ns())));
  if (size_bytes < written_bytes_)
    throw Failure(ExitCode::kFailure,
                  fmt::format("{}: it was cut while it was written (by logrotate's copytruncate?): what came "
                              "behind its first {} bytes, up to {}, is not in it; record into another file",
                              path_, size_bytes - std::min(last_bytes, size_bytes), utcText(now_ns())));
}

std::string LogWriter::renamedTo() const {
  struct stat named {
  }, written{};
  if (::fstat(descriptor_, &written) != 0) return "";
  const bool isNamed = ::stat(path_.c_str(), &named) == 0;
  if (isNamed && named.st_ino == written.st_ino && named.st_dev == written.st_dev) return "";
  std::error_code unknown;  // without /proc it is not known where it is
  return std::filesystem::read_symlink(fmt::format("/proc/self/fd/{}", descriptor_), unknown).string();
}

}  // namespace strainfinger::can
