#include "firmware/app/owed_frames.hpp"

#include "tests/doubles/fake_can_port.hpp"

#include <vector>

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::firmware;
using namespace strainfinger::doubles;
using Outcome = OwedFrames::Outcome;

TEST_GROUP(OwedFrames) {
  OwedFrames owed;
  FakeCanPort can;
  TouchFrames touch;

  static constexpr std::uint32_t kBusOffs = 3;

  void setup() override {
    can.bus.busOffs = kBusOffs;
    touch.force.sequence = touch.patch.sequence = 7;
    touch.second.emplace().contact.sequence = 7;
  }
  std::vector<int> sentIds() const {
    std::vector<int> ids;
    for (const CanFrame& frame : can.sent) ids.push_back(frame.id);
    return ids;
  }
};

TEST(OwedFrames, NothingIsOwedAtFirst) { CHECK_FALSE(owed.any()); }

TEST(OwedFrames, ASecondContactComesLast) {
  owed.owe(touch, 5, 1000, kBusOffs);
  CHECK_TRUE(owed.any());
  CHECK_TRUE(owed.send(can, 1000) == Outcome::kAllSent);
  CHECK_TRUE(sentIds() == (std::vector<int>{0x285, 0x385, 0x205, 0x305}));
  CHECK_TRUE(can.sent[2].data == encode(touch.second->contact, 5).data);
  CHECK_FALSE(owed.any());
}

TEST(OwedFrames, OneContactHasAForceAndAPatch) {
  touch.second.reset();
  owed.owe(touch, 5, 1000, kBusOffs);
  CHECK_TRUE(owed.send(can, 1000) == Outcome::kAllSent);
  CHECK_TRUE(sentIds() == (std::vector<int>{0x285, 0x385}));
}

TEST(OwedFrames, WaitWhileThePortIsBusy) {
  owed.owe(touch, 5, 1000, kBusOffs);
  can.busy = true;
  CHECK_TRUE(owed.send(can, 1000) == Outcome::kWaiting);
  CHECK_TRUE(owed.any());
  can.busy = false;
  CHECK_TRUE(owed.send(can, 50'999) == Outcome::kAllSent);
  LONGS_EQUAL(4, can.sent.size());
}

TEST(OwedFrames, GoOnWhereThePortStopped) {
  owed.owe(touch, 5, 1000, kBusOffs);
  can.room = 1;
  CHECK_TRUE(owed.send(can, 1000) == Outcome::kWaiting);
  can.room = 2;
  CHECK_TRUE(owed.send(can, 2000) == Outcome::kWaiting);
  can.room = 2;
  CHECK_TRUE(owed.send(can, 3000) == Outcome::kAllSent);
  CHECK_TRUE(sentIds() == (std::vector<int>{0x285, 0x385, 0x205, 0x305}));
}

TEST(OwedFrames, AreDroppedWhenTheyAreOld) {
  owed.owe(touch, 5, 0u - 1000, kBusOffs);  // the clock wraps meanwhile
  CHECK_TRUE(owed.send(can, 49'000) == Outcome::kDropped);
  CHECK_FALSE(owed.any());
  LONGS_EQUAL(0, can.sent.size());
}

TEST(OwedFrames, AreDroppedWhenTheNodeHasLeftTheBusSince) {
  owed.owe(touch, 5, 1000, kBusOffs);
  can.room = 1;
  CHECK_TRUE(owed.send(can, 1000) == Outcome::kWaiting);
  ++can.bus.busOffs;  // and is back already
  can.room = 4;
  CHECK_TRUE(owed.send(can, 2000) == Outcome::kDropped);
  CHECK_FALSE(owed.any());
  CHECK_TRUE(sentIds() == (std::vector<int>{0x285}));
}

TEST(OwedFrames, ANewTouchTakesThePlaceOfTheLast) {
  owed.owe(touch, 5, 0, kBusOffs);
  touch.second.reset();
  owed.owe(touch, 6, 0, kBusOffs);
  owed.send(can, 0);
  CHECK_TRUE(sentIds() == (std::vector<int>{0x286, 0x386}));
}
