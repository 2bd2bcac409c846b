#include "firmware/board/mps2/world.hpp"

#include <deque>
#include <vector>

#include <CppUTest/TestHarness.h>

#include "firmware/board/mps2/timer.hpp"
#include "tests/doubles/fake_clock.hpp"
#include "tests/firmware/board/fake_world_line.hpp"

using namespace strainfinger;
using namespace strainfinger::mps2;

namespace {

struct FakeBus {
  bool sentAll = true;
  bool idle() const { return sentAll; }
};

}  // namespace

using FakeWorld = World<FakeWorldLine, FakeBus, doubles::FakeClock>;
static_assert(hal::GaugeAdc<FakeWorld>);
static_assert(hal::Clock<FakeWorld>);

TEST_GROUP(World) {
  FakeWorldLine line;
  FakeBus bus;
  FakeWorld world{line, bus};
  hal::SampleSet set{};
  std::vector<WorldRecord> acted;

  bool poll() {
    return world.poll([this](const WorldRecord& record) { acted.push_back(record); });
  }
  void tell(const WorldRecord& record) { line.tell(bytesOf(record)); }
  void tellSamples(std::uint16_t first, std::uint16_t second) {
    const std::array codes{first, second};
    tell(samplesRecord(codes));
  }
};

TEST(World, NothingToldIsNothing) {
  CHECK_FALSE(poll());
  CHECK_FALSE(world.read(set));
  LONGS_EQUAL(0, world.now_us());
}

TEST(World, SamplesAreHandedOutOnceAndTakeAPeriod) {
  tellSamples(0x1234, 0xFEDC);
  CHECK_TRUE(poll());
  LONGS_EQUAL(kRecordPeriod_us, world.now_us());
  CHECK_TRUE(world.read(set));
  LONGS_EQUAL(0x1234, set[0]);
  LONGS_EQUAL(0xFEDC, set[1]);
  CHECK_FALSE(world.read(set));
}

TEST(World, ThePageShowsTheBytes) {
  tellSamples(0x1234, 0xFEDC);
  const std::deque<std::uint8_t> expected{'S', 4, 0x34, 0x12, 0xDC, 0xFE};
  CHECK_TRUE(line.bytes == expected);
}

TEST(World, TheNextRecordWaitsForTheLast) {
  tellSamples(1, 2);
  tellSamples(3, 4);
  poll();
  CHECK_TRUE(poll());
  LONGS_EQUAL(kRecordPeriod_us, world.now_us());
  world.read(set);
  bus.sentAll = false;
  CHECK_FALSE(poll());
  bus.sentAll = true;
  CHECK_TRUE(poll());
  world.read(set);
  LONGS_EQUAL(3, set[0]);
}

TEST(World, SilenceTakesAPeriodWithoutSamples) {
  tell({RecordKind::kSilence});
  CHECK_TRUE(poll());
  CHECK_FALSE(world.read(set));
  LONGS_EQUAL(kRecordPeriod_us, world.now_us());
}

TEST(World, WithATimerTimeIsTheTimers) {
  doubles::FakeClock timer{5};
  FakeWorld timed{line, bus, &timer};
  tell({RecordKind::kSilence});
  CHECK_TRUE(timed.poll([](const WorldRecord&) {}));
  LONGS_EQUAL(5, timed.now_us());
  timer.advance(7);
  LONGS_EQUAL(12, timed.now_us());
}

TEST(World, ATimersMicrosecondsLoseNothingAndWrap) {
  MicrosecondCount count;
  std::uint32_t ticks = 0xFFFF'FFFF;
  std::uint64_t passed = 0;
  for (const std::uint32_t step : {1u, 24u, 25u, 26u, 3'000'000'000u, 4'000'000'000u, 4'294'967'200u, 49u}) {
    ticks -= step;
    passed += step;
    UNSIGNED_LONGS_EQUAL(passed / kTimer_MHz, count.at(ticks));
  }
}

TEST(World, OtherRecordsTakeNoTime) {
  WorldRecord harm{RecordKind::kHarm};
  harm.add(static_cast<std::uint8_t>(Harm::kHang));
  tell(harm);
  CHECK_TRUE(poll());
  LONGS_EQUAL(0, world.now_us());
  LONGS_EQUAL(1, acted.size());
  CHECK_TRUE(acted[0].kind == RecordKind::kHarm && acted[0].payload[0] == 4);
}

TEST(World, ARecordThatClaimsTooMuchIsCut) {
  line.bytes.assign(300, 0xFF);
  CHECK_TRUE(poll());
  LONGS_EQUAL(1, acted.size());
  LONGS_EQUAL(64, acted[0].size);
}

TEST(World, AFullRingOfGaugesFits) {
  std::array<std::uint16_t, kMaxGauges> codes{};
  codes.back() = 0xABCD;
  tell(samplesRecord(codes));
  CHECK_TRUE(poll());
  CHECK_TRUE(world.read(set));
  LONGS_EQUAL(0xABCD, set.back());
}
