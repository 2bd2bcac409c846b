#pragma once
// Text for a stream, handed over in large pieces.

#include <cstdio>
#include <functional>
#include <string>
#include <string_view>

namespace strainfinger {

/// Throws Failure(kFailure) where not all of it can be written: the disk is full, or the reader gone.
void writeText(std::FILE* stream, std::string_view text);
/// The same, and of all that the stream holds back.
void writeAndFlush(std::FILE* stream, std::string_view text);

/// What `write` writes to the stream that it is given. Throws what it throws, and Failure(kFailure) without
/// the memory for it.
std::string textWritten(const std::function<void(std::FILE*)>& write);

/// Who writes appends to text() and calls flush(): when a reader may be waiting, and at the end.
class TextOutput {
 public:
  explicit TextOutput(std::FILE* stream) : stream_(stream) {}

  std::string& text() { return text_; }

  /// Hands everything over, as writeAndFlush().
  void flush();

  /// The same if there is much of it.
  void flushIfLarge() {
    if (text_.size() >= kLarge_bytes) flush();
  }

 private:
  static constexpr std::size_t kLarge_bytes = 64 * 1024;
  std::FILE* stream_;
  std::string text_;
};

}  // namespace strainfinger
