#include "host/base/text_output.hpp"

#include "host/base/failure.hpp"

namespace strainfinger {

namespace {

void require(bool isWritten) {
  if (!isWritten) throw Failure(ExitCode::kFailure, "cannot write the output: disk full or reader gone");
}

}  // namespace

void writeText(std::FILE* stream, std::string_view text) {
  require(std::fwrite(text.data(), 1, text.size(), stream) == text.size());
}

void writeAndFlush(std::FILE* stream, std::string_view text) {
  writeText(stream, text);
  require(std::fflush(stream) == 0);
}

void TextOutput::flush() {
  writeAndFlush(stream_, text_);
  text_.clear();
}

}  // namespace strainfinger
