// Tables sent to a finger that answers as it should, and as it should not.
#include "host/can/table_push.hpp"

#include <chrono>
#include <cstring>
#include <memory>
#include <thread>
#include <utility>

#include "firmware/app/table_loader.hpp"
#include "host/system/memory_store.hpp"
#include "tests/host/can/fake_bus_port.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::can;

TEST_GROUP(TablePush) {
  static constexpr std::uint8_t kNode = 5;
  FakeBusPort bus;
  system::MemoryStore memory{12};
  firmware::TableLoader<system::MemoryStore> finger{memory};
  std::unique_ptr<TableImage> image = std::make_unique<TableImage>();
  bool begins = true;  ///< when it is told to
  int asked = 0;
  int lostAnswers = 0;  ///< of those to come

  void setup() override {
    auto* const bytes = reinterpret_cast<unsigned char*>(image.get());
    for (std::size_t i = 0; i < sizeof *image; ++i) bytes[i] = static_cast<unsigned char>(i * 7 + i / 256);
    bus.onSend = [this](const CanFrame& frame) {
      ++asked;
      const auto request = readSingleFrame<RequestFrame>(frame, kNode);
      if (request->command == Command::kLoad && begins) finger.begin();
      const ResponseFrame response = request->command == Command::kWord
                                         ? finger.take(request->argument, request->word)
                                         : responseTo(request->command, CommandStatus::kDone);
      if (lostAnswers > 0)
        --lostAnswers;
      else
        bus.hear(response, kNode);
    };
  }
  TablePush push(int words = kTableWords) {
    return pushTables(bus, kNode, *image, false, [words](int sent) { return sent < words; });
  }
};

TEST(TablePush, TheFingerHasEveryByte) {
  const TablePush done = push();
  LONGS_EQUAL(kTableWords, done.words);
  CHECK_FALSE(done.isStopped);
  LONGS_EQUAL(kTableWords + 1, asked);
  TableImage taken;
  CHECK_TRUE(memory.read(0, std::as_writable_bytes(std::span(&taken, 1))) == hal::StoreResult::kOk);
  MEMCMP_EQUAL(image.get(), &taken, sizeof taken);
}

TEST(TablePush, IsStopped) {
  const TablePush stopped = push(10);
  LONGS_EQUAL(10, stopped.words);
  CHECK_TRUE(stopped.isStopped);
  LONGS_EQUAL(11, asked);
}

TEST(TablePush, EndsWhereItIsRefused) {
  bus.onSend = [this](const CanFrame&) {
    ++asked;
    bus.hear(responseTo(Command::kLoad, CommandStatus::kTouched), kNode);
  };
  const TablePush refused = push();
  LONGS_EQUAL(1, asked);
  LONGS_EQUAL(0, refused.words);
  CHECK_TRUE(refused.command == Command::kLoad);
  CHECK_TRUE(refused.reply.response->status == CommandStatus::kTouched);
}

TEST(TablePush, EndsAtAWordThatIsOutOfTurn) {
  begins = false;
  finger.begin();
  finger.take(0, 0);
  finger.take(1, 0);
  const TablePush refused = push();
  LONGS_EQUAL(0, refused.words);
  CHECK_TRUE(refused.command == Command::kWord);
  CHECK_TRUE(refused.reply.response->status == CommandStatus::kOutOfTurn);
  LONGS_EQUAL(2, refused.reply.response->value);
}

TEST(TablePush, AWordWhoseAnswerIsLostIsSaidAgain) {
  bool isLost = false;
  const auto loses = [this, &isLost](int words) {
    if (words == 3 && !std::exchange(isLost, true)) lostAnswers = 1;
    return words < 6;
  };
  LONGS_EQUAL(6, pushTables(bus, kNode, *image, false, loses).words);
  LONGS_EQUAL(1 + 6 + 1, asked);
}

// A word that was said twice is answered twice.
TEST(TablePush, AnAnswerThatIsLateIsNotTakenForTheNextWords) {
  int late = 0;
  const auto answer = bus.onSend;
  bus.onSend = [&, answer](const CanFrame& frame) {
    const auto request = readSingleFrame<RequestFrame>(frame, kNode);
    if (request->command == Command::kWord && request->argument == 3 && late++ == 0) {
      bus.hear(responseTo(Command::kWord, CommandStatus::kDone, 3), kNode);
      return;  // and the word itself is lost
    }
    answer(frame);
  };
  LONGS_EQUAL(10, push(10).words);
  LONGS_EQUAL(2, late);
}

TEST(TablePush, AFingerThatSaysThatAnotherWordIsDueIsNotSilent) {
  const auto answer = bus.onSend;
  bus.onSend = [this, answer](const CanFrame& frame) {
    const auto request = readSingleFrame<RequestFrame>(frame, kNode);
    if (request->command != Command::kWord || request->argument < 3) return answer(frame);
    ++asked;
    bus.hear(responseTo(Command::kWord, CommandStatus::kDone, 77), kNode);
  };
  const TablePush out = push();
  CHECK_TRUE(out.isOutOfStep);
  LONGS_EQUAL(3, out.words);
  LONGS_EQUAL(77, out.reply.response->value);
  LONGS_EQUAL(1 + 3 + kPushAttempts, asked);
}

TEST(TablePush, WhatWasHeardBeforeIsNoAnswer) {
  bus.hear(responseTo(Command::kLoad, CommandStatus::kTouched), kNode);
  LONGS_EQUAL(5, push(5).words);
}

TEST(TablePush, AnotherWhoAsksTheSameNodeIsNoticed) {
  CHECK_FALSE(push(5).othersAsk);
  const auto answer = bus.onSend;
  bus.onSend = [&, answer](const CanFrame& frame) {
    bus.hear(wordRequest(7, 7), kNode);
    answer(frame);
  };
  CHECK_TRUE(push(5).othersAsk);
}

TEST(TablePush, ATouchedFingerIsToldThatItIsMeant) {
  pushTables(bus, kNode, *image, true, [](int words) { return words < 1; });
  CHECK_TRUE(bus.sent[0] == encode(loadRequest(true), kNode));
}

TEST(TablePush, IsStoppedWhileNobodyAnswers) {
  bus.onSend = [this](const CanFrame&) { ++asked; };
  const TablePush stopped = pushTables(bus, kNode, *image, false, [this](int) { return asked == 0; });
  CHECK_TRUE(stopped.isStopped);
  CHECK_TRUE(stopped.reply.waited < kAskFor);
  LONGS_EQUAL(1, asked);
}

TEST(TablePush, WhenNobodyAnswersItIsSaidThreeTimes) {
  bus.onSend = [this](const CanFrame&) { ++asked; };
  const TablePush unanswered = push();
  CHECK_TRUE(unanswered.reply.waited >= 3 * kAskFor);
  LONGS_EQUAL(3, asked);
  CHECK_FALSE(unanswered.reply.response.has_value());
}

TEST_GROUP(HeartbeatAfterRestart) {
  static bool goOn() { return true; }
  static constexpr std::uint8_t kNode = 5;
  static constexpr std::chrono::milliseconds kShort{60};
};

namespace {

/// Says it has no tables, as it may have said before; then what it starts with.
class RestartingBus : public FakeBusPort {
 public:
  explicit RestartingBus(FingerState state) : state_(state) {}
  bool waitReadable(std::chrono::milliseconds) noexcept override {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    hear(HeartbeatFrame{.state = FingerState::kRun}, 6);
    hear(HeartbeatFrame{.state = said_++ == 0 ? FingerState::kFault : state_, .table_crc = 0x5A}, 5);
    return true;
  }

 private:
  FingerState state_;
  int said_ = 0;
};

}  // namespace

TEST(HeartbeatAfterRestart, IsTheNextOneOfThatFingerThatMeasures) {
  RestartingBus bus(FingerState::kRun);
  const auto heartbeat = heartbeatAfterRestart(bus, kNode, std::chrono::seconds(5), goOn);
  CHECK_TRUE(heartbeat && heartbeat->state == FingerState::kRun);
  LONGS_EQUAL(0x5A, heartbeat->table_crc);
}

TEST(HeartbeatAfterRestart, OfAFingerThatOnlyStartsIsTheLast) {
  RestartingBus bus(FingerState::kZeroing);
  const auto heartbeat = heartbeatAfterRestart(bus, kNode, kShort, goOn);
  CHECK_TRUE(heartbeat && heartbeat->state == FingerState::kZeroing);
}

TEST(HeartbeatAfterRestart, ThatItHasNoTablesItSaysTwice) {
  RestartingBus bus(FingerState::kFault);
  const auto heartbeat = heartbeatAfterRestart(bus, kNode, std::chrono::seconds(5), goOn);
  CHECK_TRUE(heartbeat && heartbeat->state == FingerState::kFault);
  FakeBusPort once;
  once.hear(HeartbeatFrame{.state = FingerState::kFault}, kNode);
  CHECK_FALSE(heartbeatAfterRestart(once, kNode, kShort, goOn).has_value());
}

TEST(HeartbeatAfterRestart, IsNoLongerWaitedForWhenItIsStopped) {
  FakeBusPort bus;
  int asked = 0;
  CHECK_FALSE(
      heartbeatAfterRestart(bus, kNode, std::chrono::hours(1), [&] { return ++asked < 3; }).has_value());
}

TEST(HeartbeatAfterRestart, OfAFingerThatRunsAsBeforeIsTheLast) {
  FakeBusPort bus;
  bus.hear(HeartbeatFrame{.state = FingerState::kRun, .uptime_s = 523}, kNode);
  const auto begin = std::chrono::steady_clock::now();
  const auto heartbeat = heartbeatAfterRestart(bus, kNode, kShort, goOn);
  CHECK_TRUE(std::chrono::steady_clock::now() - begin >= kShort);
  LONGS_EQUAL(523, heartbeat->uptime_s);
  CHECK_TRUE(isOlderThan(*heartbeat, kShort));
}

TEST(HeartbeatAfterRestart, MayNotCome) {
  RestartingBus bus(FingerState::kRun);
  CHECK_FALSE(heartbeatAfterRestart(bus, kNode + 2, kShort, goOn).has_value());
}
