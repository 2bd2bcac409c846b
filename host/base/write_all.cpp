#include "host/base/write_all.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "host/base/failure.hpp"

namespace strainfinger {

std::size_t writeAll(int file, std::string_view content) {
  std::size_t done = 0;
  while (done < content.size()) {
    const ssize_t count = ::write(file, content.data() + done, content.size() - done);
    if (count < 0 && errno != EINTR) break;
    if (count > 0) done += static_cast<std::size_t>(count);
  }
  return done;
}

void appendLines(int file, const std::string& path, std::string_view lines) {
  const off_t before = ::lseek(file, 0, SEEK_END);
  const std::size_t done = writeAll(file, lines);
  if (done == lines.size()) return;
  const int error = errno;
  const std::size_t wholeLines = lines.substr(0, done).rfind('\n') + 1;  // npos + 1 is 0: none
  const bool isWhole = ::ftruncate(file, before + static_cast<off_t>(wholeLines)) == 0;
  throw Failure(ExitCode::kFailure,
                fmt::format("{}: cannot write: {}; what was written before stays{}", path,
                            std::strerror(error), isWhole ? "" : ", with half a line at its end"));
}

}  // namespace strainfinger
