#include "host/base/text_output.hpp"

#include "host/base/failure.hpp"

namespace strainfinger {

void TextOutput::flush() {
  const bool written = std::fwrite(text_.data(), 1, text_.size(), stream_) == text_.size();
  text_.clear();
  if (!written || std::fflush(stream_) != 0)
    throw Failure(ExitCode::kFailure, "cannot write the output: disk full or reader gone");
}

}  // namespace strainfinger
