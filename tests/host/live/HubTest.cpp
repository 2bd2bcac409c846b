#include <atomic>
#include <chrono>
#include <thread>

#include "host/live/command_desk.hpp"
#include "host/live/event_hub.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger::live;
using namespace std::chrono_literals;

TEST_GROUP(EventHub) {
  EventHub hub_;
};

TEST(EventHub, HasNothingAtFirst) {
  CHECK_TRUE(hub_.next(0, 0ms).text == nullptr);
  LONGS_EQUAL(0, hub_.next(0, 0ms).number);
}

TEST(EventHub, AReaderThatIsLateGetsTheNewestAlone) {
  for (const char* text : {"a", "b", "c"}) hub_.publish(text);
  const EventHub::Event event = hub_.next(0, 0ms);
  LONGS_EQUAL(3, event.number);
  STRCMP_EQUAL("c", event.text->c_str());
  CHECK_TRUE(hub_.next(event.number, 0ms).text == nullptr);
}

TEST(EventHub, AReaderThatWaitsIsWoken) {
  std::thread publisher([this] {
    std::this_thread::sleep_for(20ms);
    hub_.publish("now");
  });
  const EventHub::Event event = hub_.next(0, 10s);
  publisher.join();
  STRCMP_EQUAL("now", event.text->c_str());
}

TEST(EventHub, ClosingWakesEveryReaderWithNothing) {
  std::atomic<int> woken = 0;
  const auto read = [&] { woken += hub_.next(0, 10s).text == nullptr; };
  std::thread one(read), other(read);
  hub_.close();
  one.join(), other.join();
  LONGS_EQUAL(2, woken.load());
  CHECK_TRUE(hub_.isClosed());
  hub_.publish("late");
  CHECK_TRUE(hub_.next(0, 0ms).text == nullptr);
}

TEST_GROUP(CommandDesk) {
  CommandDesk desk_;

  /// Answers whatever is asked, until it has answered so many.
  std::thread clerk(int count) {
    return std::thread([this, count] {
      for (int answered = 0; answered < count; std::this_thread::sleep_for(1ms))
        for (const std::uint8_t node : desk_.takeAsked()) desk_.answer({node, true, "done"}), ++answered;
    });
  }
};

TEST(CommandDesk, WhoAsksGetsTheAnswerForItsNode) {
  std::thread answers = clerk(1);
  const auto outcome = desk_.ask(7, 10s);
  answers.join();
  LONGS_EQUAL(7, outcome.value().node);
  STRCMP_EQUAL("done", outcome->text.c_str());
}

TEST(CommandDesk, WithoutAnAnswerThereIsNone) { CHECK_FALSE(desk_.ask(7, 1ms).has_value()); }

TEST(CommandDesk, AnswersForOthersAndOldOnesAreNotTaken) {
  desk_.answer({7, true, "before"});
  std::thread other([this] { desk_.answer({8, true, "of another"}); });
  CHECK_FALSE(desk_.ask(7, 30ms).has_value());
  other.join();
}

TEST(CommandDesk, ANodeAskedTwiceIsAskedOnce) {
  for (int i = 0; i < 2; ++i) desk_.ask(7, 0ms), desk_.ask(3, 0ms);
  const auto asked = desk_.takeAsked();
  LONGS_EQUAL(2, asked.size());
  LONGS_EQUAL(3, asked[0]);
  LONGS_EQUAL(7, asked[1]);
  CHECK_TRUE(desk_.takeAsked().empty());
}
