#include "host/base/table_writer.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "host/base/failure.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;

TEST_GROUP(TableWriter) {
  char* text = nullptr;
  std::size_t size = 0;
  std::FILE* stream = open_memstream(&text, &size);

  void teardown() override {
    std::fclose(stream);
    std::free(text);
  }
  std::string written() {
    std::fflush(stream);
    return {text, size};
  }
  void checkWritten(const std::string& expected) { STRCMP_EQUAL(expected.c_str(), written().c_str()); }
};

TEST(TableWriter, CsvBeginsWithItsHeaderEvenWithoutRows) {
  TableWriter(stream, TableFormat::kCsv, {"angle_deg", "err"});
  checkWritten("angle_deg,err\n");
}

TEST(TableWriter, CsvRowsHoldNumbersAndText) {
  TableWriter table(stream, TableFormat::kCsv, {"n", "x", "name"});
  table.row({std::int64_t{-7}, 0.5, "hoop"});
  checkWritten("n,x,name\n-7,0.5,hoop\n");
}

TEST(TableWriter, ARowHasACellForEachColumn) {
  for (const TableFormat format : {TableFormat::kCsv, TableFormat::kJson}) {
    TableWriter table(stream, format, {"a", "b"});
    CHECK_THROWS(std::logic_error, table.row({1.0}));
    CHECK_THROWS(std::logic_error, table.row({1.0, 2.0, 3.0}));
  }
}

TEST(TableWriter, ARowOfNamedCellsHasItsOwnColumns) {
  const NamedRow row{{"n", std::int64_t{-7}}, {"name", "hoop"}};
  TableWriter(stream, TableFormat::kCsv, columnsOf(row)).row(valuesOf(row));
  checkWritten("n,name\n-7,hoop\n");
}

TEST(TableWriter, AListIsOneFieldOrAnArray) {
  const std::vector<Cell> row{std::vector<double>{0, 22.5, 4.1e-5}, std::vector<double>{}};
  TableWriter(stream, TableFormat::kCsv, {"a", "b"}).row(row);
  TableWriter(stream, TableFormat::kJson, {"a", "b"}).row(row);
  checkWritten("a,b\n\"[0, 22.5, 4.1e-05]\",[]\n{\"a\":[0.0,22.5,4.1e-05],\"b\":[]}\n");
}

TEST(TableWriter, TextThatWouldBreakARowIsQuoted) {
  TableWriter table(stream, TableFormat::kCsv, {"a", "b", "c"});
  table.row({"x,y", "say \"no\"", "two\nlines"});
  checkWritten("a,b,c\n\"x,y\",\"say \"\"no\"\"\",\"two\nlines\"\n");
}

TEST(TableWriter, RealNumbersReadBackExactly) {
  TableWriter table(stream, TableFormat::kCsv, {"x"});
  const double values[] = {0.1, 1.0 / 3, -4.60603e-4, 5e-324, std::numeric_limits<double>::max(), -0.0};
  for (const double value : values) table.row({value});
  const std::string lines = written();
  const char* next = lines.c_str() + 2;
  for (const double value : values) {
    char* end = nullptr;
    CHECK_EQUAL(value, std::strtod(next, &end));
    next = end + 1;
  }
}

TEST(TableWriter, WhatIsNotKnownIsEmptyInCsvAndNullInJson) {
  TableWriter(stream, TableFormat::kCsv, {"a", "b"}).row({std::nan(""), std::int64_t{1}});
  TableWriter(stream, TableFormat::kJson, {"a", "b"}).row({std::nan(""), std::int64_t{1}});
  checkWritten("a,b\n,1\n{\"a\":null,\"b\":1}\n");
}

TEST(TableWriter, JsonHasOneObjectALineInTheOrderOfTheColumns) {
  TableWriter table(stream, TableFormat::kJson, {"z", "a"});
  table.row({0.5, "q\"\n"});
  table.row({std::int64_t{2}, ""});
  checkWritten("{\"z\":0.5,\"a\":\"q\\\"\\n\"}\n{\"z\":2,\"a\":\"\"}\n");
}

TEST(TableWriter, JsonStaysReadableWhenTextIsNotUtf8) {
  TableWriter(stream, TableFormat::kJson, {"name"}).row({"\xff"});
  STRCMP_EQUAL("\xef\xbf\xbd", nlohmann::json::parse(written())["name"].get<std::string>().c_str());
}

TEST(TableWriter, AStreamThatRefusesEndsTheProgramWithAFailure) {
  std::FILE* full = std::fopen("/dev/full", "w");
  std::setvbuf(full, nullptr, _IONBF, 0);
  CHECK_THROWS(Failure, TableWriter(full, TableFormat::kCsv, {"a"}));
  std::fclose(full);
}
