#include "host/live/recording.hpp"

#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <fstream>
#include <sstream>

#include "host/base/failure.hpp"
#include "tests/host/live/fake_bus_port.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::live;
using namespace std::chrono_literals;

TEST_GROUP(Recording) {
  FakeBusPort port_;
  BusWatch watch_{port_, config::FingerConfig{}};
  const std::string path_ = "recording_test_" + std::to_string(getpid()) + ".log";

  void teardown() override { std::remove(path_.c_str()); }
  std::string log() const {
    std::ostringstream text;
    text << std::ifstream(path_).rdbuf();
    return text.str();
  }
};

TEST(Recording, WritesWhatIsHeardWhileItLives) {
  port_.toHear.push_back({1'609'779'922'655'421'000, {0x100, 1, {1}}});
  watch_.listen(1ms);
  {
    Recording recording(watch_, "can0", path_);
    port_.toHear.push_back({1'609'779'922'655'421'000, {0x705, 2, {0x22, 0x00}}});
    watch_.listen(1ms);
    recording.flush();
    LONGS_EQUAL(1, recording.frames());
  }
  port_.toHear.push_back({1'609'779'922'655'421'000, {0x101, 1, {1}}});
  watch_.listen(1ms);
  STRCMP_EQUAL("(1609779922.655421) can0 705#2200\n", log().c_str());
}

TEST(Recording, AFileThatIsThereIsLeftAlone) {
  std::ofstream(path_) << "mine";
  bool refused = false;
  try {
    Recording recording(watch_, "can0", path_);
  } catch (const Failure&) {
    refused = true;
  }
  CHECK_TRUE(refused);
  STRCMP_EQUAL("mine", log().c_str());
  port_.hear(HeartbeatFrame{});
  watch_.listen(1ms);  // nobody listens any more
}
