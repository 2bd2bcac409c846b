#include "host/base/atomic_file.hpp"

#include <CppUTest/TestHarness.h>
#include <sys/stat.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "host/base/failure.hpp"

using namespace strainfinger;

TEST_GROUP(AtomicFile) {
  std::filesystem::path folder_;

  void setup() override {
    std::string name = std::filesystem::temp_directory_path() / "atomic_file.XXXXXX";
    CHECK(mkdtemp(name.data()) != nullptr);
    folder_ = name;
  }
  void teardown() override { std::filesystem::remove_all(folder_); }

  std::string content(const char* name) {
    std::ostringstream text;
    text << std::ifstream(folder_ / name, std::ios::binary).rdbuf();
    return text.str();
  }
  long files() { return std::distance(std::filesystem::directory_iterator(folder_), {}); }
};

TEST(AtomicFile, WritesEveryByte) {
  const std::string bytes("a\0b\r\n\xFF", 6);
  writeFileAtomically(folder_ / "file", bytes);
  CHECK(content("file") == bytes);
}

TEST(AtomicFile, ReplacesWhatWasThere) {
  writeFileAtomically(folder_ / "file", "a long first content");
  writeFileAtomically(folder_ / "file", "short");
  STRCMP_EQUAL("short", content("file").c_str());
  LONGS_EQUAL(1, files());
}

TEST(AtomicFile, IsReadableAsOrdinaryFilesAre) {
  const mode_t before = umask(022);
  writeFileAtomically(folder_ / "file", "");
  umask(before);
  struct stat status {};
  LONGS_EQUAL(0, stat((folder_ / "file").c_str(), &status));
  LONGS_EQUAL(0644, status.st_mode & 0777);
}

TEST(AtomicFile, AFailureNamesThePathAndTheReason) {
  try {
    writeFileAtomically(folder_ / "nowhere" / "file", "x");
    FAIL("no failure");
  } catch (const Failure& failure) {
    CHECK(failure.code() == ExitCode::kFailure);
    STRCMP_CONTAINS("nowhere/file: No such file or directory", failure.what());
  }
}

TEST(AtomicFile, AFailureLeavesNothingBehind) {
  std::filesystem::create_directory(folder_ / "taken");
  CHECK_THROWS(Failure, writeFileAtomically(folder_ / "taken", "x"));
  LONGS_EQUAL(1, files());
}
