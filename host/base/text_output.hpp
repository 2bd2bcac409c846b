#pragma once
// Text for a stream, handed over in large pieces.

#include <cstdio>
#include <string>

namespace strainfinger {

/// Who writes appends to text() and calls flush(): when a reader may be waiting, and at the end.
class TextOutput {
 public:
  explicit TextOutput(std::FILE* stream) : stream_(stream) {}

  std::string& text() { return text_; }

  /// Hands everything over. Throws Failure(kFailure) when the stream refuses (disk full, closed pipe).
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
