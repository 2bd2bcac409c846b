// A simulated finger is recorded, and what it said computed again from its RAW.
#include "host/recompute/recomputer.hpp"

#include <algorithm>
#include <memory>
#include <vector>

#include "common/commands.hpp"
#include "host/base/failure.hpp"
#include "host/can/loopback_port.hpp"
#include "host/simulation/simulated_finger.hpp"
#include "host/tables/table_builder.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using recompute::Recomputer;
using recompute::RecomputeTally;
using simulation::Course;
using simulation::Scenario;
using simulation::TouchCourse;

namespace {

constexpr std::uint8_t kNode = 1;

const TableImage& defaultTables() {
  static const auto image = std::make_unique<TableImage>(tables::buildTableImage(config::FingerConfig{}));
  return *image;
}

Course steady(double value) { return Course({{0, value}}); }
Course from(double first, double last, double duration_s) { return Course({{0, first}, {duration_s, last}}); }

/// A touch that slides and grows, one beside it for a while, and a light one.
Scenario touches() {
  return Scenario({TouchCourse{.start_s = 0.3,
                               .end_s = 1.5,
                               .angle_deg = from(40, 95, 1.2),
                               .normal_n_per_m = from(4, 30, 1.2),
                               .tangential_n_per_m = from(-3, 8, 1.2)},
                   TouchCourse{.start_s = 0.8,
                               .end_s = 1.2,
                               .angle_deg = steady(250),
                               .normal_n_per_m = steady(22),
                               .tangential_n_per_m = steady(0)},
                   TouchCourse{.start_s = 1.8,
                               .end_s = 2.2,
                               .angle_deg = steady(310),
                               .normal_n_per_m = steady(3),
                               .tangential_n_per_m = steady(1)}});
}

struct Recorded {
  std::int64_t time_ns;
  CanFrame frame;
};

/// A finger on a bus, all that it says, and what it is told.
class Recording {
 public:
  explicit Recording(Scenario scenario = touches(), std::uint64_t seed = 3)
      : finger_(config::FingerConfig{}, std::move(scenario), defaultTables(), firmware::FitMode::kRefined,
                seed, port_) {}

  void tell(const RequestFrame& request) { listener_.send(encode(request, kNode)); }
  void run(int milliseconds) {
    for (int i = 0; i < milliseconds; ++i) {
      finger_.pass(1, [](const simulation::Moment&) {});
      while (const auto frame = listener_.receive())
        frames.push_back({static_cast<std::int64_t>(finger_.elapsed_us()) * 1000, *frame});
    }
  }
  /// So long without RAW, then a zero taken within the recording, then so much more.
  void runTared(int milliseconds, int before_ms = 100, bool isForced = false) {
    run(before_ms);
    tell(rawRequest(1000));
    run(10);
    tell(tareRequest(isForced));
    run(milliseconds);
  }

  std::vector<Recorded> frames;

 private:
  can::LoopbackBus bus_;
  can::LoopbackPort port_{bus_};
  can::LoopbackPort listener_{bus_};
  simulation::SimulatedFinger<can::LoopbackPort> finger_;
};

RecomputeTally recomputed(const std::vector<Recorded>& frames) {
  Recomputer recomputer(defaultTables(), {.node = kNode});
  for (const auto& [time_ns, frame] : frames) recomputer.take(time_ns, frame);
  return recomputer.finish();
}

}  // namespace

TEST_GROUP(Recomputer) {
  Recording recording;

  std::vector<Recorded*> contacts() {
    std::vector<Recorded*> found;
    for (Recorded& recorded : recording.frames)
      if (decode<ContactFrame>(recorded.frame)) found.push_back(&recorded);
    return found;
  }
  /// What follows from the readings is what was said.
  static RecomputeTally checkSame(const Recording& recorded) {
    const RecomputeTally tally = recomputed(recorded.frames);
    CHECK_TRUE(tally.compared > 100);
    STRCMP_EQUAL("", tally.first.value_or("").c_str());
    LONGS_EQUAL(0, tally.different);
    LONGS_EQUAL(0, tally.absent);
    LONGS_EQUAL(0, tally.gaps);
    return tally;
  }
  std::size_t touchFrames() const {
    return static_cast<std::size_t>(std::ranges::count_if(recording.frames, [](const Recorded& recorded) {
      const CanFrame& frame = recorded.frame;
      return decode<ContactFrame>(frame) || decode<ForceFrame>(frame) || decode<PatchFrame>(frame) ||
             decode<Contact2Frame>(frame) || decode<Force2Frame>(frame);
    }));
  }
};

TEST(Recomputer, ARecordingFromATareOnGivesTheSameFrames) {
  recording.runTared(2500);
  CHECK_TRUE(touchFrames() > 300);
  LONGS_EQUAL(touchFrames(), checkSame(recording).compared);
}

TEST(Recomputer, ATareThatATouchInterruptsIsNoBeginning) {
  Recording touched(Scenario({TouchCourse{0.33, 0.9, from(200, 220, 0.5), steady(20), steady(2)}}));
  touched.runTared(1000, 300);
  const RecomputeTally tally = recomputed(touched.frames);
  LONGS_EQUAL(0, tally.compared);
  LONGS_EQUAL(0, tally.different);
  CHECK_TRUE(tally.leftOut > 500);
}

TEST(Recomputer, WhatWasLearntBeforeTheTareDoesNotMatter) {
  Recording again(Scenario({TouchCourse{0.3, 0.9, from(200, 220, 0.6), steady(18), steady(4)},
                            TouchCourse{1.6, 2.0, from(60, 90, 0.4), steady(25), steady(-4)}}));
  again.runTared(1000, 1200);
  checkSame(again);
}

TEST(Recomputer, ATareThatIsForcedOnATouchIsOneToo) {
  constexpr bool kIsForced = true;
  recording.runTared(1400, 1000, kIsForced);
  checkSame(recording);
}

TEST(Recomputer, ASecondContactThatATareWasForcedOnEndsAfterIt) {
  Recording pair(Scenario({TouchCourse{0.2, 1.5, from(60, 95, 1.2), steady(25), steady(2)},
                           TouchCourse{0.2, 1.2, steady(250), steady(22), steady(0)}}));
  constexpr bool kIsForced = true;
  pair.runTared(1400, 1000, kIsForced);
  const auto begins = [](const Recorded& recorded) {
    const auto second = decode<Contact2Frame>(recorded.frame);
    return second && second->flags.has(FingerFlag::kContact);
  };
  CHECK_TRUE(std::ranges::any_of(pair.frames, begins));
  checkSame(pair);
}

TEST(Recomputer, AFrameThatIsNotWhatTheReadingsGiveIsFound) {
  recording.runTared(1000);
  contacts().at(20)->frame.data[0] ^= 1;
  const RecomputeTally tally = recomputed(recording.frames);
  LONGS_EQUAL(1, tally.different);
  STRCMP_CONTAINS("recorded 181#", tally.first->c_str());
}

TEST(Recomputer, AReadingThatIsNotWhatTheFingerReadIsFound) {
  recording.runTared(1000);
  int page = 0;
  for (Recorded& recorded : recording.frames)
    if (decode<RawFrame>(recorded.frame) && ++page == 3000) recorded.frame.data[3] ^= 8;
  CHECK_TRUE(recomputed(recording.frames).different > 0);
}

TEST(Recomputer, AFrameThatIsMissingIsCounted) {
  recording.runTared(1000);
  const Recorded* gone = contacts().at(20);
  recording.frames.erase(recording.frames.begin() + (gone - recording.frames.data()));
  const RecomputeTally tally = recomputed(recording.frames);
  LONGS_EQUAL(1, tally.absent);
  LONGS_EQUAL(0, tally.different);
}

TEST(Recomputer, AfterAGapNothingIsKnownUntilTheNextTare) {
  recording.runTared(1200);
  int page = 0;
  std::erase_if(recording.frames, [&](const Recorded& recorded) {
    return decode<RawFrame>(recorded.frame).has_value() && ++page == 3000;
  });
  const RecomputeTally tally = recomputed(recording.frames);
  LONGS_EQUAL(1, tally.gaps);
  LONGS_EQUAL(0, tally.different);
  CHECK_TRUE(tally.compared > 10 && tally.compared < touchFrames() - 10);
  CHECK_TRUE(tally.leftOut > 100);
}

TEST(Recomputer, WithoutATareNothingIsKnown) {
  recording.run(100);
  recording.tell(rawRequest(1000));
  recording.run(1000);
  const RecomputeTally tally = recomputed(recording.frames);
  LONGS_EQUAL(0, tally.compared);
  LONGS_EQUAL(0, tally.sets);
  CHECK_TRUE(tally.leftOut > 900);
}

TEST(Recomputer, TheBeginningOfAZeroMustBeThere) {
  recording.runTared(1000);
  int page = 0;
  std::erase_if(recording.frames, [&](const Recorded& recorded) {
    return decode<RawFrame>(recorded.frame).has_value() && ++page < 200;
  });
  LONGS_EQUAL(0, recomputed(recording.frames).compared);
}

TEST(Recomputer, OtherNodesAreOthersBusiness) {
  recording.runTared(600);
  for (Recorded& recorded : recording.frames) ++recorded.frame.id;
  const RecomputeTally tally = recomputed(recording.frames);
  LONGS_EQUAL(0, tally.compared + tally.sets + tally.leftOut);
}

TEST(Recomputer, AFingerWithOtherTablesIsRefused) {
  Recomputer recomputer(defaultTables(), {.node = kNode});
  HeartbeatFrame heartbeat;
  heartbeat.table_crc = static_cast<std::uint8_t>(defaultTables().crc32 + 1);
  recomputer.take(0, encode(heartbeat, kNode + 1));
  try {
    recomputer.take(0, encode(heartbeat, kNode));
    FAIL("taken");
  } catch (const Failure& failure) {
    CHECK_TRUE(failure.code() == ExitCode::kMismatch);
    STRCMP_CONTAINS("node 1 has tables with a CRC-32 that ends in", failure.what());
  }
}
