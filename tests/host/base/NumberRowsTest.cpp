#include "host/base/number_rows.hpp"

#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "host/base/failure.hpp"
#include "host/base/line_reader.hpp"

#include <CppUTest/TestHarness.h>

using strainfinger::ExitCode;
using strainfinger::Failure;
using strainfinger::LineReader;
using strainfinger::NumberRowReader;

TEST_GROUP(NumberRows) {
  static std::vector<std::vector<double>> read(const std::string& text, std::size_t columns = 2) {
    std::istringstream stream(text);
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
};

TEST(NumberRows, RowsAreReadInOrder) {
  const auto rows = read("1,2\n-3.5e-4,+4\n");
  LONGS_EQUAL(2, rows.size());
  DOUBLES_EQUAL(-3.5e-4, rows[1][0], 0);
  DOUBLES_EQUAL(4, rows[1][1], 0);
}

TEST(NumberRows, ACompressedFileIsNoRows) {
  STRCMP_CONTAINS("stdin is compressed with gzip: `zcat FILE | ", complaintAbout("\x1F\x8B\x08").c_str());
}

TEST(NumberRows, AHeaderBlankLinesAndCommentsArePassedOver) {
  LONGS_EQUAL(2, read("g0,g1\n\n# measured today\n1,2\r\n 3 ,\t4\n").size());
}

TEST(NumberRows, AFirstRowWithANumberInItIsNoHeader) {
  STRCMP_EQUAL("stdin:1:1: \"foo\" is no number", complaintAbout("foo,2\n").c_str());
}

TEST(NumberRows, WhatATerminalWouldNotShowIsNamedByItsBytes) {
  using namespace std::string_literals;
  STRCMP_EQUAL("stdin:1:1: \"\\x00\\x01\" is no number", complaintAbout("\0\1\n"s).c_str());
  STRCMP_EQUAL("stdin:1:3: \"\\x1B[2J\\x7F\" is no number", complaintAbout("1,\x1B[2J\x7F\n").c_str());
  STRCMP_EQUAL("stdin:1:1: \"\xC3\xA9\" is no number", complaintAbout("\xC3\xA9,1\n").c_str());
}

TEST(NumberRows, AnEndlessLineIsRefused) {
  const std::string whole = "1," + std::string(LineReader::kLongestLine_bytes - 3, ' ') + "2";
  LONGS_EQUAL(2, read(whole + "\n" + whole).size());
  STRCMP_EQUAL("stdin:2:65537: the line has more than 65536 bytes",
               complaintAbout("1,2\n" + whole + " \n").c_str());
  STRCMP_EQUAL("stdin:1:65537: the line has more than 65536 bytes",
               complaintAbout(std::string(1'000'000, '\0')).c_str());
}

TEST(NumberRows, AnErrorOfReadingIsNoEnd) {
  std::ifstream folder("/");
  NumberRowReader reader(folder, "/", 2);
  std::vector<double> row;
  try {
    reader.next(row);
    FAIL("accepted");
  } catch (const Failure& failure) {
    STRCMP_EQUAL("/: cannot read: Is a directory", failure.what());
  }
}

TEST(NumberRows, MoreOfTheColumnsThanAreWantedAreAnotherFiles) {
  const NumberRowReader::Limit limit{
      .columns = {"g_0", "g_1"}, .family = "g_", .familyHint = "but there are two"};
  std::vector<double> row;
  std::istringstream others("g_0,g_1,g_,g_x,ag_3\n1,2,3,4,5\n");
  CHECK_TRUE(NumberRowReader(others, "stdin", 2, limit).next(row));
  std::istringstream more("time_s,g_0,g_1,g_2,g_3\n1,2,3,4,5\n");
  try {
    NumberRowReader(more, "stdin", 2, limit).next(row);
    FAIL("accepted");
  } catch (const Failure& failure) {
    STRCMP_EQUAL("stdin:1:1: the file has g_2 .. g_3, but there are two", failure.what());
  }
}

TEST(NumberRows, NamedColumnsAreFoundAmongOthers) {
  std::istringstream stream("time_s, b,\"note\",a\n0.100,2,\"x y\",1\n0.2,4,,3\n");
  NumberRowReader reader(stream, "stdin", 2, {.columns = {"a", "b"}});
  std::vector<double> row;
  CHECK_TRUE(reader.next(row));
  CHECK_TRUE(row == (std::vector<double>{1, 2}));
  CHECK_TRUE(reader.otherNames() == (std::vector<std::string>{"time_s", "note"}));
  CHECK_TRUE(reader.others() == (std::vector<std::string>{"0.100", "x y"}));
  CHECK_TRUE(reader.next(row));
  CHECK_TRUE(row == (std::vector<double>{3, 4}));
  CHECK_TRUE(reader.others() == (std::vector<std::string>{"0.2", ""}));
}

// RFC 4180, 2.6 and 2.7.
TEST(NumberRows, QuotedTextsMayHoldCommasAndQuotes) {
  std::istringstream stream("\"my, note\",a\n \"x, \"\"y\"\", z\" ,1\n\"\",2\n\"open,3\n");
  NumberRowReader reader(stream, "stdin", 1, {.columns = {"a"}});
  std::vector<double> row;
  CHECK_TRUE(reader.next(row));
  CHECK_TRUE(reader.otherNames() == (std::vector<std::string>{"my, note"}));
  CHECK_TRUE(reader.others() == (std::vector<std::string>{"x, \"y\", z"}));
  CHECK_TRUE(reader.next(row));
  CHECK_TRUE(reader.others() == (std::vector<std::string>{""}));
  try {
    reader.next(row);
    FAIL("a quote without its end is taken");
  } catch (const Failure& failure) {
    STRCMP_EQUAL("stdin:4:1: a quote is not closed", failure.what());
  }
}

TEST(NumberRows, NumbersMayBeQuotedToo) {
  const auto rows = read("\"a\",\"b\"\n\"1.5\", \"-2e3\" \n");
  LONGS_EQUAL(1, rows.size());
  DOUBLES_EQUAL(1.5, rows[0][0], 0);
  DOUBLES_EQUAL(-2e3, rows[0][1], 0);
  STRCMP_EQUAL("stdin:1:3: \"1 V\" is no number", complaintAbout("1,\"1 V\"\n").c_str());
}

TEST(NumberRows, WithoutAHeaderNamedColumnsAreAllThereIs) {
  std::istringstream stream("1,2\n");
  NumberRowReader reader(stream, "stdin", 2, {.columns = {"a", "b"}});
  std::vector<double> row;
  CHECK_TRUE(reader.next(row));
  CHECK_TRUE(row == (std::vector<double>{1, 2}));
  CHECK_TRUE(reader.otherNames().empty());
}

TEST(NumberRows, AHeaderWithoutTheNamedColumnsIsRefused) {
  const std::pair<const char*, const char*> complaints[] = {
      {"a,c\n1,2\n", "stdin:1:1: the header has no column b: name them a to b, or leave the header out"},
      {"a,b,a\n1,2,3\n", "stdin:1:1: the header has more than one column a"}};
  for (const auto& [text, complaint] : complaints) {
    std::istringstream stream(text);
    NumberRowReader reader(stream, "stdin", 2, {.columns = {"a", "b"}});
    std::vector<double> row;
    try {
      reader.next(row);
      FAIL("read");
    } catch (const Failure& failure) {
      STRCMP_CONTAINS(complaint, failure.what());
    }
  }
}

TEST(NumberRows, ARowIsAsLongAsItsHeader) {
  for (const char* row : {"1,2\n", "1,2,3,4\n"}) {
    std::istringstream stream(std::string("a,b,c\n") + row);
    NumberRowReader reader(stream, "stdin", 2, {.columns = {"a", "b"}});
    std::vector<double> values;
    CHECK_THROWS(Failure, reader.next(values));
  }
}

TEST(NumberRows, NamesMayBeQuoted) { LONGS_EQUAL(1, read("\"g0\", \"gauge 1\"\n1,2\n").size()); }

TEST(NumberRows, AByteOrderMarkIsPassedOver) {
  LONGS_EQUAL(1, read("\xEF\xBB\xBFg0,g1\n1,2\n").size());
  LONGS_EQUAL(1, read("\xEF\xBB\xBF"
                      "1,2\n")
                     .size());
  STRCMP_CONTAINS("stdin:2:1: ", complaintAbout("1,2\n\xEF\xBB\xBF"
                                                "1,2\n")
                                     .c_str());
}

TEST(NumberRows, AFirstRowWithOtherSeparatorsIsNoHeader) {
  STRCMP_EQUAL("stdin:1:1: \"1\t2\" has tabs: separate columns by commas", complaintAbout("1\t2\n").c_str());
  STRCMP_EQUAL("stdin:1:1: \"g0\tg1\" has tabs: separate columns by commas",
               complaintAbout("g0\tg1\n1\t2\n").c_str());
  STRCMP_EQUAL("stdin:1:1: \"1;2\" has semicolons: separate columns by commas",
               complaintAbout("1;2\n").c_str());
  STRCMP_EQUAL("stdin:1:1: \"1 2\" is no number", complaintAbout("1 2\n").c_str());
}

TEST(NumberRows, AFirstRowOfQuotedNumbersIsNoHeader) { LONGS_EQUAL(1, read("\"1\",\"2\"\n").size()); }

TEST(NumberRows, AFirstRowOfMissingNumbersIsNoHeader) {
  for (const std::string missing : {"NA", "n/a", "null", "None", "nil", "missing", "-", "", "*"})
    STRCMP_EQUAL(("stdin:1:1: \"" + missing + "\" is no number").c_str(),
                 complaintAbout(missing + "," + missing + "\n1,2\n").c_str());
  STRCMP_EQUAL("stdin:1:1: NaN is no finite number", complaintAbout("NaN,NaN\n").c_str());
  STRCMP_EQUAL("stdin:1:1: \"g0\" is no number", complaintAbout("g0,NA\n1,2\n").c_str());
}

TEST(NumberRows, AHeaderHasANameForEachColumn) {
  STRCMP_EQUAL("stdin:1:1: the header has 3 columns where 2 are needed",
               complaintAbout("a,b,c\n1,2\n").c_str());
  STRCMP_EQUAL("stdin:1:1: the header has 1 columns where 2 are needed", complaintAbout("a\n1,2\n").c_str());
}

TEST(NumberRows, OnlyTheFirstRowIsAHeader) {
  STRCMP_EQUAL("stdin:2:1: \"b\" is no number", complaintAbout("a,b\nb,a\n1,2\n").c_str());
}

TEST(NumberRows, AHeaderThatIsRepeatedIsPassedOver) {
  LONGS_EQUAL(2, read("a,b\n1,2\na,b\n3,4\na,b\n").size());
}

TEST(NumberRows, AHeaderThatIsRepeatedInOtherBytesIsPassedOver) {
  const std::string mark = "\xEF\xBB\xBF";
  LONGS_EQUAL(2, read("a,b\n1,2\n\"a\", b \r\n3,4\n").size());
  LONGS_EQUAL(2, read(mark + "a,b\n1,2\n" + mark + "a,b\n3,4\n").size());
}

// -1.2e-05, cut.
TEST(NumberRows, ALastNumberThatLostItsExponentIsCut) {
  for (const char* cut : {"-1.2", "-1.2e", "-1.2e-", "-1.2e-0"}) {
    std::istringstream stream(std::string("0.1,0.2\n0.3,") + cut);
    NumberRowReader reader(stream, "stdin", 2, {.most = 1});
    std::vector<double> row;
    CHECK_TRUE(reader.next(row));
    CHECK_FALSE_TEXT(reader.next(row), cut);
    CHECK_TRUE(reader.isCut());
  }
  std::istringstream whole("0.1,0.2\n0.3,-1.2\n");
  NumberRowReader reader(whole, "stdin", 2, {.most = 1});
  std::vector<double> row;
  CHECK_TRUE(reader.next(row));
  CHECK_THROWS(Failure, reader.next(row));
}

TEST(NumberRows, ALastLineThatWasCutIsLeftOut) {
  for (const char* cut : {"3", "3,", "3,-", "3,4e-", "\"3,4"})
    LONGS_EQUAL_TEXT(1, read(std::string("1,2\n") + cut).size(), cut);
  LONGS_EQUAL(0, read("a,b\n3").size());
  LONGS_EQUAL(2, read("1,2\n3,4").size());
  std::istringstream stream("1,2\n3");
  NumberRowReader reader(stream, "stdin", 2, {.mayBeEmpty = true});
  std::vector<double> row;
  CHECK_TRUE(reader.next(row));
  CHECK_FALSE(reader.isCut());
  CHECK_FALSE(reader.next(row));
  CHECK_TRUE(reader.isCut());
}

TEST(NumberRows, WhatIsNoPartOfARowIsNotCut) {
  STRCMP_EQUAL("stdin:2:3: \"x\" is no number", complaintAbout("1,2\n3,x").c_str());
  STRCMP_EQUAL("stdin:1:2: 1 columns where 2 are needed", complaintAbout("1").c_str());
  STRCMP_EQUAL("stdin:2:2: 1 columns where 2 are needed", complaintAbout("1,2\n3\n").c_str());
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

TEST(NumberRows, ANumberHasOneSign) {
  LONGS_EQUAL(1, read("+1,-2\n").size());
  STRCMP_EQUAL("stdin:1:3: \"+-2\" is no number", complaintAbout("1,+-2\n").c_str());
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
  STRCMP_EQUAL("stdin:1:7: more than 2 columns", complaintAbout("1.,2.,3.\n").c_str());
}

TEST(NumberRows, DecimalCommasAreToldWhereTheyMayBe) {
  STRCMP_EQUAL("stdin:1:7: more than 2 columns; if 16,395 is one number, write 16.395 with a point",
               complaintAbout("1.,16,395,2\n").c_str());
  STRCMP_EQUAL("stdin:1:1: \"37,5\" has a comma: write 37.5 with a point",
               complaintAbout("\"37,5\",2\n").c_str());
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
