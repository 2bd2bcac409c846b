#include "host/tables/table_file.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <fstream>
#include <memory>
#include <string>

#include "host/base/failure.hpp"
#include "host/config/keys.hpp"
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

TEST(TableFile, ParametersAreNamedAndWrittenAsInTheConfig) {
  const auto parameters = parametersOf(image_->parameters);
  LONGS_EQUAL(20, parameters.size());
  for (const Parameter& parameter : parameters) {
    bool known = false;
    for (const config::Key& key : config::keys()) known = known || key.dotted() == parameter.key;
    CHECK_TEXT(known, parameter.key.c_str());
  }
  CHECK(parameters[5].value == Cell(std::int64_t{16}));
  CHECK(parameters[7].value == Cell(std::string("radial")));
  STRCMP_EQUAL("contact.width_m", parameters[18].key.c_str());
  CHECK_FALSE(parameters[18].value.has_value());  // not known
}

namespace {

/// A change of each key that tables depend on, and what is said of it.
struct Change {
  void (*apply)(config::FingerConfig&);
  const char* words;
};

const Change kChanges[] = {
    {[](config::FingerConfig& c) { c.finger.core_radius_m = 8.8e-3; },
     "finger.core_radius_m is 0.0089, the config has 0.0088"},
    {[](config::FingerConfig& c) { c.finger.outer_radius_m = 0.013; },
     "finger.outer_radius_m is 0.0127, the config has 0.013"},
    {[](config::FingerConfig& c) { c.finger.length_m = 0.03; },
     "finger.length_m is 0.02, the config has 0.03"},
    {[](config::FingerConfig& c) { c.finger.shear_modulus_pa = 9e4; },
     "finger.shear_modulus_pa is 83000, the config has 90000"},
    {[](config::FingerConfig& c) { c.finger.poisson_ratio = 0.49; },
     "finger.poisson_ratio is 0.5, the config has 0.49"},
    {[](config::FingerConfig& c) { c.gauges.count = 18; }, "gauges.count is 16, the config has 18"},
    {[](config::FingerConfig& c) { c.gauges.radius_m = 9.3e-3; },
     "gauges.radius_m is 0.0094, the config has 0.0093"},
    {[](config::FingerConfig& c) { c.gauges.component = StrainComponent::kShear; },
     "gauges.component is radial, the config has shear"},
    {[](config::FingerConfig& c) { c.gauges.first_angle_deg = 5; },
     "gauges.first_angle_deg is 0, the config has 5"},
    {[](config::FingerConfig& c) { c.gauges.arc_length_m = 1e-3; },
     "gauges.arc_length_m is 0, the config has 0.001"},
    {[](config::FingerConfig& c) { c.gauges.noise_strain = 7e-6; },
     "gauges.noise_strain is 6e-06, the config has 7e-06"},
    {[](config::FingerConfig& c) { c.gauges.full_scale_strain = 0.04; },
     "gauges.full_scale_strain is 0.03, the config has 0.04"},
    {[](config::FingerConfig& c) { c.gauges.adc_bits = 14; }, "gauges.adc_bits is 12, the config has 14"},
    {[](config::FingerConfig& c) { c.contact.friction_coefficient = 0.5; },
     "contact.friction_coefficient is 1, the config has 0.5"},
    {[](config::FingerConfig& c) { c.gauges.model_error = 0.02; },
     "gauges.model_error is 0.05, the config has 0.02"},
    {[](config::FingerConfig& c) { c.calibration.place_error_m = 2.5e-5; },
     "calibration.place_error_m is 0, the config has 2.5e-05"},
    {[](config::FingerConfig& c) { c.calibration.load_error = 0.006; },
     "calibration.load_error is 0, the config has 0.006"},
    {[](config::FingerConfig& c) { c.calibration.moment_error_m2 = 2e-8; },
     "calibration.moment_error_m2 is 0, the config has 2e-08"},
    {[](config::FingerConfig& c) { c.contact.width_m = 1e-3; },
     "contact.width_m is unknown, the config has 0.001"},
    {[](config::FingerConfig& c) { c.contact.largest_width_m = 6e-3; },
     "contact.largest_width_m is 0.008, the config has 0.006"},
};

std::string mismatch(const TableImage& image, const config::FingerConfig& config) {
  try {
    requireTablesOf(image, config, "f.bin");
    return "belongs";
  } catch (const Failure& failure) {
    return fmt::format("{}: {}", static_cast<int>(failure.code()), failure.what());
  }
}

}  // namespace

TEST(TableFile, EveryParameterThatDiffersIsNamed) {
  LONGS_EQUAL(parametersOf(image_->parameters).size(), std::size(kChanges));
  for (const Change& change : kChanges) {
    config::FingerConfig other;
    change.apply(other);
    STRCMP_EQUAL(fmt::format("5: f.bin: made for another finger than the config's:\n  {}\nmake it anew with: "
                             "strainfinger tables -c CONFIG -o f.bin",
                             change.words)
                     .c_str(),
                 mismatch(*image_, other).c_str());
  }
}

TEST(TableFile, AllDifferencesAreNamedAtOnce) {
  config::FingerConfig other;
  for (const Change& change : kChanges) change.apply(other);
  for (const Change& change : kChanges) STRCMP_CONTAINS(change.words, mismatch(*image_, other).c_str());
}

TEST(TableFile, GaugesThatWereFoundElsewhereAreNamed) {
  config::FingerConfig other;
  other.calibration.angle_offset_deg.assign(16, 0);
  STRCMP_EQUAL("belongs", mismatch(*image_, other).c_str());
  other.calibration.angle_offset_deg[1] = 0.25;
  STRCMP_CONTAINS("gauges.angle_deg is [0, 22.5, 45, ", mismatch(*image_, other).c_str());
  STRCMP_CONTAINS("the config has [0, 22.75, 45, ", mismatch(*image_, other).c_str());
}

TEST(TableFile, KeysThatTablesDontDependOnMayDiffer) {
  config::FingerConfig other;
  other.can = {5, 500000, 100};
  STRCMP_EQUAL("belongs", mismatch(*image_, other).c_str());
}

TEST(TableFile, TheHeaderSaysWhatItIsOf) {
  const std::string header = imageHeader(*image_);
  STRCMP_CONTAINS("//   gauges.radius_m = 0.0094\n", header.c_str());
  STRCMP_CONTAINS("//   gauges.component = radial\n", header.c_str());
  STRCMP_CONTAINS("//   contact.width_m = unknown\n", header.c_str());
  STRCMP_CONTAINS("//   gauges.angle_deg = [0, 22.5, ", header.c_str());
  STRCMP_CONTAINS(fmt::format("// CRC-32 0x{:08X}\n", image_->crc32).c_str(), header.c_str());
  STRCMP_CONTAINS("kDefaultTableBytes[24568] = {\n    83, 70, 84, 66, 10, 0,", header.c_str());
}
