// A finger on a bus that takes its frames or not; FingerTest.cpp has what it says on a free one.
#include <algorithm>
#include <cstdio>
#include <optional>
#include <random>
#include <vector>

#include "firmware/app/finger.hpp"
#include "host/simulation/converter.hpp"
#include "tests/doubles/fake_clock.hpp"
#include "tests/doubles/fake_gauge_adc.hpp"
#include "tests/doubles/spy_watchdog.hpp"
#include "tests/firmware/core/model_ring.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::firmware;
using namespace strainfinger::doubles;

namespace {

/// Takes a frame or not, as the test's odds are, and notes when.
class MoodyCanPort {
 public:
  struct Sent {
    CanFrame frame;
    std::uint32_t at_us;
  };
  MoodyCanPort(const FakeClock& clock, std::uint32_t seed) : clock_(clock), random_(seed) {}

  double refuses = 0;  ///< part of the frames
  std::vector<Sent> sent;

  bool send(const CanFrame& frame) noexcept {
    if (std::uniform_real_distribution<>(0, 1)(random_) < refuses) return false;
    sent.push_back({frame, clock_.now_us()});
    return true;
  }
  std::optional<CanFrame> receive() noexcept { return std::nullopt; }
  hal::CanStatus status() const noexcept { return {.state = hal::CanState::kActive}; }

 private:
  const FakeClock& clock_;
  std::mt19937 random_;
};
static_assert(hal::CanPort<MoodyCanPort>);

}  // namespace

TEST_GROUP(FingerOnAMoodyBus) {
  static constexpr std::uint8_t kNode = 5;
  static constexpr std::uint32_t kSample_us = 1000;
  using Fingers = Finger<FakeGaugeAdc, MoodyCanPort, FakeClock, SpyWatchdog>;
  const ModelRing ring{ModelRing::asDrawn()};
  const simulation::Converter converter{config::Gauges{}};
  FakeGaugeAdc adc;
  FakeClock clock;
  SpyWatchdog watchdog;
  MoodyCanPort can{clock, 51};
  Fingers finger{ring.tables(), {.node = kNode}, adc, can, clock, watchdog};

  void step(const Press& press) {
    hal::SampleSet set{};
    const auto strains = ring.strains(press);
    std::transform(strains.begin(), strains.end(), set.begin(),
                   [&](double strain) { return converter.codeOf(strain); });
    clock.advance(kSample_us);
    adc.convert(set);
    finger.step();
  }

  /// A CONTACT that just went out has the values of the last sample set.
  void checkFresh(std::size_t sentBefore) {
    for (std::size_t i = sentBefore; i < can.sent.size(); ++i) {
      const auto contact = decode<ContactFrame>(can.sent[i].frame);
      if (!contact || !contact->flags.has(FingerFlag::kContact)) continue;
      Contact now;
      now.angle = TurnQ32::fromRaw(finger.lastAnswer().solution.contact[0].angle_q32);
      LONGS_EQUAL(touchFrames(ring.constants(), now, {}, {}, 0).contact.angle_cdeg, contact->angle_cdeg);
    }
  }

  /// Every CONTACT has its FORCE and its PATCH before the next one, within 50 ms, or is counted; returns how
  /// many.
  std::uint32_t checkTouches() {
    std::uint32_t contacts = 0, whole = 0;
    std::uint32_t contactAt_us = 0;
    std::optional<ContactFrame> open;
    bool hasForce = false;
    for (const auto& [frame, at_us] : can.sent) {
      if (const auto contact = decode<ContactFrame>(frame)) {
        LONGS_EQUAL(contacts % 256, contact->sequence);
        ++contacts;
        open = contact;
        hasForce = false;
        contactAt_us = at_us;
      } else if (const auto force = decode<ForceFrame>(frame)) {
        CHECK_TRUE(open.has_value());
        LONGS_EQUAL(open->sequence, force->sequence);
        CHECK(open->flags == force->flags);
        CHECK(at_us - contactAt_us < 50'000);
        hasForce = true;
      } else if (const auto patch = decode<PatchFrame>(frame)) {
        CHECK_TRUE(open.has_value() && hasForce);
        LONGS_EQUAL(open->sequence, patch->sequence);
        CHECK(open->flags == patch->flags);
        CHECK(at_us - contactAt_us < 50'000);
        open.reset();
        ++whole;
      }
    }
    const std::uint32_t owed = contacts - whole - finger.counters().touchesIncomplete;
    CHECK(owed <= 1);
    LONGS_EQUAL(whole, finger.counters().touchesSent);
    return contacts;
  }

  /// Touches that come, move and go, on a bus that refuses so much.
  void runFor(int samples, double refuses) {
    can.refuses = refuses;
    for (int i = 0; i < samples; ++i) {
      const std::size_t before = can.sent.size();
      const bool touched = i % 400 < 300;
      step({i / 100.0, touched ? 20.0 : 0.0, touched ? 5.0 : 0.0});
      checkFresh(before);
    }
  }
  void zeroed() {
    std::printf("seed 51 ");
    for (int i = 0; i < ZeroAverage::kSamples; ++i) step({0, 0, 0});
  }
};

TEST(FingerOnAMoodyBus, EveryContactHasItsOtherFramesOrIsCounted) {
  zeroed();
  for (const double refuses : {0.0, 0.1, 0.5, 0.9, 0.99, 0.3}) runFor(3000, refuses);
  CHECK(checkTouches() > 1000);
  CHECK(finger.counters().touchesIncomplete > 0);
  CHECK(finger.counters().touchesBusy > 0);
}

TEST(FingerOnAMoodyBus, OldFramesAreDroppedEvenWhenThePortIsFree) {
  zeroed();
  while (checkTouches() == finger.counters().touchesSent) runFor(1, 0.5);  // until frames are owed
  clock.advance(10'000'000);                                               // the converter pauses
  runFor(50, 0);
  checkTouches();
  LONGS_EQUAL(1, finger.counters().touchesIncomplete);
}

TEST(FingerOnAMoodyBus, OwedFramesDoNotWaitForTheNextSampleSet) {
  zeroed();
  while (checkTouches() == finger.counters().touchesSent) runFor(1, 0.5);
  const std::uint32_t whole = finger.counters().touchesSent;
  can.refuses = 0;
  clock.advance(100);
  CHECK_FALSE(finger.step());
  LONGS_EQUAL(whole + 1, finger.counters().touchesSent);
}

TEST(FingerOnAMoodyBus, AnEndOfATouchWhoseForceWasDroppedIsSaidAgain) {
  zeroed();
  for (int i = 0; i < 40; ++i) {
    can.refuses = 0;
    for (int set = 0; set < 30; ++set) step({3.2, 20, 4});
    const std::uint32_t dropped = finger.counters().touchesIncomplete;
    can.refuses = 0.5;  // until CONTACT goes out and FORCE does not
    for (int set = 0; set < 5; ++set) step({0, 0, 0});
    can.refuses = 1;
    for (int set = 0; set < 80; ++set) step({0, 0, 0});
    can.refuses = 0;
    const std::size_t before = can.sent.size();
    for (int set = 0; set < 80; ++set) step({0, 0, 0});
    if (finger.counters().touchesIncomplete == dropped) continue;
    const auto isReleased = [](const MoodyCanPort::Sent& sent) {
      const auto force = decode<ForceFrame>(sent.frame);
      return force && force->normal_mN == 0 && !force->flags.has(FingerFlag::kContact);
    };
    CHECK_TRUE(
        std::any_of(can.sent.begin() + static_cast<std::ptrdiff_t>(before), can.sent.end(), isReleased));
    return;
  }
  FAIL("no FORCE was dropped");
}

TEST(FingerOnAMoodyBus, IncompleteTouchesAreAFaultOfTheBus) {
  zeroed();
  while (finger.counters().touchesIncomplete == 0) runFor(1, 0.97);
  can.sent.clear();
  for (int i = 0; i < 200; ++i) {
    can.refuses = 0;
    step({0, 0, 0});
  }
  bool said = false;
  for (const auto& [frame, at_us] : can.sent)
    if (const auto beat = decode<HeartbeatFrame>(frame)) said = beat->faults.has(FingerFault::kCan);
  CHECK_TRUE(said);
}
