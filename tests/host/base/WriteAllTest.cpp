#include "host/base/write_all.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <string>

#include "host/base/failure.hpp"
#include "host/base/read_file.hpp"
#include "tests/host/base/smallest_disk.hpp"
#include "tests/host/plot/TemporaryFolder.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;

TEST_GROUP(WriteAll) {
  const plot::TemporaryFolder folder_;
  const std::string path_ = folder_.file("file");
  int file_ = -1;

  void setup() override { file_ = open(path_.c_str(), O_WRONLY | O_CREAT, 0600); }
  void teardown() override { close(file_); }
  std::string content() const { return readFile(path_, ExitCode::kFailure); }
};

TEST(WriteAll, SaysHowMuchWasWritten) {
  LONGS_EQUAL(5, writeAll(file_, "whole"));
  const SmallestDisk disk(8);
  LONGS_EQUAL(3, writeAll(file_, " and more"));
  STRCMP_EQUAL("whole an", content().c_str());
}

TEST(WriteAll, LinesAreAppendedWhereverTheFileStands) {
  appendLines(file_, path_, "a\nb\n");
  lseek(file_, 0, SEEK_SET);
  appendLines(file_, path_, "c\n");
  STRCMP_EQUAL("a\nb\nc\n", content().c_str());
}

TEST(WriteAll, NoHalfLineStaysOnAFullDisk) {
  appendLines(file_, path_, "one\n");
  const SmallestDisk disk(12);
  try {
    appendLines(file_, path_, "two\nthree\n");
    FAIL("no failure");
  } catch (const Failure& failure) {
    STRCMP_EQUAL((path_ + ": cannot write: File too large; what was written before stays").c_str(),
                 failure.what());
  }
  STRCMP_EQUAL("one\ntwo\n", content().c_str());
  CHECK_THROWS(Failure, appendLines(file_, path_, "a single line\n"));
  STRCMP_EQUAL("one\ntwo\n", content().c_str());
}
