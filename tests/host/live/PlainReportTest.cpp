#include "host/live/plain_report.hpp"

#include <cstdlib>
#include <string>

#include "host/base/failure.hpp"
#include "tests/host/live/views.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::live;

TEST_GROUP(PlainReport) {
  std::string printed(TableFormat format, const std::vector<BusView>& buses, bool unicode = true) {
    char* text = nullptr;
    std::size_t size = 0;
    std::FILE* stream = open_memstream(&text, &size);
    PlainReport(stream, format, 1, unicode).print(buses);
    std::fclose(stream);
    const std::string result(text, size);
    std::free(text);
    return result;
  }
};

TEST(PlainReport, IsDueAPeriodAfterTheBeginning) {
  PlainReport report(stdout, TableFormat::kCsv, 0.5, true);
  CHECK_FALSE(report.due(10'000'000).has_value());
  CHECK_FALSE(report.due(10'499'999).has_value());
  LONGS_EQUAL(10'500'000, report.due(10'500'000).value());
  CHECK_FALSE(report.due(10'500'001).has_value());
  LONGS_EQUAL(11'000'000, report.due(11'000'003).value());
}

TEST(PlainReport, AfterAGapItIsDueOnce) {
  PlainReport report(stdout, TableFormat::kCsv, 0.5, true);
  report.due(0);
  LONGS_EQUAL(100'000'000, report.due(100'200'000).value());
  CHECK_FALSE(report.due(100'400'000).has_value());
}

TEST(PlainReport, PrintsALineForEachFinger) {
  FingerView other = touchedFinger();
  other.node = 2;
  const std::string text = printed(TableFormat::kCsv, {busWith({touchedFinger(), other})});
  STRCMP_CONTAINS("can0 node 1  run", text.c_str());
  STRCMP_CONTAINS("\n12.300 s  can0 node 2  run", text.c_str());
}

TEST(PlainReport, WithoutUnicodeALineIsAsciiAlone) {
  STRCMP_CONTAINS("normal 0.282 ± 0.004 N", printed(TableFormat::kCsv, {busWith({touchedFinger()})}).c_str());
  STRCMP_CONTAINS("normal 0.282 +- 0.004 N",
                  printed(TableFormat::kCsv, {busWith({touchedFinger()})}, false).c_str());
}

TEST(PlainReport, SaysThatABusHasNoFinger) {
  STRCMP_EQUAL("12.300 s  can0  no finger heard yet\n", printed(TableFormat::kCsv, {busWith({})}).c_str());
}

TEST(PlainReport, PrintsAnObjectForEachBus) {
  const std::string text = printed(TableFormat::kJson, {busWith({}), busWith({})});
  const std::string one =
      "{\"bus\":\"can0\",\"bus_state\":\"active\",\"time_s\":12.3,\"frames_per_s\":1512,\"load\":0.168,"
      "\"missed\":0,\"fingers\":[]}\n";
  STRCMP_EQUAL((one + one).c_str(), text.c_str());
}

TEST(PlainReport, AStreamThatTakesNoMoreIsAFailure) {
  std::FILE* full = std::fopen("/dev/full", "w");
  bool failed = false;
  try {
    const BusView bus = busWith({touchedFinger()});
    PlainReport(full, TableFormat::kCsv, 1, true).print({&bus, 1});
  } catch (const Failure& failure) {
    failed = failure.code() == ExitCode::kFailure;
  }
  std::fclose(full);
  CHECK_TRUE(failed);
}
