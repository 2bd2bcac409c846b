#include "host/tables/table_file.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <fstream>
#include <memory>
#include <string>

#include "host/base/failure.hpp"
#include "host/tables/table_builder.hpp"
#include "tests/host/plot/TemporaryFolder.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::tables;

TEST_GROUP(TableFile) {
  const plot::TemporaryFolder folder_;
  const std::string path_ = folder_.file("finger.bin");
  const std::unique_ptr<TableImage> image_ = std::make_unique<TableImage>(buildTableImage({}));
  const std::string bytes_ = imageBytes(*image_);

  void write(const std::string& bytes) { std::ofstream(path_, std::ios::binary) << bytes; }

  /// "status: message" of reading a file; "whole" if it is.
  static std::string verdictOn(const std::string& path) {
    try {
      readTableFile(path);
      return "whole";
    } catch (const Failure& failure) {
      return fmt::format("{}: {}", static_cast<int>(failure.code()), failure.what());
    }
  }
  void checkVerdict(const std::string& bytes, const std::string& expected) {
    write(bytes);
    const std::string verdict = verdictOn(path_);
    STRCMP_EQUAL(expected.c_str(), verdict.substr(0, expected.size()).c_str());
  }
  std::string damaged(const std::string& what) { return fmt::format("6: {}: {}", path_, what); }

  /// Every bit of some bytes flipped alone.
  void checkFlips(std::size_t begin, std::size_t end, const std::string& expected, std::size_t step = 1) {
    for (std::size_t bit = 8 * begin; bit < 8 * end; bit += step) {
      std::string flipped = bytes_;
      flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << bit % 8));
      checkVerdict(flipped, expected);
    }
  }
};

TEST(TableFile, AWholeImageReadsBackAsItWas) {
  write(bytes_);
  const auto read = readTableFile(path_);
  MEMCMP_EQUAL(image_.get(), read.get(), sizeof(TableImage));
}

TEST(TableFile, FlippedBitsOfTheHeaderAreNamedByTheirField) {
  checkFlips(0, 4, damaged("not a table image"));
  checkFlips(4, 8, fmt::format("5: {}: a table image of format ", path_));
  checkFlips(8, 12, damaged("24568 bytes, and "));
  checkFlips(12, 16, damaged("damaged, its CRC-32 does not match"));
}

TEST(TableFile, EveryFlippedBitOfParametersAndConstantsIsFound) {
  checkFlips(kTableHeaderBytes, offsetof(TableImage, gains), damaged("damaged, its CRC-32"));
}

// Every 307th bit here; TableImageTest and Crc32Test have them all.
TEST(TableFile, FlippedBitsOfThePatchesAreFound) {
  checkFlips(offsetof(TableImage, gains), sizeof(TableImage), damaged("damaged, its CRC-32"), 307);
}

TEST(TableFile, AFileCutAnywhereIsRefused) {
  for (std::size_t length = 0; length < kTableHeaderBytes; ++length)
    checkVerdict(bytes_.substr(0, length),
                 damaged(fmt::format("{} bytes, too short for a table image", length)));
  for (std::size_t length = kTableHeaderBytes; length < bytes_.size();
       length += length < 200 || length > bytes_.size() - 100 ? 1u : 113u)
    checkVerdict(bytes_.substr(0, length),
                 damaged(fmt::format("{} bytes, and 24568 by its header, where an image has 24568", length)));
}

TEST(TableFile, ALongerFileIsRefused) {
  checkVerdict(bytes_ + '\0', damaged("24569 bytes, and 24568 by its header"));
  checkVerdict(bytes_ + bytes_, damaged("49136 bytes, and 24568 by its header"));
}

TEST(TableFile, SomethingElseIsNoTableImage) {
  checkVerdict("schema = 1\n[finger]\n", damaged("not a table image"));
  checkVerdict(std::string(sizeof(TableImage), '\0'), damaged("not a table image"));
}

TEST(TableFile, OnlyOverTableImagesIsAnotherAdvised) {
  const std::string advice = fmt::format("make it anew with: strainfinger tables [-c CONFIG] -o {}", path_);
  write(bytes_.substr(0, 1000));
  STRCMP_CONTAINS(advice.c_str(), verdictOn(path_).c_str());
  for (const std::string& other : {std::string("root:x:0:0:root:/root:/bin/bash\n"), bytes_.substr(0, 3)}) {
    write(other);
    CHECK(verdictOn(path_).find(" -o ") == std::string::npos);
  }
}

TEST(TableFile, AnotherFormatIsAMismatchWhateverFollows) {
  std::string other = bytes_.substr(0, 100);
  other[4] = 1;
  checkVerdict(other,
               fmt::format("5: {}: a table image of format 1, this program and its firmware read format {}; "
                           "make it anew",
                           path_, kTableFormat));
}

TEST(TableFile, ConstantsOutOfTheirDomainAreRefusedUnderARightChecksum) {
  image_->constants.node_count = 0;
  image_->crc32 = crc32(checkedBytes(*image_));
  checkVerdict(imageBytes(*image_), damaged("its constants are none that the firmware can work with"));
}

TEST(TableFile, WhatCannotBeReadIsNamedWithTheReason) {
  STRCMP_EQUAL("1: /nowhere/finger.bin: cannot read the file: No such file or directory",
               verdictOn("/nowhere/finger.bin").c_str());
  STRCMP_EQUAL("1: /: cannot read the file: Is a directory", verdictOn("/").c_str());
}
