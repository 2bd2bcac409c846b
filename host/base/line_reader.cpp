#include "host/base/line_reader.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "host/base/compressed.hpp"
#include "host/base/failure.hpp"

namespace strainfinger {
namespace {

/// Room for many lines, so that reading takes few calls; small enough to stay in a cache.
constexpr std::size_t kReadBuffer_bytes = 4 * LineReader::kLongestLine_bytes;

constexpr const char* kStdinPath = "-";

int openToRead(const std::string& path) { return ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK); }

}  // namespace

LineReader::LineReader(const std::string& path)
    : path_(path),
      name_(path == kStdinPath ? "stdin" : path),
      descriptor_(path == kStdinPath ? STDIN_FILENO : openToRead(path)),
      buffer_(kReadBuffer_bytes) {
  if (descriptor_ < 0) fail(name_, errno);
}

void LineReader::requireReadable(const std::string& path) {
  if (path != kStdinPath && ::access(path.c_str(), R_OK) != 0) fail(path, errno);
}

LineReader::~LineReader() {
  if (descriptor_ != STDIN_FILENO) ::close(descriptor_);
}

std::optional<std::string_view> LineReader::next() {
  for (;;) {
    const char* const start = buffer_.data() + begin_;
    const void* const found = std::memchr(buffer_.data() + searched_, '\n', end_ - searched_);
    if (found == nullptr) break;
    const auto length = static_cast<std::size_t>(static_cast<const char*>(found) - start);
    begin_ += length + 1;
    searched_ = begin_;
    if (std::exchange(skippingLine_, false)) continue;
    ++line_;
    return std::string_view(start, std::min(length, kLongestLine_bytes));
  }
  searched_ = end_;
  return end_ - begin_ > kLongestLine_bytes ? rest() : std::nullopt;
}

std::optional<std::string_view> LineReader::rest() {
  const std::string_view text(buffer_.data() + begin_, std::min(end_ - begin_, kLongestLine_bytes));
  begin_ = searched_ = end_;
  if (text.empty() || std::exchange(skippingLine_, true)) return std::nullopt;
  ++line_;
  return text;
}

std::string LineReader::place() const { return fmt::format("{}:{}", name_, line_); }

LineReader::Got LineReader::read(std::chrono::milliseconds longest) {
  if (!waitReadable(longest)) return Got::kNothing;
  makeRoom();
  const ssize_t count = ::read(descriptor_, buffer_.data() + end_, buffer_.size() - end_);
  if (count < 0 && errno != EINTR && errno != EAGAIN) fail(name_, errno);
  if (count < 0) return Got::kNothing;
  end_ += static_cast<std::size_t>(count);
  if (line_ == 0) requireUncompressed(name_, {buffer_.data(), end_});
  if (count > 0) return Got::kMore;
  rewindIfShrunk();
  return Got::kEnd;
}

bool LineReader::waitReadable(std::chrono::milliseconds longest) const {
  pollfd waiting{descriptor_, POLLIN, 0};
  return ::poll(&waiting, 1, static_cast<int>(longest.count())) > 0;
}

void LineReader::makeRoom() {
  std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
  end_ -= begin_;
  searched_ -= begin_;
  begin_ = 0;
}

void LineReader::rewindIfShrunk() {
  struct stat file {};
  const off_t at = ::lseek(descriptor_, 0, SEEK_CUR);
  if (at > 0 && ::fstat(descriptor_, &file) == 0 && S_ISREG(file.st_mode) && file.st_size < at) {
    ::lseek(descriptor_, 0, SEEK_SET);
    forget();
  }
}

void LineReader::forget() {
  begin_ = end_ = searched_ = 0;
  skippingLine_ = false;
  line_ = 0;
}

bool LineReader::isReplaced() const {
  struct stat named {
  }, read{};
  if (descriptor_ == STDIN_FILENO || ::stat(path_.c_str(), &named) != 0 || ::fstat(descriptor_, &read) != 0)
    return false;
  return named.st_ino != read.st_ino || named.st_dev != read.st_dev;
}

bool LineReader::reopen() {
  const int opened = openToRead(path_);
  if (opened < 0 && errno == ENOENT) return false;
  if (opened < 0) fail(name_, errno);
  ::close(std::exchange(descriptor_, opened));
  forget();
  return true;
}

void LineReader::fail(const std::string& name, int error) {
  throw Failure(ExitCode::kFailure, fmt::format("{}: cannot read: {}", name, std::strerror(error)));
}

}  // namespace strainfinger
