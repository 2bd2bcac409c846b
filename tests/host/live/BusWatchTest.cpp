#include "host/live/bus_watch.hpp"

#include <chrono>
#include <deque>
#include <thread>

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::live;
using namespace std::chrono_literals;

namespace {

/// Hears what it is given, and keeps what is sent.
class FakeBusPort final : public can::BusPort {
 public:
  bool send(const CanFrame& frame) noexcept override {
    if (takes) sent.push_back(frame);
    return takes;
  }
  std::optional<can::TimedFrame> receiveTimed() noexcept override {
    if (toHear.empty()) return std::nullopt;
    const can::TimedFrame frame = toHear.front();
    toHear.pop_front();
    return frame;
  }
  hal::CanStatus status() noexcept override { return {.state = hal::CanState::kActive, .missed = 3}; }
  bool waitReadable(std::chrono::milliseconds timeout) noexcept override {
    if (toHear.empty()) std::this_thread::sleep_for(timeout);
    return !toHear.empty();
  }
  int descriptor() const noexcept override { return -1; }
  const std::string& name() const noexcept override { return name_; }

  /// As a finger would say it now.
  template <typename Frame>
  void hear(const Frame& frame, std::uint8_t node = 1) {
    const auto sinceEpoch = std::chrono::system_clock::now().time_since_epoch();
    toHear.push_back({std::chrono::nanoseconds(sinceEpoch).count(), encode(frame, node)});
  }

  bool takes = true;
  std::deque<can::TimedFrame> toHear;
  std::vector<CanFrame> sent;

 private:
  std::string name_ = "fake0";
};

}  // namespace

TEST_GROUP(BusWatch) {
  FakeBusPort port_;
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

TEST(BusWatch, ATapGetsEveryFrameUntilItIsTakenOff) {
  int frames = 0;
  watch_.setTap([&](const can::TimedFrame&) { ++frames; });
  port_.hear(HeartbeatFrame{}), port_.hear(InfoFrame{});
  watch_.listen(1ms);
  watch_.setTap({});
  port_.hear(HeartbeatFrame{});
  watch_.listen(1ms);
  LONGS_EQUAL(2, frames);
}
