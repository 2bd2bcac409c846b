#include "host/base/number_rows.hpp"

#include <sstream>
#include <string>
#include <vector>

#include "host/base/failure.hpp"

#include <CppUTest/TestHarness.h>

using strainfinger::ExitCode;
using strainfinger::Failure;
using strainfinger::NumberRowReader;

TEST_GROUP(NumberRows){
    static std::vector<std::vector<double>> read(const std::string& text,
                                                 std::size_t columns = 2){std::istringstream stream(text);
NumberRowReader reader(stream, "stdin", columns);
std::vector<std::vector<double>> rows;
for (std::vector<double> row; reader.next(row);) rows.push_back(row);
return rows;
}
static std::string complaintAbout(const std::string& text) {
  try {
    read(text);
  } catch (const Failure& failure) {
    LONGS_EQUAL(static_cast<int>(ExitCode::kFailure), static_cast<int>(failure.code()));
    return failure.what();
  }
  return "none";
}
}
;

TEST(NumberRows, RowsAreReadInOrder) {
  const auto rows = read("1,2\n-3.5e-4,+4\n");
  LONGS_EQUAL(2, rows.size());
  DOUBLES_EQUAL(-3.5e-4, rows[1][0], 0);
  DOUBLES_EQUAL(4, rows[1][1], 0);
}

TEST(NumberRows, AHeaderBlankLinesAndCommentsArePassedOver) {
  LONGS_EQUAL(2, read("g0,g1\n\n# measured today\n1,2\r\n 3 ,\t4\n").size());
}

TEST(NumberRows, AFirstRowWithANumberInItIsNoHeader) {
  STRCMP_EQUAL("stdin:1:1: \"foo\" is no number", complaintAbout("foo,2\n").c_str());
}

TEST(NumberRows, AnotherHeaderThanTheOneAskedForIsRefused) {
  const auto firstOf = [](const std::string& text) {
    std::istringstream stream(text);
    NumberRowReader reader(stream, "shape.csv", 2, {.header = "x_m,height_m"});
    std::vector<double> row;
    return reader.next(row) ? row[1] : -1;
  };
  DOUBLES_EQUAL(2, firstOf("x_m, height_m\n1,2\n"), 0);
  DOUBLES_EQUAL(2, firstOf("1,2\n"), 0);
  std::string told;
  try {
    firstOf("x_mm,height_mm\n1,2\n");
  } catch (const Failure& failure) {
    told = failure.what();
  }
  STRCMP_EQUAL("shape.csv:1:1: the header is \"x_mm,height_mm\", not \"x_m,height_m\"", told.c_str());
}

TEST(NumberRows, ALastLineWithoutNewlineCounts) { LONGS_EQUAL(1, read("1,2").size()); }

TEST(NumberRows, NoTextGivesNoRows) { LONGS_EQUAL(0, read("").size()); }

TEST(NumberRows, AWordBelowTheFirstRowIsNamedWithItsPlace) {
  STRCMP_EQUAL("stdin:2:3: \"x\" is no number", complaintAbout("1,2\n3,x\n").c_str());
}

TEST(NumberRows, AnEmptyFieldIsNamed) {
  STRCMP_EQUAL("stdin:1:3: \"\" is no number", complaintAbout("1,\n").c_str());
}

TEST(NumberRows, NotANumberAndInfinityAreRefused) {
  STRCMP_EQUAL("stdin:2:1: nan is no finite number", complaintAbout("1,2\nnan,2\n").c_str());
  STRCMP_EQUAL("stdin:2:3: -inf is no finite number", complaintAbout("1,2\n1,-inf\n").c_str());
}

TEST(NumberRows, HugeNumbersThatOverflowAreRefused) {
  STRCMP_EQUAL("stdin:1:3: \"1e999\" is no number", complaintAbout("1,1e999\n").c_str());
}

TEST(NumberRows, RowsOfAnotherLengthAreRefused) {
  STRCMP_EQUAL("stdin:1:2: 1 columns where 2 are needed", complaintAbout("1\n").c_str());
  STRCMP_EQUAL("stdin:1:5: more than 2 columns", complaintAbout("1,2,3\n").c_str());
}

TEST(NumberRows, NumbersBeyondALimitAreRefusedWithAHint) {
  std::istringstream stream("1,-1\n1,1.5\n");
  NumberRowReader reader(stream, "stdin", 2, {1, "too large"});
  std::vector<double> row;
  CHECK_TRUE(reader.next(row));
  try {
    reader.next(row);
    FAIL("taken");
  } catch (const Failure& failure) {
    STRCMP_EQUAL("stdin:2:3: 1.5 is beyond +-1: too large", failure.what());
  }
}
