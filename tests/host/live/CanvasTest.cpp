#include "host/live/canvas.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger::live;

TEST_GROUP(Canvas) {
  Canvas canvas_{2, 10};
};

TEST(Canvas, IsEmptyAtFirst) {
  LONGS_EQUAL(2, canvas_.lines(true).size());
  for (const std::string& line : canvas_.lines(true)) STRCMP_EQUAL("", line.c_str());
}

TEST(Canvas, HoldsTextOfSeveralBytesACharacter) {
  LONGS_EQUAL(6, canvas_.text(0, 1, "±▸a°é"));
  STRCMP_EQUAL(" ±▸a°é", canvas_.lines(false)[0].c_str());
}

TEST(Canvas, CutsOffWhatIsBeyondItsEdges) {
  canvas_.text(1, 8, "abc");
  canvas_.text(0, -1, "xyz");
  canvas_.text(2, 0, "below");
  canvas_.text(-1, 0, "above");
  STRCMP_EQUAL("yz", canvas_.lines(false)[0].c_str());
  STRCMP_EQUAL("        ab", canvas_.lines(false)[1].c_str());
}

TEST(Canvas, StylesAreEscapesAndEndWithTheRow) {
  canvas_.text(0, 0, "a", Style::kBad);
  canvas_.text(0, 1, "b");
  canvas_.text(1, 0, "c", Style::kStrong);
  STRCMP_EQUAL("\033[0;1;31ma\033[0mb", canvas_.lines(true)[0].c_str());
  STRCMP_EQUAL("\033[0;1mc\033[0m", canvas_.lines(true)[1].c_str());
  STRCMP_EQUAL("ab", canvas_.lines(false)[0].c_str());
}
