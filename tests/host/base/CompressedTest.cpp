#include "host/base/compressed.hpp"

#include <string>

#include "host/base/failure.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;

TEST_GROUP(Compressed) {
  static std::string complaintAbout(const std::string& beginning) {
    try {
      requireUncompressed("x.log", beginning);
    } catch (const Failure& failure) {
      LONGS_EQUAL(static_cast<int>(ExitCode::kFailure), static_cast<int>(failure.code()));
      return failure.what();
    }
    return "none";
  }
};

// The magic numbers of RFC 1952, RFC 8878 and of the .xz format.
TEST(Compressed, EachIsNamedWithWhatUnpacksIt) {
  STRCMP_CONTAINS("x.log is compressed with gzip: `zcat x.log | ", complaintAbout("\x1F\x8B\x08").c_str());
  STRCMP_CONTAINS("x.log is compressed with xz: `xzcat x.log | ",
                  complaintAbout(std::string("\xFD\x37\x7A\x58\x5A\0", 6)).c_str());
  STRCMP_CONTAINS("x.log is compressed with zstd: `zstdcat x.log | ",
                  complaintAbout("\x28\xB5\x2F\xFD").c_str());
}

TEST(Compressed, TextIsNone) {
  for (const char* text : {"", "(1.000000) can0 181#00\n", "(", "\x1F"})
    STRCMP_EQUAL("none", complaintAbout(text).c_str());
}
