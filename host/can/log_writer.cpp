#include "host/can/log_writer.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "host/base/failure.hpp"
#include "host/base/write_all.hpp"
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

void LogWriter::add(std::string_view interface, const OtherFrame& other) {
  text_.append(formatLogLine(other.time_ns / 1000, interface, other.frame, other.isRemote)).push_back('\n');
}

void LogWriter::flush() { appendLines(descriptor_, path_, std::exchange(text_, {})); }

}  // namespace strainfinger::can
