#include "host/base/text_output.hpp"

#include <cstddef>
#include <cstdlib>

#include "host/base/failure.hpp"

namespace strainfinger {

namespace {

void require(bool isWritten) {
  if (!isWritten) throw Failure(ExitCode::kFailure, "cannot write the output: disk full or reader gone");
}

/// A stream into memory, and that memory.
class MemoryStream {
 public:
  MemoryStream() : stream_(::open_memstream(&text_, &size_)) {
    if (stream_ == nullptr) throw Failure(ExitCode::kFailure, "out of memory");
  }
  ~MemoryStream() {
    std::fclose(stream_);
    std::free(text_);
  }
  MemoryStream(const MemoryStream&) = delete;
  MemoryStream& operator=(const MemoryStream&) = delete;

  std::FILE* stream() const { return stream_; }
  std::string text() const {
    require(std::fflush(stream_) == 0);
    return {text_, size_};
  }

 private:
  char* text_ = nullptr;
  std::size_t size_ = 0;
  std::FILE* stream_;
};

}  // namespace

void writeText(std::FILE* stream, std::string_view text) {
  require(std::fwrite(text.data(), 1, text.size(), stream) == text.size());
}

void writeAndFlush(std::FILE* stream, std::string_view text) {
  writeText(stream, text);
  require(std::fflush(stream) == 0);
}

std::string textWritten(const std::function<void(std::FILE*)>& write) {
  const MemoryStream memory;
  write(memory.stream());
  return memory.text();
}

void TextOutput::flush() {
  writeAndFlush(stream_, text_);
  text_.clear();
}

}  // namespace strainfinger
