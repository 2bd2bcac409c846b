#include "host/tables/table_file.hpp"

#include <unistd.h>

#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>

#include "host/base/failure.hpp"
#include "host/tables/table_builder.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::tables;

TEST_GROUP(TableFile) {
  const std::string path =
      (std::filesystem::temp_directory_path() / ("strainfinger-table-file-" + std::to_string(getpid())))
          .string();
  const TableImage image = buildTableImage({});
  const std::string bytes = imageBytes(image);

  void teardown() override { std::filesystem::remove(path); }

  void write(const std::string& content) { std::ofstream(path, std::ios::binary) << content; }
  ExitCode statusOf(const std::string& content) {
    write(content);
    try {
      readTableFile(path);
    } catch (const Failure& failure) {
      STRCMP_CONTAINS(path.c_str(), failure.what());
      return failure.code();
    }
    return ExitCode::kOk;
  }
  void checkStatus(ExitCode expected, const std::string& content) {
    LONGS_EQUAL(static_cast<int>(expected), static_cast<int>(statusOf(content)));
  }
};

TEST(TableFile, WhatWasWrittenIsReadBack) {
  write(bytes);
  const auto read = readTableFile(path);
  MEMCMP_EQUAL(&image, read.get(), sizeof(image));
}

// Every bit before the rows, every 13th of theirs: a CRC-32 finds any single one, wherever it is.
TEST(TableFile, FlippedBitsAreNoticed) {
  TableImage flipped = image;
  auto* const data = reinterpret_cast<unsigned char*>(&flipped);
  constexpr std::size_t kRows = 8 * offsetof(TableImage, refined);
  for (std::size_t bit = 0; bit < 8 * sizeof(image); bit += bit < kRows ? 1 : 13) {
    data[bit / 8] = static_cast<unsigned char>(data[bit / 8] ^ (1u << (bit % 8)));
    CHECK(checkTableImage(flipped) != TableFault::kNone);
    data[bit / 8] = static_cast<unsigned char>(data[bit / 8] ^ (1u << (bit % 8)));
  }
  CHECK(checkTableImage(flipped) == TableFault::kNone);
}

TEST(TableFile, AFlippedBitOfTheRowsFailsVerification) {
  std::string flipped = bytes;
  flipped[5000] = static_cast<char>(flipped[5000] ^ 1);
  checkStatus(ExitCode::kVerificationFailed, flipped);
}

TEST(TableFile, TruncatedAnywhereFailsVerification) {
  for (std::size_t length = 0; length < bytes.size(); length += 97)
    checkStatus(ExitCode::kVerificationFailed, bytes.substr(0, length));
  checkStatus(ExitCode::kVerificationFailed, bytes.substr(0, bytes.size() - 1));
}

TEST(TableFile, BytesBehindTheImageFailVerification) {
  checkStatus(ExitCode::kVerificationFailed, bytes + '\0');
}

TEST(TableFile, AnotherFormatIsAMismatch) {
  std::string other = bytes;
  other[4] = static_cast<char>(kTableFormat + 1);
  checkStatus(ExitCode::kMismatch, other);
}

TEST(TableFile, AFolderIsAFailure) {
  CHECK_THROWS(Failure, readTableFile(std::filesystem::temp_directory_path().string()));
}

TEST(TableFile, AnImageOfTheConfigIsItsOwn) { requireTablesOf(image, {}, path); }

TEST(TableFile, EveryParameterThatDiffersIsNamed) {
  config::FingerConfig other;
  other.finger.poisson_ratio = 0.49;
  other.gauges.adc_bits = 14;
  try {
    requireTablesOf(image, other, path);
    FAIL("not refused");
  } catch (const Failure& failure) {
    LONGS_EQUAL(static_cast<int>(ExitCode::kMismatch), static_cast<int>(failure.code()));
    STRCMP_CONTAINS("finger.poisson_ratio", failure.what());
    STRCMP_CONTAINS("gauges.adc_bits", failure.what());
  }
}
