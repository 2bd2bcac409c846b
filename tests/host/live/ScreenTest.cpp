#include "host/live/screen.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "host/live/value_text.hpp"
#include "tests/host/live/views.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::live;

TEST_GROUP(Screen) {
  std::vector<std::string> drawn(const ScreenContent& content, const ScreenForm& form = {}) {
    const auto lines = drawScreen(content, form).lines(false);
    LONGS_EQUAL(form.rows, lines.size());
    return lines;
  }
  std::string text(const ScreenContent& content, const ScreenForm& form = {}) {
    std::string text;
    for (const std::string& line : drawn(content, form)) text += line + "\n";
    return text;
  }
  std::string textOf(const FingerView& finger, const ScreenForm& form = {}) {
    return text({.buses = {busWith({finger})}}, form);
  }
};

TEST(Screen, ABusWithoutFingersSaysSo) {
  STRCMP_CONTAINS("no finger heard yet", text({.buses = {busWith({})}}).c_str());
}

TEST(Screen, TheBusHasItsLoad) {
  STRCMP_EQUAL("can0  1512 frames/s  load 16.8 %", drawn({.buses = {busWith({})}})[0].c_str());
}

TEST(Screen, AFingerHasItsNumbersWithTheirSigmas) {
  const std::string shown = textOf(touchedFinger());
  for (const char* part :
       {"node 1  run  up 1:02:03  25 degC  stale zero, simulated", "angle      0.00 ± 0.50 deg",
        "normal     0.282 ± 0.004 N", "tangential -0.100 ± 0.003 N", "width      2.04 ± 0.15 mm",
        "quality 97 %", "500 contacts/s  jitter 0.2 ms  2 lost  zero 0:01:01 old"})
    STRCMP_CONTAINS(part, shown.c_str());
}

TEST(Screen, TheDialShowsWhere) {
  FingerView finger = touchedFinger();
  const auto glyphAt = [&](int row, std::size_t column) {
    const std::string line =
        drawn({.buses = {busWith({finger})}}, {.unicode = false})[static_cast<std::size_t>(row)];
    return column < line.size() ? line[column] : ' ';
  };
  LONGS_EQUAL('@', glyphAt(6, 15));  // 0 deg: the right end of the dial's middle row
  LONGS_EQUAL('+', glyphAt(6, 9));   // its centre
  finger.touch->angle_deg = 90;
  LONGS_EQUAL('@', glyphAt(3, 9));
  finger.touch->angle_deg = 180;
  LONGS_EQUAL('@', glyphAt(6, 3));
  finger.touch->angle_deg = 270;
  LONGS_EQUAL('@', glyphAt(9, 9));
}

TEST(Screen, TheDialShowsWhatElseItMayBe) {
  FingerView finger = touchedFinger();
  finger.touch->sigmaAngle_deg = 60;
  const auto lines = drawn({.buses = {busWith({finger})}}, {.unicode = false});
  CHECK_TRUE(lines[4].substr(0, 17).find('o') != std::string::npos);  // 60 deg
  CHECK_TRUE(lines[8].substr(0, 17).find('o') != std::string::npos);  // -60 deg
  CHECK_TRUE(lines[6][3] == '.');                                     // not 180 deg
}

TEST(Screen, ABarIsAsLongAsItsForce) {
  const ScreenForm form{.columns = 100, .unicode = false};
  const auto barOf = [&](double normal_n) {
    FingerView finger = touchedFinger();
    finger.strongest_n = 1;
    finger.touch->normal_n = normal_n;
    finger.touch->sigmaNormal_n = 0;
    const std::string line = drawn({.buses = {busWith({finger})}}, form)[4];
    return std::count(line.begin(), line.end(), '#') + std::count(line.begin(), line.end(), '~');
  };
  LONGS_EQUAL(20, barOf(0.5));  // of 40 places from 0 to 1 N, the first of which is the zero's mark
  LONGS_EQUAL(39, barOf(1));
}

TEST(Screen, AForceThatIsNotKnownHasNoBar) {
  FingerView finger = touchedFinger();
  finger.touch->normal_n = finger.touch->tangential_n = kNoValue;
  const std::string shown = textOf(finger, {.unicode = false});
  STRCMP_CONTAINS("normal     ?\n", (shown.substr(0, shown.find("normal     ?") + 12) + "\n").c_str());
  CHECK_TRUE(shown.find('#') == std::string::npos);
}

TEST(Screen, ASecondContactIsShown) {
  FingerView finger = touchedFinger();
  finger.touch->second = can::ContactReport{.angle_deg = 180, .sigmaAngle_deg = 3, .normal_n = 0.41};
  const auto lines = drawn({.buses = {busWith({finger})}}, {.unicode = false});
  STRCMP_CONTAINS("second %   180.00 +- 3.00 deg  0.410 +- ? N", lines[7].c_str());
  LONGS_EQUAL('%', lines[6][3]);
  LONGS_EQUAL('@', lines[6][15]);
}

TEST(Screen, FaultsAndGaugesStandInWords) {
  FingerView finger = touchedFinger();
  finger.heartbeat.faults = {FingerFault::kGauges, FingerFault::kWatchdogReset};
  finger.gauges->out_of_use = 0xA0;
  STRCMP_CONTAINS("faults: gauges, watchdog reset; gauges out of use: 5, 7", textOf(finger).c_str());
}

TEST(Screen, ForProgramsTroublesSayWhatIsWrongWithTheFinger) {
  FingerView finger = touchedFinger();
  CHECK_TRUE(troublesOf(finger).empty());
  finger.heartbeat.faults = {FingerFault::kTables};
  finger.gauges->out_of_use = 0x20;
  const auto troubles = troublesOf(finger);
  LONGS_EQUAL(2, troubles.size());
  STRCMP_EQUAL("fault tables: The lookup tables are absent, damaged or of another finger",
               troubles[0].c_str());
  STRCMP_EQUAL("gauges out of use: 5", troubles[1].c_str());
}

TEST(Screen, ThePickedFingerIsShownHoweverLowTheWindow) {
  std::vector<FingerView> fingers(6, touchedFinger());
  for (std::size_t i = 0; i < fingers.size(); ++i) fingers[i].node = static_cast<std::uint8_t>(i + 1);
  for (std::size_t picked = 0; picked < fingers.size(); ++picked) {
    const auto lines =
        drawn({.buses = {busWith(fingers)}, .selected = picked}, {.rows = 5, .unicode = false});
    const std::string mark = fmt::format("> node {}", picked + 1);
    CHECK_TRUE(std::ranges::any_of(lines, [&](const std::string& line) { return line.starts_with(mark); }));
    STRCMP_CONTAINS("4 more rows", lines.back().c_str());
  }
}

TEST(Screen, ATwinIsSaidToBeThere) {
  FingerView finger = touchedFinger();
  finger.hasTwin = true;
  STRCMP_CONTAINS("two fingers have this node number", textOf(finger).c_str());
}

TEST(Screen, TablesOfAnotherConfigAreSaidToBeThat) {
  FingerView finger = touchedFinger();
  finger.hasOtherTables = true;
  STRCMP_CONTAINS("its tables are not those of the config (-c)", textOf(finger, {.columns = 120}).c_str());
}

TEST(Screen, WarningsGoOnInRowsThatAreLeft) {
  FingerView finger = touchedFinger();
  finger.hasTwin = true;
  const auto lines = drawn({.buses = {busWith({finger})}});
  STRCMP_CONTAINS("two fingers have this node number: take one off the bus;", lines[8].c_str());
  STRCMP_CONTAINS("from its next start on", lines[10].c_str());
  STRCMP_CONTAINS("500 contacts/s", lines[11].c_str());
}

TEST(Screen, WarningsTakeNoOtherFingersRows) {
  FingerView finger = touchedFinger();
  finger.hasTwin = true;
  const auto lines = drawn({.buses = {busWith({finger, finger})}}, {.rows = 22, .unicode = false});
  STRCMP_CONTAINS("take one off the bus;", lines[8].c_str());
  LONGS_EQUAL('>', lines[9].back());  // of one spare row
  STRCMP_CONTAINS("500 contacts/s", lines[10].c_str());
  STRCMP_CONTAINS("node 1  run", lines[12].c_str());
  LONGS_EQUAL('>', lines[18].back());
  STRCMP_CONTAINS("500 contacts/s", lines[19].c_str());
}

TEST(Screen, TheQualityIsWholeInANarrowWindow) {
  FingerView finger = touchedFinger();
  finger.touch->quality_percent = 100;
  STRCMP_CONTAINS("quality 100 %", textOf(finger, {.rows = 20, .columns = 60}).c_str());
}

TEST(Screen, ASilentFingerIsSaidToBeSilent) {
  FingerView finger = touchedFinger();
  finger.touch.reset();
  finger.silence_us = 2'300'000;
  STRCMP_CONTAINS("node 1  silent", textOf(finger).c_str());
  STRCMP_CONTAINS("silent for 2.3 s", textOf(finger).c_str());
  STRCMP_CONTAINS("no touch known", textOf(finger).c_str());
}

TEST(Screen, AFingerOfAnotherProtocolIsSaidToBeThat) {
  FingerView finger = touchedFinger();
  finger.heartbeat.protocol = 9;
  STRCMP_CONTAINS("speaks protocol 9", textOf(finger, {.columns = 120}).c_str());
}

TEST(Screen, AReleasedFingerShowsNoNumbers) {
  FingerView finger = touchedFinger();
  finger.touch->flags = {};
  const std::string shown = textOf(finger);
  STRCMP_CONTAINS("nothing touches it", shown.c_str());
  CHECK_TRUE(shown.find("0.282") == std::string::npos);
}

TEST(Screen, WithLittleRoomAFingerHasAllItsNumbers) {
  FingerView finger = touchedFinger();
  finger.touch->second =
      can::ContactReport{.angle_deg = 180, .sigmaAngle_deg = 3, .normal_n = 0.41, .sigmaNormal_n = 0.01};
  finger.heartbeat.faults = {FingerFault::kSamples};
  const auto lines = drawn({.buses = {busWith({finger, touchedFinger()})}}, {.rows = 20});
  STRCMP_EQUAL("▸ node 1  run  0.00 ± 0.50 deg  normal 0.282 ± 0.004 N  stale zero, simulated",
               lines[2].c_str());
  STRCMP_EQUAL("    tangential -0.100 ± 0.003 N  width 2.04 ± 0.15 mm  quality 97 %", lines[3].c_str());
  STRCMP_EQUAL("    second 180.00 ± 3.00 deg  0.410 ± 0.010 N  ?  faults: samples", lines[4].c_str());
  STRCMP_CONTAINS("  node 1  run", lines[5].c_str());
}

TEST(Screen, WhatIsCutOffEndsInAMark) {
  const auto rowAt = [&](int columns) {
    return drawn({.buses = {busWith({touchedFinger()})}}, {.rows = 7, .columns = columns})[3];
  };
  const int whole = 67;  // columns
  STRCMP_EQUAL("    tangential -0.100 ± 0.003 N  width …", rowAt(40).c_str());
  STRCMP_EQUAL("    tangential -0.100 ± 0.003 N  width 2.04 ± 0.15 mm  quality 97…",
               rowAt(whole - 1).c_str());
}

TEST(Screen, WhatFitsExactlyHasNoMark) {
  FingerView finger = touchedFinger();
  finger.touch->flags = FingerFlags{FingerFlag::kContact};
  const std::string whole = "  node 1  run  0.00 ± 0.50 deg  normal 0.282 ± 0.004 N";
  const ScreenForm exact{.rows = 4, .columns = static_cast<int>(whole.size()) - 2};  // of 2 bytes a sign
  STRCMP_CONTAINS("normal 0.282 ± 0.004 …", drawn({.buses = {busWith({finger})}}, exact)[2].c_str());
  finger.touch->tangential_n = finger.touch->sigmaTangential_n = kNoValue;
  STRCMP_EQUAL(whole.c_str(),
               drawn({.buses = {busWith({finger})}}, {.rows = 6, .columns = exact.columns})[2].c_str());
}

TEST(Screen, ARowOfAFingerBeginsWithWhatIsWrong) {
  FingerView finger = touchedFinger();
  finger.heartbeat.faults = {FingerFault::kGauges};
  finger.touch->flags.set(FingerFlag::kUncertain, true);
  const std::vector<FingerView> fingers(8, finger);
  STRCMP_CONTAINS("node 1  run  faults: gauges  uncertain, stale zero, simulated  0.00 ± 0.50 deg",
                  drawn({.buses = {busWith(fingers)}}, {.rows = 24, .columns = 90})[2].c_str());
}

TEST(Screen, AnotherAngleThatFitsAsWellIsTold) {
  FingerView finger = touchedFinger();
  finger.touch->angle_deg = 350;
  finger.touch->alternative_deg = 20;
  finger.touch->quality_percent = 20;
  STRCMP_CONTAINS("quality 20 % or at 10 deg", textOf(finger).c_str());
  STRCMP_CONTAINS("quality 20 % or at 10 deg", textOf(finger, {.rows = 7}).c_str());
}

TEST(Screen, AMessageStandsBeforeTheKeys) {
  const auto lines = drawn({.buses = {busWith({})}, .message = "node 1: tare: Done", .keys = "q quit"});
  STRCMP_EQUAL("node 1: tare: Done  q quit", lines.back().c_str());
}

TEST(Screen, WithoutRoomAFingerIsALine) {
  FingerView other = touchedFinger();
  other.node = 2;
  const auto lines =
      drawn({.buses = {busWith({touchedFinger(), other})}, .selected = 1}, {.rows = 8, .columns = 120});
  STRCMP_CONTAINS("  node 1  run  stale zero, simulated  0.00 ± 0.50 deg  normal 0.282", lines[2].c_str());
  STRCMP_CONTAINS("▸ node 2  run", lines[3].c_str());
}

TEST(Screen, WhatHasNoRoomIsCounted) {
  std::vector<FingerView> fingers(10, touchedFinger());
  STRCMP_CONTAINS("7 more rows: make the window higher",
                  text({.buses = {busWith(fingers)}, .keys = "q quit"}, {.rows = 6}).c_str());
}

TEST(Screen, EveryBusIsShown) {
  BusView other = busWith({touchedFinger()});
  other.name = "can1";
  const auto lines = drawn({.buses = {busWith({touchedFinger()}), other}});
  STRCMP_CONTAINS("can0", lines[0].c_str());
  STRCMP_CONTAINS("can1", lines[11].c_str());
}

TEST(Screen, NoWindowIsTooSmallAndNoneIsLeft) {
  const ScreenContent content{
      .buses = {busWith({touchedFinger(), touchedFinger()})}, .message = "m", .keys = "q"};
  for (const int rows : {1, 2, 3, 21, 22, 200})
    for (const int columns : {1, 19, 49, 50, 60, 79, 400}) {
      const auto lines = drawn(content, {.rows = rows, .columns = columns, .unicode = false});
      CHECK_COMPARE(lines.size(), <=, static_cast<std::size_t>(rows));
      for (const std::string& line : lines) CHECK_COMPARE(line.size(), <=, static_cast<std::size_t>(columns));
    }
}

TEST(Screen, AsciiIsAsciiAlone) {
  const std::string shown = textOf(touchedFinger(), {.unicode = false});
  CHECK_TRUE(std::all_of(shown.begin(), shown.end(), [](char c) { return c >= '\n' && c < 0x7F; }));
  STRCMP_CONTAINS("0.282 +- 0.004 N", shown.c_str());
}

TEST_GROUP(ValueText) {};

TEST(ValueText, WhatIsNotKnownIsAQuestionMark) {
  STRCMP_EQUAL("?", measured({kNoValue}, {1}, 2, "N").c_str());
  STRCMP_EQUAL("1.00 ± ? N", measured({1}, {kNoValue}, 2, "N").c_str());
  STRCMP_EQUAL("?", durationText(0xFFFF).c_str());
}

TEST(ValueText, TheLargestThatAFingerCanSayIsThatOrMore) {
  can::TouchReport touch = *touchedFinger().touch;
  touch.sigmaAngle_deg = 655.34;
  touch.sigmaNormal_n = touch.sigmaTangential_n = 0.127;
  touch.width_m = touch.sigmaWidth_m = 0.065534;
  STRCMP_EQUAL("0.00 ± >=655.34 deg", angleText(touch).c_str());
  STRCMP_EQUAL("0.282 ± >=0.127 N", normalText(touch).c_str());
  STRCMP_EQUAL("-0.100 ± >=0.127 N", tangentialText(touch).c_str());
  STRCMP_EQUAL(">=65.53 ± >=65.53 mm", widthText(touch).c_str());
  STRCMP_EQUAL(">=18:12:14", durationText(0xFFFE).c_str());
  touch.tangential_n = -32.767;
  STRCMP_EQUAL("<=-32.767 ± >=0.127 N", tangentialText(touch).c_str());
  touch.sigmaNormal_n = 0.1265;
  STRCMP_EQUAL("0.282 ± 0.127 N", normalText(touch).c_str());
}

TEST(ValueText, APlainLineHasItAll) {
  STRCMP_EQUAL(
      "12.300 s  can0 node 1  run  angle 0.00 ± 0.50 deg  normal 0.282 ± 0.004 N  tangential -0.100 ± 0.003 "
      "N  width 2.04 ± 0.15 mm  500 contacts/s  2 lost  stale zero, simulated",
      plainLine(busWith({}), touchedFinger()).c_str());
}

TEST(ValueText, APlainLineOfASilentFingerSaysSo) {
  FingerView finger = touchedFinger();
  finger.touch.reset();
  finger.silence_us = 1'000'000;
  STRCMP_EQUAL("12.300 s  can0 node 1  silent  no touch known  500 contacts/s  2 lost  silent for 1.0 s",
               plainLine(busWith({}), finger).c_str());
}
