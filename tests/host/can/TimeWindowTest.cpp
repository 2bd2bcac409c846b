#include "host/can/time_window.hpp"

#include <CppUTest/TestHarness.h>

#include <cstdlib>
#include <ctime>
#include <limits>
#include <string>

using namespace strainfinger::can;

namespace {

/// TZ, for as long as a test needs another.
class TimeZoneGuard {
 public:
  explicit TimeZoneGuard(const char* zone) {
    const char* const before = std::getenv("TZ");
    hasBefore_ = before != nullptr;
    if (hasBefore_) before_ = before;
    setenv("TZ", zone, 1);
    tzset();
  }
  ~TimeZoneGuard() {
    hasBefore_ ? setenv("TZ", before_.c_str(), 1) : unsetenv("TZ");
    tzset();
  }
  TimeZoneGuard(const TimeZoneGuard&) = delete;
  TimeZoneGuard& operator=(const TimeZoneGuard&) = delete;

 private:
  bool hasBefore_ = false;
  std::string before_;
};

void checkMoment(const char* text, std::int64_t time_ns, bool sinceFirst = false) {
  const auto moment = readMoment(text);
  CHECK_TRUE_TEXT(moment.has_value(), text);
  CHECK_EQUAL_TEXT(time_ns, moment->time_ns, text);
  CHECK_EQUAL_TEXT(sinceFirst, moment->sinceFirst, text);
}

}  // namespace

TEST_GROUP(TimeWindow) {
  static LogMoment moment(const char* text) { return readMoment(text).value(); }
};

TEST(TimeWindow, MomentsAreSecondsAsLoggedSinceTheFirstFrameOrDates) {
  checkMoment("0", 0);
  checkMoment("12.5", 12'500'000'000);
  checkMoment("+12.5", 12'500'000'000, true);
  checkMoment("1609779922.655421", 1'609'779'922'655'421'000);
}

TEST(TimeWindow, DatesAreThisMachinesOrUtc) {
  // date -u -d 2021-01-04T17:05:22Z +%s
  const TimeZoneGuard zone("XYZ-2");  // two hours ahead of UTC
  checkMoment("2021-01-04T17:05:22Z", 1'609'779'922'000'000'000);
  checkMoment("2021-01-04T19:05:22", 1'609'779'922'000'000'000);
  checkMoment("2021-01-04T17:05:22.25Z", 1'609'779'922'250'000'000);
  checkMoment("2024-02-29T00:00:00Z", 1'709'164'800'000'000'000);
  checkMoment("2021-01-04T18:05:22+01:00", 1'609'779'922'000'000'000);
  checkMoment("2021-01-04T11:35:22.5-05:30", 1'609'779'922'500'000'000);
  checkMoment("2021-01-04T17:05Z", 1'609'779'900'000'000'000);
  checkMoment("2021-01-04T19:05", 1'609'779'900'000'000'000);
  checkMoment("2021-01-04Z", 1'609'718'400'000'000'000);
  checkMoment("2021-01-04", 1'609'711'200'000'000'000);
}

TEST(TimeWindow, OtherTextsAreNoMoments) {
  for (const char* text : {"",
                           "+",
                           "-1",
                           "+-1",
                           "1s",
                           "nan",
                           "inf",
                           "1e3",
                           "1.",
                           ".5",
                           "1.0123456789",
                           "99999999999999999999",
                           "9300000000",
                           "03:12",
                           "2021-01",
                           "2021-01-04 17:05:22",
                           "2021-1-4T17:05:22",
                           "2021-02-29T17:05:22",
                           "2021-02-29T17:05:22Z",
                           "2021-01-04T25:05:22",
                           "2021-01-04T17:05:22z",
                           "2021-01-04T17:05:22+1:00",
                           "2021-01-04T17:05:22+99:99",
                           "2021-01-04T17:05:22 01:00",
                           "2021-01-04T17:05:22.",
                           "2021-01-04T17:05:22,5",
                           "2021-01-04T17:05:22.5.5",
                           "2021-01-04T17:05:22.-5",
                           "+2021-01-04T17:05:22",
                           "1969-01-04T17:05:22Z"})
    CHECK_FALSE_TEXT(readMoment(text).has_value(), text);
}

TEST(TimeWindow, HasWhatIsBetweenItsEndsAndOnThem) {
  TimeWindow window;
  window.from = moment("2");
  window.to = moment("3");
  CHECK_FALSE(window.has(1'999'999'999));
  CHECK_TRUE(window.has(2'000'000'000));
  CHECK_TRUE(window.has(3'000'000'000));
  CHECK_FALSE(window.has(3'000'000'001));
}

TEST(TimeWindow, ThatEndsBeforeItBeginsIsEmpty) {
  TimeWindow window;
  CHECK_FALSE(window.isEmpty());
  window.from = moment("3");
  window.to = moment("2");
  CHECK_TRUE(window.isEmpty());
  window.to = moment("3");
  CHECK_FALSE(window.isEmpty());
  window.to = moment("+2");
  CHECK_FALSE(window.isEmpty());
}

TEST(TimeWindow, TimesAreDatesWhereTheyCanBe) {
  STRCMP_EQUAL("12.5 s", timeText(12'500'000'000).c_str());
  STRCMP_EQUAL("2021-01-04T17:05:22Z", timeText(1'609'779'922'655'421'000).c_str());
}

TEST(TimeWindow, WithoutEndsItHasAll) {
  TimeWindow window;
  CHECK_TRUE(window.isWhole());
  CHECK_TRUE(window.has(0));
  CHECK_TRUE(window.has(std::numeric_limits<std::int64_t>::max()));
  window.to = moment("1");
  CHECK_FALSE(window.isWhole());
}

TEST(TimeWindow, SecondsAfterTheFirstFrameCountFromTheFirstThatItIsAskedFor) {
  TimeWindow window;
  window.from = moment("+1");
  window.to = moment("+2");
  constexpr std::int64_t kFirst_ns = 9'200'000'000'000'000'000;  // a sum of the two would not fit
  CHECK_FALSE(window.first_ns().has_value());
  CHECK_FALSE(window.has(kFirst_ns));
  CHECK_EQUAL(kFirst_ns, window.first_ns().value());
  CHECK_TRUE(window.has(kFirst_ns + 1'000'000'000));
  CHECK_FALSE(window.has(kFirst_ns + 2'000'000'001));
  CHECK_FALSE(window.has(kFirst_ns - 1));
}
