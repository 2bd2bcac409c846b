#include "host/base/line_reader.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>

#include "host/base/failure.hpp"
#include "tests/host/plot/TemporaryFolder.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;

TEST_GROUP(LineReader) {
  static constexpr std::chrono::milliseconds kSoon{10};
  const plot::TemporaryFolder folder_;
  const std::string path_ = folder_.file("lines");

  void append(const std::string& text) const {
    std::ofstream(path_, std::ios::binary | std::ios::app) << text;
  }

  /// All whole lines up to the file's end, each in brackets.
  static std::string linesOf(LineReader & reader) {
    std::string text;
    for (auto got = LineReader::Got::kMore; got != LineReader::Got::kEnd; got = reader.read(kSoon))
      while (const auto line = reader.next()) text.append("[").append(*line).append("]");
    while (const auto line = reader.next()) text.append("[").append(*line).append("]");
    return text;
  }

  static void checkFails(const std::string& path, const char* message) {
    try {
      LineReader reader(path);
      reader.read(kSoon);
      FAIL("read");
    } catch (const Failure& failure) {
      LONGS_EQUAL(static_cast<int>(ExitCode::kFailure), static_cast<int>(failure.code()));
      STRCMP_EQUAL(message, failure.what());
    }
  }
};

TEST(LineReader, HandsOutLinesWithoutTheirEnds) {
  append("one\n\ntwo\r\nthree\n");
  LineReader reader(path_);
  STRCMP_EQUAL("[one][][two\r][three]", linesOf(reader).c_str());
  CHECK_FALSE(reader.rest().has_value());
}

TEST(LineReader, ACompressedFileIsNoText) {
  append("\x28\xB5\x2F\xFDrubbish\nrubbish\n");
  const std::string message =
      path_ + " is compressed with zstd: `zstdcat " + path_ +
      " | strainfinger decode`, and so for other commands that read stdin; else unpack "
      "it first";
  checkFails(path_, message.c_str());
}

TEST(LineReader, ALastLineMayHaveNoEnd) {
  append("one\ntwo");
  LineReader reader(path_);
  STRCMP_EQUAL("[one]", linesOf(reader).c_str());
  CHECK(reader.rest() == "two");
  CHECK_FALSE(reader.rest().has_value());
}

TEST(LineReader, ReadsFilesMuchLargerThanItsMemory) {
  std::string text, expected;
  for (int i = 0; i < 200'000; ++i) {
    text.append(std::to_string(i)).append("\n");
    expected.append("[").append(std::to_string(i)).append("]");
  }
  append(text);
  LineReader reader(path_);
  CHECK(expected == linesOf(reader));
}

TEST(LineReader, CutsLinesThatHaveNoEnd) {
  append(std::string(1'000'000, 'x') + "\nnext\n" + std::string(LineReader::kLongestLine_bytes + 1, 'y') +
         "\nlast\n");
  LineReader reader(path_);
  const std::string longest(LineReader::kLongestLine_bytes, 'x');
  const std::string longer(LineReader::kLongestLine_bytes, 'y');
  const std::string expected = "[" + longest + "][next][" + longer + "][last]";
  CHECK(expected == linesOf(reader));
}

TEST(LineReader, AFileThatGrowsIsReadOn) {
  append("one\ntw");
  LineReader reader(path_);
  STRCMP_EQUAL("[one]", linesOf(reader).c_str());
  append("o\nthree\n");
  STRCMP_EQUAL("[two][three]", linesOf(reader).c_str());
}

TEST(LineReader, AFileThatWasWrittenAnewIsReadFromItsStart) {
  append("one\ntwo\n");
  LineReader reader(path_);
  linesOf(reader);
  std::ofstream(path_, std::ios::trunc) << "new\n";
  linesOf(reader);  // notices
  STRCMP_EQUAL("[new]", linesOf(reader).c_str());
}

TEST(LineReader, AQuietPipeIsWaitedForNoLongerThanAsked) {
  LONGS_EQUAL(0, mkfifo(path_.c_str(), 0600));
  const int writer = ::open(path_.c_str(), O_RDWR | O_CLOEXEC);
  LineReader reader(path_);
  CHECK(reader.read(kSoon) == LineReader::Got::kNothing);
  LONGS_EQUAL(4, ::write(writer, "one\n", 4));
  CHECK(reader.read(kSoon) == LineReader::Got::kMore);
  CHECK(reader.next() == "one");
  ::close(writer);
}

TEST(LineReader, SaysWhatCannotBeRead) {
  checkFails("/nonexistent", "/nonexistent: cannot read: No such file or directory");
  checkFails("/", "/: cannot read: Is a directory");
  CHECK_THROWS(Failure, LineReader::requireReadable("/nonexistent"));
  LineReader::requireReadable("/");
  LineReader::requireReadable("-");
}

TEST(LineReader, CallsStdinByItsName) { STRCMP_EQUAL("stdin", LineReader("-").name().c_str()); }

TEST(LineReader, GoesOnWithTheFileThatHasTakenItsName) {
  append("old\nha");
  LineReader reader(path_);
  STRCMP_EQUAL("[old]", linesOf(reader).c_str());
  CHECK_FALSE(reader.isReplaced());
  std::filesystem::rename(path_, folder_.file("rotated"));
  CHECK_FALSE(reader.isReplaced());
  CHECK_FALSE(reader.reopen());
  std::ofstream(folder_.file("rotated"), std::ios::app) << "lf\n";
  append("new\n");
  CHECK_TRUE(reader.isReplaced());
  STRCMP_EQUAL("[half]", linesOf(reader).c_str());
  CHECK_TRUE(reader.reopen());
  CHECK_FALSE(reader.isReplaced());
  STRCMP_EQUAL("[new]", linesOf(reader).c_str());
}

TEST(LineReader, AFileThatHasShrunkIsReadFromItsStart) {
  append("one\ntwo\nha");
  LineReader reader(path_);
  STRCMP_EQUAL("[one][two]", linesOf(reader).c_str());
  STRCMP_EQUAL((path_ + ":2").c_str(), reader.place().c_str());
  std::filesystem::resize_file(path_, 0);
  append("new\n");
  STRCMP_EQUAL("", linesOf(reader).c_str());  // this read finds that it has shrunk
  STRCMP_EQUAL("[new]", linesOf(reader).c_str());
  STRCMP_EQUAL((path_ + ":1").c_str(), reader.place().c_str());
}

TEST(LineReader, StdinIsNeverReplaced) { CHECK_FALSE(LineReader("-").isReplaced()); }
