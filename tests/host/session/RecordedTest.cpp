#include "host/session/recorded.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <fstream>

#include "common/frames.hpp"
#include "host/base/failure.hpp"
#include "host/can/candump_text.hpp"
#include "host/can/log_reader.hpp"
#include "tests/host/session/hands.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::session;

TEST_GROUP(Recorded) {
  const std::string path_ = fmt::format("{}/recorded_test.{}", P_tmpdir, getpid());
  config::FingerConfig config;
  Hand hand{config};
  std::string interface_ = "can0";

  void teardown() override { std::remove(path_.c_str()); }
  void write(const std::string& text) { std::ofstream(path_) << text; }

  /// The pages of a set as BUS_RAW.md has them: 32768 is the middle, 2^15 codes are 0.03.
  std::string pages(std::int64_t time_us, int sample, RawKind kind, const Eigen::VectorXd& strains) const {
    std::string text;
    for (int page = 0; page < 6; ++page) {
      RawFrame frame{static_cast<std::uint8_t>(page), kind, static_cast<std::uint8_t>(sample)};
      const auto code = [&](int i) {
        const int gauge = 3 * page + i;
        return static_cast<std::uint16_t>(gauge < 16 ? 32768 + std::lround(strains[gauge] / 0.03 * 32768)
                                                     : 0);
      };
      frame.code_0 = code(0), frame.code_1 = code(1), frame.code_2 = code(2);
      text += can::formatLogLine(time_us, interface_, encode(frame, 1)) + "\n";
    }
    return text;
  }
  static std::string warningOf(const Recorded& recorded) {
    CHECK_COMPARE(recorded.warnings.size(), <=, 1);
    return recorded.warnings.empty() ? "" : recorded.warnings.front();
  }
  std::string stroke() {
    const Eigen::VectorXd zero = Eigen::VectorXd::Constant(16, 1e-3);
    std::string text = pages(1'000'000, 0, RawKind::kZeros, zero);
    for (int i = 0; i < 100; ++i)
      text += pages(1'000'000 + 10'000 * i, i, RawKind::kReadings, zero + hand.touch(0.72 * i, 20));
    return text;
  }
};

TEST(Recorded, TouchesThatDifferAreRowsLessTheZero) {
  write(stroke());
  CHECK_TRUE(isRecording(path_));
  const auto recorded = readRecording(path_, config, 1);
  LONGS_EQUAL(100, recorded.sets);
  CHECK_COMPARE(recorded.rows.size(), >=, 18);
  CHECK_COMPARE(recorded.rows.size(), <=, 25);
  const Eigen::VectorXd& first = recorded.rows.strains.front();
  Eigen::Index largest = 0;
  first.cwiseAbs().maxCoeff(&largest);
  LONGS_EQUAL(0, largest);
}

TEST(Recorded, OfTwoFingersOfOneNumberOneIsChosen) {
  const std::string first = stroke();
  interface_ = "can1";
  write(first + stroke());
  try {
    readRecording(path_, config, 1);
    FAIL("accepted");
  } catch (const Failure& failure) {
    LONGS_EQUAL(static_cast<int>(ExitCode::kUsage), static_cast<int>(failure.code()));
    STRCMP_CONTAINS(": there is a node 1 on can0 and one on can1: choose with --interface", failure.what());
  }
  LONGS_EQUAL(100, readRecording(path_, config, 1, "can1").sets);
}

TEST(Recorded, WithoutReadingsOfTheNodeItIsRefused) {
  write(stroke());
  try {
    readRecording(path_, config, 2);
    FAIL("accepted");
  } catch (const Failure& failure) {
    STRCMP_CONTAINS("no readings (RAW) of node 2 with 16 gauges", failure.what());
  }
}

// As a logger leaves it that is killed.
TEST(Recorded, ALineThatIsCutOffAtTheEndIsLeftOut) {
  write(stroke() + "(1.990000) can0 401#0000");
  STRCMP_CONTAINS(":607: the log breaks off in this line",
                  warningOf(readRecording(path_, config, 1)).c_str());
  write(stroke() + "(1.990000) can0 123#00");
  STRCMP_EQUAL("", warningOf(readRecording(path_, config, 1)).c_str());
  write(stroke() + "(1.990000) can");
  const auto recorded = readRecording(path_, config, 1);
  LONGS_EQUAL(100, recorded.sets);
  STRCMP_CONTAINS(":607: the log breaks off in this line", warningOf(recorded).c_str());
  write(stroke() + "(1.990000) can\n");
  CHECK_THROWS(Failure, readRecording(path_, config, 1));
}

// As of a computer that sets its clock when it finds the network, or of two logs that were joined.
TEST(Recorded, TimesThatGoBackAreTold) {
  const std::string later = pages(500'000, 100, RawKind::kReadings, hand.touch(30, 20));
  write(stroke() + later + pages(100'000, 101, RawKind::kReadings, hand.touch(30, 20)));
  STRCMP_CONTAINS(":607: the times go back by 1.49 s here",
                  warningOf(readRecording(path_, config, 1)).c_str());
  write(stroke() + pages(995'000, 100, RawKind::kReadings, hand.touch(30, 20)));
  STRCMP_EQUAL("", warningOf(readRecording(path_, config, 1)).c_str());
}

// candump -td: each time is what has passed since the frame before.
TEST(Recorded, TimesThatAreDifferencesAreTold) {
  std::string log;
  for (int i = 0; i < 100; ++i)
    log += fmt::format(" (00{}.000{})  can0  123   [1]  00\n", 0, i % 3 == 0 ? "900" : "100");
  write(log);
  can::LogReader reader(path_);
  while (reader.next()) {}
  LONGS_EQUAL(1, reader.warnings().size());
  STRCMP_CONTAINS("33 of 100 frames have an earlier time than the one before: they are differences",
                  reader.warnings().front().c_str());
}

// Two interfaces whose clocks differ, as candump logs them.
TEST(Recorded, TimesOfAnotherInterfaceMayBeOthers) {
  std::string log;
  for (int i = 0; i < 100; ++i)
    log += fmt::format("(1.{:06}) can{} 123#00\n", 1000 * i + 400'000 * (i % 2), i % 2);
  write(log);
  can::LogReader reader(path_);
  while (reader.next()) {}
  LONGS_EQUAL(0, reader.warnings().size());
}

TEST(Recorded, AnInterfaceThatIsNotInTheLogIsNamed) {
  write(stroke());
  try {
    readRecording(path_, config, 1, "can7");
    FAIL("accepted");
  } catch (const Failure& failure) {
    STRCMP_CONTAINS(": no frame of can7 in it", failure.what());
  }
}

TEST(Recorded, WithoutATouchItIsRefused) {
  std::string text;
  for (int i = 0; i < 20; ++i) text += pages(1'000'000 + 10'000 * i, i, RawKind::kReadings, hand.nothing());
  write(pages(1'000'000, 0, RawKind::kZeros, Eigen::VectorXd::Zero(16)) + text);
  try {
    readRecording(path_, config, 1);
    FAIL("accepted");
  } catch (const Failure& failure) {
    STRCMP_CONTAINS(": none of its 20 sample sets is a touch", failure.what());
  }
}

TEST(Recorded, RowsOfStrainsAreNoRecording) {
  write("time_s,strain_0\n1,2\n");
  CHECK_FALSE(isRecording(path_));
  write("# a comment\n\n0.1,0.2\n");
  CHECK_FALSE(isRecording(path_));
  write("\n  can0  185   [8]  E8 03 22 01 80 81 61 A3\n");
  CHECK_TRUE(isRecording(path_));
}
