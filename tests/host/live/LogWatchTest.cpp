#include "host/live/log_watch.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::live;

TEST_GROUP(LogWatch) {
  LogWatch watch_{config::FingerConfig{}};

  void take(const char* line) { CHECK_FALSE(watch_.take(line).has_value()); }
};

TEST(LogWatch, HasNothingAtFirst) {
  CHECK_FALSE(watch_.time_us().has_value());
  CHECK_TRUE(watch_.views(0).empty());
}

TEST(LogWatch, EveryInterfaceIsABusOfItsOwn) {
  take("(1609779922.655421) can1 705#2200004D0E1900A7");  // BUS_HEALTH.md's HEARTBEAT
  take("(1609779922.755421) can0 705#2200004D0E1900A7");
  const auto buses = watch_.views(*watch_.time_us());
  LONGS_EQUAL(2, buses.size());
  STRCMP_EQUAL("can0", buses[0].name.c_str());
  STRCMP_EQUAL("can1", buses[1].name.c_str());
  LONGS_EQUAL(5, buses[0].fingers.at(0).node);
  LONGS_EQUAL(100'000, buses[1].fingers.at(0).silence_us);
}

TEST(LogWatch, ItsTimeIsThatOfTheLastFrame) {
  take("(1609779922.655421) can0 705#2200004D0E1900A7");
  CHECK_TRUE(watch_.time_us() == 1'609'779'922'655'421);
  take("");
  CHECK_TRUE(watch_.time_us() == 1'609'779'922'655'421);
}

TEST(LogWatch, AFrameWithoutATimeCameWithTheOneBefore) {
  take("(1609779922.655421) can0 705#2200004D0E1900A7");
  take("  can0  706   [8]  22 00 00 4D 0E 19 00 A7");
  CHECK_TRUE(watch_.time_us() == 1'609'779'922'655'421);
  LONGS_EQUAL(2, watch_.views(0).at(0).fingers.size());
}

TEST(LogWatch, GoesOnWhereTheClockWasSetBack) {
  take("(1609779922.655421) can0 705#2200004D0E1900A7");
  take("(1609779862.655421) can0 706#2200004D0E1900A7");
  take("(1609779863.655421) can0 706#2200004D0E1900A7");
  CHECK_TRUE(watch_.time_us() == 1'609'779'923'655'421);
  CHECK_TRUE(watch_.views(*watch_.time_us()).at(0).fingers.at(0).isSilent());
}

TEST(LogWatch, FramesThatNoFingerSendsAreOfTheBusOnly) {
  take("(1.000000) can0 701#R");
  take("(1.000000) can0 00000701#2200004D0E1900A7");
  take("(1.000000) can0 20000080#0000000000000000");  // an error frame, which was on no bus
  const auto buses = watch_.views(1'100'000);
  CHECK_TRUE(buses.at(0).fingers.empty());
  LONGS_EQUAL(2, buses[0].framesPerSecond);
}

TEST(LogWatch, ALineThatCannotBeReadIsSaidToBe) {
  LONGS_EQUAL(9, watch_.take("nonsense").value().column);  // where an identifier should be
  CHECK_TRUE(watch_.views(0).empty());
}
