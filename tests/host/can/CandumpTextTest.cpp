#include "host/can/candump_text.hpp"

#include <CppUTest/TestHarness.h>

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <random>
#include <string>
#include <variant>
#include <vector>

using namespace strainfinger;
using namespace strainfinger::can;

// The lines are what candump of can-utils 2020.11 prints (its lib.h and candump.c say how), except where a
// later version is named.
TEST_GROUP(CandumpText) {
  const CanFrame frame_{0x185, 8, {0xE8, 0x03, 0x22, 0x01, 0x1E, 0xFF, 0x01, 0xA3}};

  LogLine read(const std::string& line) {
    const auto parsed = parseLogLine(line);
    const auto* error = std::get_if<LogError>(&parsed);
    if (error != nullptr) FAIL(line.substr(0, 80).append(": ").append(error->reason).c_str());
    return std::get<LogLine>(parsed);
  }

  /// A line with `frame_` from can0.
  LogLine readOurs(const std::string& line) {
    const LogLine parsed = read(line);
    CHECK(classicFrame(parsed) == frame_);
    STRCMP_EQUAL("can0", parsed.interface.c_str());
    return parsed;
  }

  void checkError(std::size_t column, const char* reason, const std::string& line) {
    const auto parsed = parseLogLine(line);
    CHECK_TEXT(std::holds_alternative<LogError>(parsed), line.c_str());
    const auto& error = std::get<LogError>(parsed);
    LONGS_EQUAL_TEXT(column, error.column, line.c_str());
    STRCMP_CONTAINS_TEXT(reason, error.reason.c_str(), line.c_str());
  }

  void checkTime(std::int64_t expected_ns, const LogLine& line) { CHECK(line.time_ns == expected_ns); }
};

TEST(CandumpText, WritesTheLogForm) {
  STRCMP_EQUAL("(1609779922.655421) can0 185#E80322011EFF01A3",
               formatLogLine(1609779922655421, "can0", frame_).c_str());
  STRCMP_EQUAL("(0000000001.000002) vcan0 7FF#", formatLogLine(1000002, "vcan0", {0x7FF, 0, {}}).c_str());
  STRCMP_EQUAL("(0000000000.000000) c 001#0A", formatLogLine(0, "c", {0x001, 1, {0x0A}}).c_str());
}

TEST(CandumpText, WritesFramesOfOtherFormatsAsItReadsThem) {
  for (const char* text :
       {"(0000000001.000000) c 1F334455#1122334455667788", "(0000000001.000000) c 00000123#",
        "(0000000001.000000) c 123#R", "(0000000001.000000) c 00000123#R4",
        "(0000000001.000000) c 123##1112233", "(0000000001.000000) c 1F334455##0"}) {
    const LogLine line = read(text);
    STRCMP_EQUAL(text, formatLogLine(1'000'000, "c", line.frame, line.kind == LineKind::kRemote).c_str());
  }
}

TEST(CandumpText, ReadsTheLogForm) {
  const LogLine line = readOurs("(1609779922.655421) can0 185#E80322011EFF01A3");
  CHECK(line.form == LineForm::kLog);
  CHECK(line.timeForm == TimeForm::kAbsolute);
  CHECK(line.direction == Direction::kUnknown);
  checkTime(1609779922655421000, line);
}

TEST(CandumpText, ReadsNanosecondsOfLaterVersions) {
  checkTime(1609779922655421789, readOurs("(1609779922.655421789) can0 185#E80322011EFF01A3"));
}

TEST(CandumpText, ReadsTheDirectionOfLogs) {
  CHECK(readOurs("(1609779922.655421) can0 185#E80322011EFF01A3 R").direction == Direction::kReceived);
  CHECK(readOurs("(1609779922.655421)  can0 185#E80322011EFF01A3 T").direction == Direction::kSent);
}

TEST(CandumpText, ReadsLowerCaseAndSeparators) {
  readOurs("(1609779922.655421) can0 185#e8.03.2201.1eff.01a3");
}

TEST(CandumpText, ReadsLineEndsOfAnyKind) {
  readOurs("(1609779922.655421) can0 185#E80322011EFF01A3\r");
  readOurs("(1609779922.655421) can0 185#E80322011EFF01A3\r\n");
  readOurs("  can0  185   [8]  E8 03 22 01 1E FF 01 A3\r\n");
}

TEST(CandumpText, PassesOverAByteOrderMark) {
  readOurs("\xEF\xBB\xBF(1609779922.655421) can0 185#E80322011EFF01A3");
  readOurs("\xEF\xBB\xBF  can0  185   [8]  E8 03 22 01 1E FF 01 A3");
  CHECK(read("\xEF\xBB\xBF").kind == LineKind::kNothing);
  checkError(28, "identifier", "\xEF\xBB\xBF(1609779922.655421) can0");
}

TEST(CandumpText, ReadsTheScreenForm) {
  const LogLine line = readOurs("  can0  185   [8]  E8 03 22 01 1E FF 01 A3");
  CHECK(line.form == LineForm::kScreen);
  CHECK(line.timeForm == TimeForm::kNone);
  CHECK_FALSE(line.time_ns.has_value());
}

// As candump -S, -S -a and -S -i print them.
TEST(CandumpText, ReadsBytesInReverseOrder) {
  readOurs("  can0  185   [8]  A3`01`FF`1E`01`22`03`E8");
  readOurs("  can0  185   [8]  A3`01`FF`1E`01`22`03`E8   `.....\"..`");
  readOurs("  can0  185   [8]  10100011`00000001`11111111`00011110`00000001`00100010`00000011`11101000");
}

TEST(CandumpText, ReadsIdentifiersIndentedBesideExtendedOnes) {
  readOurs("  can0       185   [8]  E8 03 22 01 1E FF 01 A3");
}

TEST(CandumpText, ReadsTheTimesOfTheScreenForm) {
  const LogLine absolute = readOurs(" (1609779922.655421)  can0  185   [8]  E8 03 22 01 1E FF 01 A3");
  CHECK(absolute.timeForm == TimeForm::kAbsolute);
  checkTime(1609779922655421000, absolute);
  const LogLine relative = readOurs(" (003.000017)  can0  185   [8]  E8 03 22 01 1E FF 01 A3");
  CHECK(relative.timeForm == TimeForm::kRelative);
  checkTime(3000017000, relative);
}

TEST(CandumpText, ReadsDatesAsLocalTime) {
  setenv("TZ", "CET-1CEST,M3.5.0,M10.5.0/3", 1);
  tzset();
  const LogLine winter = readOurs(" (2021-01-04 18:05:22.655421)  can0  185   [8]  E8 03 22 01 1E FF 01 A3");
  const LogLine summer = readOurs(" (2021-07-04 18:05:22.000000)  can0  185   [8]  E8 03 22 01 1E FF 01 A3");
  unsetenv("TZ");
  tzset();
  CHECK(winter.timeForm == TimeForm::kDate);
  checkTime(1609779922655421000, winter);  // 17:05:22 UTC
  checkTime(1625414722000000000, summer);  // 16:05:22 UTC
}

TEST(CandumpText, ReadsTheColumnsOfExtraInformation) {
  CHECK(readOurs("  can0  RX - -  185   [8]  E8 03 22 01 1E FF 01 A3").direction == Direction::kReceived);
  CHECK(readOurs(" (003.000017)  can0  TX - -  185   [8]  E8 03 22 01 1E FF 01 A3").direction ==
        Direction::kSent);
  const LogLine fd = read("  can0  RX B E  123  [03]  11 22 33");
  LONGS_EQUAL(3, fd.frame.fdFlags);
}

TEST(CandumpText, ReadsDataShownAsText) {
  readOurs("  can0  185   [8]  E8 03 22 01 1E FF 01 A3   '..\".....'");
  CHECK(classicFrame(read("  can0  123   [2]  27 20                     '' '")) ==
        (CanFrame{0x123, 2, {0x27, 0x20}}));
  CHECK(classicFrame(read("  can0  123   [0]                           ''")) == (CanFrame{0x123, 0, {}}));
}

TEST(CandumpText, ReadsDataInBinaryDigits) {
  CHECK(classicFrame(read("  can0  123   [2]  10100101 00000001")) == (CanFrame{0x123, 2, {0xA5, 0x01}}));
}

TEST(CandumpText, ReadsColouredLines) {
  readOurs(" \033[1m\033[34m(003.000017)  can0  185   [8]  E8 03 22 01 1E FF 01 A3\033[0m");
  readOurs("  \033[1m\033[34mcan0\033[0m  185   [8]  E8 03 22 01 1E FF 01 A3");
  readOurs("  \033[1m\033[31mcan0  185   [8]  E8 03 22 01 1E FF 01 A3\033[0m");
}

TEST(CandumpText, ReadsExtendedIdentifiers) {
  for (const char* text : {"(1609779922.655421) can0 00000185#E803", "  can0  00000185   [2]  E8 03"}) {
    const LogLine line = read(text);
    CHECK_TRUE(line.frame.extended);
    LONGS_EQUAL(0x185, line.frame.id);
    LONGS_EQUAL(2, line.frame.length);
    CHECK_FALSE(classicFrame(line).has_value());
  }
  LONGS_EQUAL(0x1FFFFFFF, read("(1609779922.655421) can0 1FFFFFFF#").frame.id);
}

TEST(CandumpText, ReadsRemoteRequests) {
  for (const char* text : {"(1609779922.655421) can0 185#R8", "(1609779922.655421) can0 185#r8 R",
                           "  can0  185   [8]  remote request"}) {
    const LogLine line = read(text);
    CHECK(line.kind == LineKind::kRemote);
    LONGS_EQUAL(8, line.frame.length);
    CHECK_FALSE(classicFrame(line).has_value());
  }
  LONGS_EQUAL(0, read("(1609779922.655421) can0 185#R").frame.length);
}

TEST(CandumpText, ReadsCanFd) {
  const LogLine log = read("(1609779922.655421) can0 185##1E80322011EFF01A3E8");
  CHECK_TRUE(log.frame.fd);
  LONGS_EQUAL(1, log.frame.fdFlags);
  LONGS_EQUAL(9, log.frame.length);
  LONGS_EQUAL(0xE8, log.frame.data[8]);
  CHECK_FALSE(classicFrame(log).has_value());
  const LogLine screen = read("  can0  185  [08]  E8 03 22 01 1E FF 01 A3");
  CHECK_TRUE(screen.frame.fd);
  CHECK_FALSE(classicFrame(screen).has_value());
}

TEST(CandumpText, ReadsTheLargestCanFdFrame) {
  LONGS_EQUAL(64, read(std::string("(1609779922.655421) can0 185##0").append(128, '5')).frame.length);
  std::string screen = "  can0  185  [64] ";
  for (int i = 0; i < 64; ++i) screen.append(" 55");
  LONGS_EQUAL(0x55, read(screen).frame.data[63]);
}

TEST(CandumpText, ReadsErrorFrames) {
  for (const char* text : {"(1609779922.655421) can0 20000080#0000000000000000",
                           "  can0  20000080   [8]  00 00 00 00 00 00 00 00   ERRORFRAME"}) {
    const LogLine line = read(text);
    CHECK(line.kind == LineKind::kError);
    LONGS_EQUAL(0x80, line.frame.id);
    CHECK_FALSE(line.frame.extended);
    CHECK_FALSE(classicFrame(line).has_value());
  }
}

TEST(CandumpText, SkipsExplanationsOfErrorFramesAndBlankLines) {
  for (const char* text : {"\tcontroller-problem{rx-error-warning}", "", "\r\n", "   "})
    CHECK(read(text).kind == LineKind::kNothing);
}

TEST(CandumpText, ReadsDroppedFrames) {
  const LogLine line = read("DROPCOUNT: dropped 12 CAN frames on 'can0' socket (total drops 14)");
  CHECK(line.kind == LineKind::kDropped);
  LONGS_EQUAL(12, line.dropped);
  STRCMP_EQUAL("can0", line.interface.c_str());
  CHECK_FALSE(classicFrame(line).has_value());
}

TEST(CandumpText, ReadsLengthCodesOfLaterVersions) {
  readOurs("(1609779922.655421) can0 185#E80322011EFF01A3_F");
  readOurs("  can0  185   {9}  E8 03 22 01 1E FF 01 A3");
}

TEST(CandumpText, SaysWhichFormItIs) {
  STRCMP_EQUAL("log, absolute time", describeForm(read("(1609779922.655421) can0 185#")).c_str());
  STRCMP_EQUAL("screen, relative time, direction",
               describeForm(read(" (003.000017)  can0  RX - -  185   [0]")).c_str());
  STRCMP_EQUAL("screen, no time", describeForm(read("  can0  185   [0]")).c_str());
}

TEST(CandumpText, SaysWhereATimeIsWrong) {
  checkError(2, "a time", "(x) can0 185#");
  checkError(2, "no such time", "(9223372036.000000) can0 185#");
  checkError(2, "no such time", "(1960-01-04 18:05:22.655421)  can0  185   [0]");
  checkError(2, "no such time", "(2721-01-04 18:05:22.655421)  can0  185   [0]");
  checkError(5, "6 or 9 digits", "(160) can0 185#");
  checkError(6, "6 or 9 digits", "(160.12345) can0 185#");
  checkError(6, "6 or 9 digits", "(160.1234567) can0 185#");
  checkError(12, "')'", "(160.123456 can0 185#");
  checkError(2, "that month is shorter", "(2021-02-31 18:05:22.655421)  can0  185   [0]");
  checkError(2, "a date", "(2021-13-04 18:05:22.655421)  can0  185   [0]");
}

TEST(CandumpText, SaysWhereAnIdentifierIsWrong) {
  checkError(20, "an interface", "(1609779922.655421)");
  checkError(1, "an interface before the frame", "185#E803");
  checkError(21, "an interface before the frame", "(1609779922.655421) 185#E803");
  checkError(25, "3 or 8", "(1609779922.655421) can0");
  checkError(26, "3 or 8", "(1609779922.655421) can0 85#00");
  checkError(26, "3 or 8", "(1609779922.655421) can0 0185#00");
  checkError(26, "3 or 8", "(1609779922.655421) can0 123456789#00");
  checkError(26, "no such identifier", "(1609779922.655421) can0 800#00");
  checkError(26, "no such identifier", "(1609779922.655421) can0 80000185#00");
  checkError(29, "'#'", "(1609779922.655421) can0 185:#00");
}

TEST(CandumpText, SaysWhereDataIsWrong) {
  checkError(30, "two hexadecimal digits", "(1609779922.655421) can0 185#E");
  checkError(32, "two hexadecimal digits", "(1609779922.655421) can0 185#E8x3");
  checkError(46, "more data", "(1609779922.655421) can0 185#E80322011EFF01A300");
  checkError(160, "more data", std::string("(1609779922.655421) can0 185##0").append(130, '5'));
  checkError(31, "flags", "(1609779922.655421) can0 185##");
  checkError(47, "unexpected", "(1609779922.655421) can0 185#E80322011EFF01A3 X");
  checkError(46, "length code", "(1609779922.655421) can0 185#E80322011EFF01A3_8");
  checkError(32, "length code", "(1609779922.655421) can0 185#E8_9");
  checkError(35, "no remote request", "(1609779922.655421) can0 20000080#R");
  checkError(31, "data", "(1609779922.655421) can0 185#R9");
}

TEST(CandumpText, SaysWhereTheScreenFormIsWrong) {
  checkError(15, "the length", "  can0  185   E8");
  checkError(16, "[0] to [8]", "  can0  185   [9]  E8");
  checkError(16, "FD [00] to [64]", "  can0  185   [65]  E8");
  checkError(16, "CAN XL", "  can0  185   [0003]  11 22 33");
  checkError(22, "two hexadecimal digits", "  can0  185   [2]  E8");
  checkError(24, "two hexadecimal digits", "  can0  185   [2]  E8  0");
  checkError(22, "blank", "  can0  185   [2]  E803");
  checkError(23, "unexpected", "  can0  185   [1]  E8 03");
  checkError(24, "as text", "  can0  185   [1]  E8  'ab'");
  checkError(25, "same mark", "  can0  185   [3]  22`03 E8");
  checkError(26, "same mark", "  can0  185   [3]  22 03`E8");
  checkError(12, "-x", "  can0  RX X -  185   [1]  E8");
}

TEST(CandumpText, SaysWhereADropCountIsWrong) {
  checkError(20, "number", "DROPCOUNT: dropped CAN frames");
  checkError(20, "4294967295", "DROPCOUNT: dropped 4294967296 CAN frames on 'can0' socket");
  checkError(21, "interface", "DROPCOUNT: dropped 1 CAN frame on 'can0");
}

// A terminal obeys them: they could hide or rewrite what is shown.
TEST(CandumpText, AnInterfaceOfOtherThanPrintableAsciiIsRefused) {
  constexpr const char* kWhy = "an interface's name has printable ASCII characters only";
  for (const char* bad : {"\a", "\x01", "\x7F", "\xC2\x9B", "\xFF", "\xC3\xA4"}) {
    const std::string name = std::string("ca") + bad + "n0";
    checkError(23, kWhy, "(1609779922.655421) " + name + " 185#E803");
    checkError(5, kWhy, "  " + name + "  185   [2]  E8 03");
    checkError(38, kWhy, "DROPCOUNT: dropped 1 CAN frame on 'ca" + std::string(bad) + "' socket");
    CHECK_FALSE(parsePlainLine("(1609779922.655421) " + name + " 185#E803").has_value());
  }
  checkError(38, kWhy, "DROPCOUNT: dropped 1 CAN frame on 'ca\033[2Jn0' socket");
}

TEST(CandumpText, WhatIsWrittenReadsBack) {
  const unsigned seed = std::random_device{}();
  std::printf("seed %u ", seed);
  std::mt19937 random(seed);
  for (int i = 0; i < 10000; ++i) {
    CanFrame frame{static_cast<std::uint16_t>(random() % 0x800), static_cast<std::uint8_t>(random() % 9), {}};
    for (std::size_t k = 0; k < frame.length; ++k) frame.data[k] = static_cast<std::uint8_t>(random());
    const std::int64_t time_us = static_cast<std::int64_t>(random()) * 1999 + 1;
    const LogLine line = read(formatLogLine(time_us, "vcan0", frame));
    CHECK(classicFrame(line) == frame);
    CHECK(line.time_ns == time_us * 1000);
  }
}

TEST(CandumpText, WhatIsWrittenIsPlain) {
  const auto plain = parsePlainLine("(1609779922.655421) can0 185#E80322011EFF01A3");
  CHECK(plain->frame == frame_);
  CHECK(plain->time_ns == 1609779922655421000);
  CHECK(plain->interface == "can0");
  CHECK(parsePlainLine(formatLogLine(0, "c", {0x001, 1, {0x0A}})).has_value());
  CHECK(parsePlainLine(formatLogLine(1000002, "vcan0", {0x7FF, 0, {}})).has_value());
}

TEST(CandumpText, OtherLinesAreNotPlain) {
  for (const char* line :
       {"", "(", "(1609779922.655421) ", "(1609779922.655421) can0", "(1609779922.655421) can0 ",
        "(1609779922.655421) can0 185", "(1609779922.655421) can0 185#E", "(1609779922.655421) can0 185#E8x3",
        "(1609779922.655421) can0 185##1E8", "(1609779922.655421) can0 185#R8",
        "(1609779922.655421) can0 00000185#", "(1609779922.655421) can0 800#00",
        "(1609779922.655421) can0 185#E80322011EFF01A300", "(1609779922.655421)  can0 185#00",
        "(9223372036.000000) can0 185#", "(1609779922.655421) ca\x7F 185#00", "  can0  185   [2]  E8 03"})
    CHECK_FALSE_TEXT(parsePlainLine(line).has_value(), line);
}

// Bytes of the alphabet that the forms are made of, so that the parser gets deep, spliced into good lines: it
// must say something about each line, at a column within it, and no sanitizer may complain.
TEST(CandumpText, AnyBytesAreReadOrRefused) {
  const unsigned seed = std::random_device{}();
  std::printf("seed %u ", seed);
  std::mt19937 random(seed);
  const std::vector<std::string> seeds{
      "(1609779922.655421) can0 185#E80322011EFF01A3 R",
      " (2021-01-04 18:05:22.655421)  can0  RX - -  12345678  [08]  E8 03 22 01",
      "  can0  185   [8]  E8 03 22 01 1E FF 01 A3   '........'",
      "DROPCOUNT: dropped 12 CAN frames on 'can0' socket (total drops 14)",
      "(1609779922.655421) can0 185##1E80322011EFF01A3E8",
      ""};
  const std::string alphabet = "0123456789ABCDEFabcdefRT#[](){}. -_:'`\t\r\n\033m\177\377";
  for (int i = 0; i < 100000; ++i) {
    std::string line = seeds[random() % seeds.size()];
    for (auto edits = random() % 6; edits > 0; --edits) {
      const char c = random() % 8 == 0 ? static_cast<char>(random()) : alphabet[random() % alphabet.size()];
      line.insert(random() % (line.size() + 1), 1, c);
      if (random() % 3 == 0) line.erase(random() % line.size(), random() % 9);
    }
    const auto parsed = parseLogLine(line);
    if (const auto plain = parsePlainLine(line)) {
      const LogLine whole = std::get<LogLine>(parsed);
      CHECK(plain->frame == classicFrame(whole) && plain->time_ns == whole.time_ns);
      CHECK(plain->interface == whole.interface);
    }
    if (const auto* error = std::get_if<LogError>(&parsed))
      CHECK(error->column >= 1 && error->column <= line.size() + 1 && !error->reason.empty());
    else
      CHECK(std::get<LogLine>(parsed).frame.length <= 64);
  }
}
