#include "host/live/pending_request.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::live;

TEST_GROUP(PendingRequest) {
  PendingRequest request_{5, tareRequest(false), 1'000'000};

  CanFrame response(CommandStatus status, std::uint32_t value = 0) {
    return encode(responseTo(Command::kTare, status, value), 5);
  }
};

TEST(PendingRequest, IsTheFrameOfTheBusDocument) {
  CHECK_TRUE(request_.frame() ==
             (CanFrame{0x605, 8, {0x02, 0x01}}));  // BUS_REQUESTS.md: tare, unless touched
}

TEST(PendingRequest, ItsResponseIsItsOutcome) {
  request_.markSent();
  const auto outcome = request_.take(response(CommandStatus::kDone));
  LONGS_EQUAL(5, outcome.value().node);
  CHECK_TRUE(outcome->isDone);
  STRCMP_EQUAL("node 5: tare: Done", outcome->text.c_str());
}

TEST(PendingRequest, ARefusalSaysWhy) {
  request_.markSent();
  const auto touched = request_.take(response(CommandStatus::kTouched));
  CHECK_FALSE(touched.value().isDone);
  STRCMP_CONTAINS("Refused: something touches the finger", touched->text.c_str());
  STRCMP_CONTAINS("Not yet: a zero was taken or refused just now; try again in 45 s",
                  request_.take(response(CommandStatus::kWait, 45))->text.c_str());
  STRCMP_CONTAINS("status 99", request_.take(response(static_cast<CommandStatus>(99)))->text.c_str());
}

TEST(PendingRequest, OtherFramesAreNoAnswer) {
  request_.markSent();
  CHECK_FALSE(request_.take(encode(responseTo(Command::kTare, CommandStatus::kDone), 6)).has_value());
  CHECK_FALSE(request_.take(encode(responseTo(Command::kKeep, CommandStatus::kDone), 5)).has_value());
  CHECK_FALSE(request_.take(request_.frame()).has_value());
}

TEST(PendingRequest, AnAnswerBeforeItWasSentIsSomebodyElses) {
  CHECK_FALSE(request_.take(response(CommandStatus::kDone)).has_value());
}

TEST(PendingRequest, AfterASecondThereIsNoAnswer) {
  request_.markSent();
  CHECK_FALSE(request_.expire(1'999'999).has_value());
  STRCMP_EQUAL("node 5: tare: no answer: is it on the bus still?", request_.expire(2'000'000)->text.c_str());
}

TEST(PendingRequest, ABusThatTakesNothingIsSaidToBeThat) {
  STRCMP_CONTAINS("takes no frames", request_.expire(2'000'000).value().text.c_str());
}
