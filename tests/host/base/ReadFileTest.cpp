#include "host/base/read_file.hpp"

#include <fstream>
#include <string>

#include "tests/host/plot/TemporaryFolder.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;

TEST_GROUP(ReadFile) {
  const plot::TemporaryFolder folder_;
  const std::string path_ = folder_.file("file");

  void checkRoundTrip(const std::string& bytes) {
    std::ofstream(path_, std::ios::binary) << bytes;
    CHECK(readFile(path_, ExitCode::kFailure) == bytes);
  }
  static void checkRefusal(const std::string& path, ExitCode code, const char* message) {
    try {
      readFile(path, code);
      FAIL("read");
    } catch (const Failure& failure) {
      LONGS_EQUAL(static_cast<int>(code), static_cast<int>(failure.code()));
      STRCMP_EQUAL(message, failure.what());
    }
  }
};

TEST(ReadFile, GivesEveryByte) {
  checkRoundTrip("");
  checkRoundTrip(std::string("a\0b\r\n\xFF", 6));
  for (const std::size_t size : {4095u, 4096u, 4097u, 100000u}) checkRoundTrip(std::string(size, 'x'));
}

TEST(ReadFile, SaysWhyItCannot) {
  checkRefusal("/nowhere/file", ExitCode::kUsage,
               "/nowhere/file: cannot read the file: No such file or directory");
  checkRefusal("/", ExitCode::kFailure, "/: cannot read the file: Is a directory");
  checkRefusal("/dev/zero", ExitCode::kUsage, "/dev/zero: more than 268435456 bytes: is it the right file?");
}
