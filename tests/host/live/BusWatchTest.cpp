#include "host/live/bus_watch.hpp"

#include <chrono>

#include "tests/host/can/fake_bus_port.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::live;
using namespace std::chrono_literals;

TEST_GROUP(BusWatch) {
  can::FakeBusPort port_;
  BusWatch watch_{port_, config::FingerConfig{}};
};

TEST(BusWatch, ShowsWhatItHears) {
  port_.hear(HeartbeatFrame{.state = FingerState::kZeroing});
  watch_.listen(1ms);
  const BusView view = watch_.view();
  STRCMP_EQUAL("fake0", view.name.c_str());
  LONGS_EQUAL(3, view.missed);
  CHECK_TRUE(view.fingers.at(0).heartbeat.state == FingerState::kZeroing);
  CHECK_TRUE(view.fingers.at(0).silence_us < 10'000'000);
}

TEST(BusWatch, AFingerThatFallsSilentIsSilentThoughTheClockWasSetBack) {
  port_.hear(HeartbeatFrame{});
  port_.toHear.back().time_ns += 60'000'000'000;  // set back by as much since
  watch_.listen(1ms);
  const BusView before = watch_.view();
  CHECK_FALSE(before.fingers.at(0).isSilent());
  watch_.listen(550ms);
  const BusView after = watch_.view();
  CHECK_TRUE(after.fingers.at(0).isSilent());
  CHECK_TRUE(after.time_us >= before.time_us + 550'000);
}

TEST(BusWatch, FramesOfOtherFormatsAreOfTheBus) {
  const auto sinceEpoch = std::chrono::system_clock::now().time_since_epoch();
  for (int i = 0; i < 5; ++i)
    port_.othersToHear.push_back({.time_ns = std::chrono::nanoseconds(sinceEpoch).count(), .frame = {}});
  watch_.listen(150ms);
  LONGS_EQUAL(5, watch_.view().framesPerSecond);
}

TEST(BusWatch, ListensForSoLongThoughNothingComes) {
  const auto begin = std::chrono::steady_clock::now();
  watch_.listen(30ms);
  CHECK_TRUE(std::chrono::steady_clock::now() - begin >= 30ms);
}

TEST(BusWatch, ARequestIsSentOnceAndItsResponseIsItsOutcome) {
  watch_.request(1, tareRequest(false));
  watch_.listen(2ms);
  watch_.listen(2ms);
  LONGS_EQUAL(1, port_.sent.size());
  CHECK_TRUE(port_.sent[0] == encode(tareRequest(false), 1));
  CHECK_TRUE(watch_.outcomes().empty());
  port_.hear(responseTo(Command::kTare, CommandStatus::kDone));
  watch_.listen(1ms);
  STRCMP_EQUAL("node 1: tare: Done", watch_.outcomes().at(0).text.c_str());
  CHECK_TRUE(watch_.outcomes().empty());
}

TEST(BusWatch, ARequestThatTheBusRefusesIsTriedAgain) {
  port_.takes = false;
  watch_.request(1, tareRequest(false));
  watch_.listen(1ms);
  port_.takes = true;
  watch_.listen(1ms);
  LONGS_EQUAL(1, port_.sent.size());
}

TEST(BusWatch, ANodeHasOneRequestAtATime) {
  watch_.request(1, tareRequest(false));
  watch_.request(1, tareRequest(false));
  watch_.request(2, tareRequest(false));
  watch_.listen(1ms);
  LONGS_EQUAL(2, port_.sent.size());
}

TEST(BusWatch, WithoutAnAnswerThereIsAnOutcomeAfterASecond) {
  watch_.request(1, tareRequest(false));
  watch_.listen(900ms);
  CHECK_TRUE(watch_.outcomes().empty());
  watch_.listen(150ms);
  watch_.listen(1ms);
  STRCMP_CONTAINS("no answer", watch_.outcomes().at(0).text.c_str());
}

TEST(BusWatch, NothingIsAskedOfANumberThatTwoFingersHave) {
  for (const std::uint16_t uptime_s : std::initializer_list<std::uint16_t>{100, 7, 101, 8, 102, 9, 103, 10})
    port_.hear(HeartbeatFrame{.uptime_s = uptime_s});
  watch_.listen(1ms);
  watch_.request(1, tareRequest(false));
  watch_.request(2, tareRequest(false));
  watch_.listen(1ms);
  LONGS_EQUAL(1, port_.sent.size());
  CHECK_TRUE(port_.sent[0] == encode(tareRequest(false), 2));
  const auto outcomes = watch_.outcomes();
  LONGS_EQUAL(1, outcomes.size());
  CHECK_FALSE(outcomes[0].isDone);
  STRCMP_CONTAINS("node 1: tare: not sent: two fingers have this node number", outcomes[0].text.c_str());
  STRCMP_CONTAINS("config --can fake0 -n 1 --set-node", outcomes[0].text.c_str());
}

TEST(BusWatch, ATapGetsEveryFrameUntilItIsTakenOff) {
  int frames = 0;
  int others = 0;
  watch_.setTap([&](const can::TimedFrame&) { ++frames; }, [&](const can::OtherFrame&) { ++others; });
  port_.hear(HeartbeatFrame{}), port_.hear(InfoFrame{});
  port_.othersToHear.resize(1);
  watch_.listen(1ms);
  watch_.setTap({}, {});
  port_.hear(HeartbeatFrame{});
  port_.othersToHear.resize(1);
  watch_.listen(1ms);
  LONGS_EQUAL(2, frames);
  LONGS_EQUAL(1, others);
}
