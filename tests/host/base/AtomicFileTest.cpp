#include "host/base/atomic_file.hpp"

#include <CppUTest/TestHarness.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
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
  void checkFailure(const std::filesystem::path& path, const char* message) {
    try {
      writeFileAtomically(path, "x");
      FAIL("no failure");
    } catch (const Failure& failure) {
      CHECK(failure.code() == ExitCode::kFailure);
      STRCMP_CONTAINS(message, failure.what());
    }
  }
  static std::string taken(int file) {
    std::array<char, 100> text{};
    const ssize_t size = read(file, text.data(), text.size());
    return {text.data(), static_cast<std::size_t>(std::max<ssize_t>(size, 0))};
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

TEST(AtomicFile, StaysReadableToTheSameOnlyWhenItIsReplaced) {
  for (const mode_t mode : {0600U, 0664U}) {
    writeFileAtomically(folder_ / "file", "old");
    LONGS_EQUAL(0, chmod((folder_ / "file").c_str(), mode));
    writeFileAtomically(folder_ / "file", "new");
    STRCMP_EQUAL("new", content("file").c_str());
    struct stat status {};
    LONGS_EQUAL(0, stat((folder_ / "file").c_str(), &status));
    LONGS_EQUAL(mode, status.st_mode & 0777);
  }
}

// A program that was killed may have left such a file.
TEST(AtomicFile, WhatStandsWhereItIsMadeStays) {
  const std::string name = "file." + std::to_string(getpid()) + "-0";
  std::ofstream(folder_ / name) << "other";
  writeFileAtomically(folder_ / "file", "new");
  STRCMP_EQUAL("new", content("file").c_str());
  STRCMP_EQUAL("other", content(name.c_str()).c_str());
}

TEST(AtomicFile, AFailureNamesThePathAndTheReason) {
  checkFailure(folder_ / "nowhere" / "file", "nowhere/file: No such file or directory");
}

TEST(AtomicFile, AFailureLeavesNothingBehind) {
  std::filesystem::create_directory(folder_ / "taken");
  CHECK_THROWS(Failure, writeFileAtomically(folder_ / "taken", "x"));
  LONGS_EQUAL(1, files());
}

TEST(AtomicFile, LinksStayAndWhatTheyLeadToIsReplaced) {
  std::filesystem::create_directory(folder_ / "there");
  writeFileAtomically(folder_ / "there" / "file", "old");
  std::filesystem::create_symlink("there/file", folder_ / "link");
  std::filesystem::create_symlink(folder_ / "link", folder_ / "link to a link");
  writeFileAtomically(folder_ / "link to a link", "new");
  CHECK(std::filesystem::is_symlink(folder_ / "link to a link"));
  CHECK(std::filesystem::is_symlink(folder_ / "link"));
  STRCMP_EQUAL("new", content("there/file").c_str());
  CHECK(!std::filesystem::is_symlink(folder_ / "there" / "file"));
}

TEST(AtomicFile, ReadersOfALinkedFileSeeAllOfTheOldOne) {
  writeFileAtomically(folder_ / "file", "old");
  std::filesystem::create_symlink("file", folder_ / "link");
  const int reader = open((folder_ / "file").c_str(), O_RDONLY);
  writeFileAtomically(folder_ / "link", "new");
  STRCMP_EQUAL("old", taken(reader).c_str());
  close(reader);
}

TEST(AtomicFile, ALinkToNothingGetsItsFile) {
  std::filesystem::create_symlink("file", folder_ / "link");
  writeFileAtomically(folder_ / "link", "new");
  CHECK(std::filesystem::is_symlink(folder_ / "link"));
  STRCMP_EQUAL("new", content("file").c_str());
}

TEST(AtomicFile, LinksInACircleAreAFailure) {
  std::filesystem::create_symlink("b", folder_ / "a");
  std::filesystem::create_symlink("a", folder_ / "b");
  checkFailure(folder_ / "a", "a: Too many levels of symbolic links");
}

TEST(AtomicFile, APipeIsWrittenToAndStays) {
  const std::string pipe = folder_ / "pipe";
  LONGS_EQUAL(0, mkfifo(pipe.c_str(), 0600));
  const int reader = open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
  writeFileAtomically(pipe, "through");
  STRCMP_EQUAL("through", taken(reader).c_str());
  close(reader);
  CHECK(std::filesystem::is_fifo(pipe));
  CHECK(std::filesystem::status(pipe).permissions() == std::filesystem::perms(0600));
  LONGS_EQUAL(1, files());
}

TEST(AtomicFile, AnOpenFileGetsWhatFollowsWhereItIs) {
  const std::string path = folder_ / "output";
  const int output = open(path.c_str(), O_WRONLY | O_CREAT, 0600);
  LONGS_EQUAL(7, write(output, "before ", 7));
  std::filesystem::create_symlink("/proc/self/fd/" + std::to_string(output), folder_ / "link");
  writeFileAtomically(folder_ / "link", "asked for");
  LONGS_EQUAL(6, write(output, " after", 6));
  close(output);
  STRCMP_EQUAL("before asked for after", content("output").c_str());
}

TEST(AtomicFile, AnOpenPipeIsWrittenTo) {
  std::array<int, 2> ends{};
  LONGS_EQUAL(0, pipe(ends.data()));
  writeFileAtomically("/dev/fd/" + std::to_string(ends[1]), "through");
  STRCMP_EQUAL("through", taken(ends[0]).c_str());
  for (const int end : ends) close(end);
}

TEST(AtomicFile, ADeviceThatRefusesIsAFailureAndStays) {
  std::filesystem::create_symlink("/dev/full", folder_ / "full");
  checkFailure(folder_ / "full", "full: No space left on device");
  CHECK(std::filesystem::is_character_file("/dev/full"));
  LONGS_EQUAL(1, files());
}
