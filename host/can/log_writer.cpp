#include "host/can/log_writer.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "host/base/failure.hpp"
#include "host/can/candump_text.hpp"

namespace strainfinger::can {
namespace {

int createFile(const std::string& path) {
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor >= 0) return descriptor;
  const char* const remedy = errno == EEXIST ? ": remove it, or write to another file" : "";
  throw Failure(ExitCode::kFailure,
                fmt::format("{}: cannot make the file: {}{}", path, std::strerror(errno), remedy));
}

}  // namespace

LogWriter::LogWriter(const std::string& path) : path_(path), descriptor_(createFile(path)) {}

LogWriter::~LogWriter() { ::close(descriptor_); }

void LogWriter::add(std::int64_t time_ns, std::string_view interface, const CanFrame& frame) {
  text_.append(formatLogLine(time_ns / 1000, interface, frame)).push_back('\n');
}

void LogWriter::flush() {
  for (std::size_t done = 0; done < text_.size();) {
    const ssize_t count = ::write(descriptor_, text_.data() + done, text_.size() - done);
    if (count < 0 && errno != EINTR) giveUp(errno, done);
    if (count > 0) done += static_cast<std::size_t>(count);
  }
  written_ += static_cast<std::int64_t>(text_.size());
  text_.clear();
}

void LogWriter::giveUp(int error, std::size_t done) {
  const std::size_t lineEnd = std::string_view(text_).substr(0, done).rfind('\n');
  written_ += lineEnd == text_.npos ? 0 : static_cast<std::int64_t>(lineEnd) + 1;
  text_.clear();
  const char* const end = ::ftruncate(descriptor_, written_) == 0 ? "" : ", with half a line at its end";
  throw Failure(ExitCode::kFailure, fmt::format("{}: cannot write: {}; what was written before stays{}",
                                                path_, std::strerror(error), end));
}

}  // namespace strainfinger::can
