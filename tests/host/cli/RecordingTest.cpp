#include "host/cli/recording.hpp"

#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <sstream>

#include "common/frame_layout.hpp"
#include "host/base/failure.hpp"
#include "tests/host/can/fake_bus_port.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::cli;

TEST_GROUP(Recording) {
  can::FakeBusPort port_;
  const config::FingerConfig config_;
  const std::string name_ = "recording_test_" + std::to_string(getpid());
  const std::string log_ = name_ + ".log", notes_ = name_ + ".toml";

  void teardown() override {
    std::remove(log_.c_str());
    std::remove(notes_.c_str());
  }
  static std::string textOf(const std::string& path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
  }
  static can::TimedFrame heard(const CanFrame& frame) { return {1'609'779'922'655'421'000, frame}; }
  void checkRefused(const std::string& path, ExitCode code, const char* message) {
    try {
      Recording recording(port_, config_, path);
    } catch (const Failure& failure) {
      LONGS_EQUAL(static_cast<int>(code), static_cast<int>(failure.code()));
      STRCMP_CONTAINS(message, failure.what());
      return;
    }
    FAIL("not refused");
  }
};

TEST(Recording, WritesWhatIsHeardAndNotesBesideIt) {
  Recording recording(port_, config_, log_);
  recording.take(heard({0x705, 8, {0x22, 0, 0, 0x4D, 0x0E, 0x19, 0, 0xA7}}));
  recording.take(heard({0x100, 1, {1}}));
  recording.end();
  LONGS_EQUAL(2, recording.progress().frames);
  STRCMP_EQUAL(
      "(1609779922.655421) fake0 705#2200004D0E1900A7\n"
      "(1609779922.655421) fake0 100#01\n",
      textOf(log_).c_str());
  for (const char* text : {"\n[recording]\n", "bus = \"fake0\"\n", "\nend = 2", "\nframes = 2\n",
                           "\n[[recording.finger]]\nnode = 5\n"})
    STRCMP_CONTAINS(text, textOf(notes_).c_str());
}

TEST(Recording, HasFramesOfOtherFormatsToo) {
  Recording recording(port_, config_, log_);
  recording.take(can::OtherFrame{1'609'779'922'655'421'000, true, {.id = 0x123, .length = 4}});
  recording.end();
  LONGS_EQUAL(1, recording.progress().frames);
  STRCMP_EQUAL("(1609779922.655421) fake0 123#R4\n", textOf(log_).c_str());
}

TEST(Recording, KnowsWhoHasOtherTables) {
  Recording recording(port_, config_, log_);
  const auto say = [&](std::uint8_t node, const HeartbeatFrame& heartbeat) {
    recording.take(heard(encode(heartbeat, node)));
  };
  say(1, {.table_crc = 0x42});
  say(2, {.table_crc = 0x43});
  say(3, {.faults = {FingerFault::kTables}, .table_crc = 0x43});
  say(4, {.protocol = kProtocolVersion + 1, .table_crc = 0x43});
  say(5, {.table_crc = 0x43});
  say(5, {.table_crc = 0x42});  // it got the right ones meanwhile
  const auto others = recording.nodesOfOtherTables(0x01020342U);
  LONGS_EQUAL(1, others.size());
  LONGS_EQUAL(2, others.front());
}

TEST(Recording, ThatIsCutOffHasNotesWithoutAnEnd) {
  {
    Recording recording(port_, config_, log_);
    recording.take(heard({0x705, 8, {0x22, 0, 0, 0x4D, 0x0E, 0x19, 0, 0xA7}}));
    recording.flush();
  }
  STRCMP_CONTAINS("\nnode = 5\n", textOf(notes_).c_str());
  CHECK_TRUE(textOf(notes_).find("\nend = ") == std::string::npos);
}

TEST(Recording, CountsWhatWasMissedWhileItWent) {
  port_.missed = 3;
  Recording recording(port_, config_, log_);
  port_.missed = 5;
  recording.end();
  LONGS_EQUAL(2, recording.progress().missed);
}

TEST(Recording, NotesWhenTheBusWasAway) {
  Recording recording(port_, config_, log_);
  CHECK_FALSE(recording.lookAtBus());
  recording.flush();
  STRCMP_CONTAINS("\ngaps = 0\n", textOf(notes_).c_str());
  port_.busState = hal::CanState::kDown, ++port_.timesAway;
  CHECK_TRUE(recording.lookAtBus());
  CHECK_FALSE(recording.isBusThere() || recording.lookAtBus());
  recording.flush();
  STRCMP_CONTAINS("\n\n[[recording.gap]]\nstart = 2", textOf(notes_).c_str());
  CHECK_TRUE(textOf(notes_).find("\nend = 2") == std::string::npos);
  port_.busState = hal::CanState::kActive;
  CHECK_TRUE(recording.lookAtBus() && recording.isBusThere());
  recording.flush();
  STRCMP_CONTAINS("Z\nend = 2", textOf(notes_).c_str());
  LONGS_EQUAL(1, recording.progress().gaps);
}

TEST(Recording, ABusThatWasAwayBetweenTwoLooksWasAway) {
  Recording recording(port_, config_, log_);
  ++port_.timesAway;
  CHECK_TRUE(recording.lookAtBus());
  CHECK_TRUE(recording.isBusThere());
  CHECK_FALSE(recording.lookAtBus());
  LONGS_EQUAL(1, recording.progress().gaps);
  CHECK_TRUE(recording.progress().firstGaps.at(0).end_ns != 0);
}

TEST(Recording, ABusThatComesAndGoesMakesNoLongNotes) {
  Recording recording(port_, config_, log_);
  for (int i = 0; i < 2001; ++i) {
    port_.busState = i % 2 == 0 ? hal::CanState::kBusOff : hal::CanState::kActive;
    recording.lookAtBus();
  }
  recording.end();
  STRCMP_CONTAINS("\ngaps = 1001\n", textOf(notes_).c_str());
  CHECK_TRUE(textOf(notes_).size() < 20'000);
}

TEST(Recording, WithoutItsNotesNoLogIsLeftToBeInTheWay) {
  const std::string longest(250, 'x');  // with .toml the longest name that there can be, and none beside it
  checkRefused(longest, ExitCode::kFailure, "File name too long");
  CHECK_TRUE(std::remove(longest.c_str()) != 0);
}

TEST(Recording, FilesThatAreThereAreLeftAlone) {
  std::ofstream(log_) << "mine";
  checkRefused(log_, ExitCode::kFailure, "File exists");
  STRCMP_EQUAL("mine", textOf(log_).c_str());
}

TEST(Recording, AConfigIsNotReplacedByItsNotes) {
  std::ofstream(notes_) << "mine";
  checkRefused(log_, ExitCode::kFailure, ": there is such a file already, where the notes of ");
  STRCMP_EQUAL("mine", textOf(notes_).c_str());
  CHECK_FALSE(std::ifstream(log_).good());
}

TEST(Recording, ALogIsNotNamedLikeItsNotes) { checkRefused(notes_, ExitCode::kUsage, "cannot end in .toml"); }
