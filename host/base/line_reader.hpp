#pragma once
// Lines of text from a file, a pipe or a terminal, whatever their number, in memory that doesn't grow.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace strainfinger {

class LineReader {
 public:
  /// A longer line is cut to so many bytes.
  static constexpr std::size_t kLongestLine_bytes = 64 * 1024;

  enum class Got {
    kMore,     ///< next() may have lines
    kNothing,  ///< within the time, or a signal came
    kEnd,      ///< of the file, for now: it may grow
  };

  /// Reads `path`, or stdin where that is "-". A pipe that nobody writes into yet is waited for in read().
  /// Throws Failure(kFailure) with the path and the system's reason.
  explicit LineReader(const std::string& path);

  /// Throws as the constructor would, without opening it: who writes into a pipe would take that for its
  /// reader, who has gone.
  static void requireReadable(const std::string& path);

  ~LineReader();
  LineReader(const LineReader&) = delete;
  LineReader& operator=(const LineReader&) = delete;

  /// The path, or "stdin".
  const std::string& name() const { return name_; }

  /// "x.log:3": of the line that was handed out last.
  std::string place() const;

  /// The next whole line that has been read, without its "\n"; nothing: read() first. It holds until read().
  std::optional<std::string_view> next();

  /// What was read behind the last line end, which is a line too where the file ends without one.
  std::optional<std::string_view> rest();

  /// Waits for more, at most so long. Throws Failure(kFailure) when reading fails, and where the file is
  /// compressed. A file that has shrunk is
  /// read from its start, and the half line that was its end is lost.
  Got read(std::chrono::milliseconds longest);

  /// Whether the path names another file by now, as after a rotation by rename; not while it names none.
  bool isReplaced() const;
  /// Goes on with the file that the path names now; false: it names none, and this reads the old one still.
  /// Throws as the constructor does. What was read and not handed out is lost: take rest() before.
  bool reopen();

 private:
  bool waitReadable(std::chrono::milliseconds longest) const;
  void makeRoom();
  void rewindIfShrunk();
  void forget();
  [[noreturn]] static void fail(const std::string& name, int error);

  std::string path_;
  std::string name_;
  int descriptor_;
  std::vector<char> buffer_;
  std::size_t begin_ = 0;  ///< of what was read and not handed out
  std::size_t end_ = 0;
  std::size_t searched_ = 0;   ///< there is no line end from begin_ to here
  bool skippingLine_ = false;  ///< its beginning has been handed out
  std::uint64_t line_ = 0;     ///< of the file, that was handed out last
};

}  // namespace strainfinger
