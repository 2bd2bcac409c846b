#include "firmware/app/slcan.hpp"

#include <random>
#include <string>

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::firmware;
using Kind = SlcanCommand::Kind;

TEST_GROUP(Slcan) {
  static std::string textOf(const CanFrame& frame) { return std::string(slcanFrame(frame).view()); }
  static Kind kindOf(std::string_view line) { return slcanCommand(line).kind; }

  static std::string stateOf(hal::CanState state, std::uint8_t tx, std::uint8_t rx) {
    return std::string(slcanState({.state = state, .txErrors = tx, .rxErrors = rx}).view());
  }

  SlcanReader reader;
  /// The lines that the reader makes of a text, each with | behind it.
  std::string linesOf(std::string_view text) {
    std::string lines;
    for (const char character : text)
      if (const auto line = reader.take(character)) lines.append(*line).push_back('|');
    return lines;
  }
};

// Lines as Linux's driver makes and takes them (slc_encaps, slc_bump).
TEST(Slcan, AFrameIsALineOfHexDigits) {
  STRCMP_EQUAL("t1234DEADBEEF\r", textOf({0x123, 4, {0xDE, 0xAD, 0xBE, 0xEF}}).c_str());
  STRCMP_EQUAL("t7FF80011223344556677\r",
               textOf({0x7FF, 8, {0x00, 0x11, 0x22, 0x33, 0x44, 0x55, 0x66, 0x77}}).c_str());
  STRCMP_EQUAL("t0000\r", textOf({0, 0, {1, 2}}).c_str());
}

TEST(Slcan, ALineOfAFrameIsUnderstood) {
  const SlcanCommand command = slcanCommand("t6012a5C3");
  CHECK_TRUE(command.kind == Kind::kFrame);
  CHECK_TRUE(command.frame == (CanFrame{0x601, 2, {0xA5, 0xC3}}));
}

TEST(Slcan, EveryIdentifierAndLengthComesBack) {
  for (std::uint16_t id = 0; id <= kMaxCanId; ++id) {
    CanFrame frame{id, static_cast<std::uint8_t>(id % 9), {}};
    for (std::size_t i = 0; i < frame.length; ++i) frame.data[i] = static_cast<std::uint8_t>(id * 7 + i * 31);
    const std::string text = textOf(frame);
    CHECK_TRUE(slcanCommand(text.substr(0, text.size() - 1)).frame == frame);
  }
}

TEST(Slcan, LinesThatAreNoFrameAreUnknown) {
  for (const char* line : {"t", "t123", "t12G0", "t1239", "t123A", "t12311", "t12310", "t1231123", "t1231GG",
                           "t8000", "tFFF0", "t-010", "T000001230", "r1230", "R000001230", "t123 0"})
    CHECK_TRUE_TEXT(kindOf(line) == Kind::kUnknown, line);
}

TEST(Slcan, CommandsAreUnderstood) {
  CHECK_TRUE(kindOf("O") == Kind::kOpen);
  CHECK_TRUE(kindOf("C") == Kind::kClose);
  CHECK_TRUE(kindOf("S0") == Kind::kBitRate);
  CHECK_TRUE(kindOf("S8") == Kind::kBitRate);
  CHECK_TRUE(kindOf("V") == Kind::kVersion);
  CHECK_TRUE(kindOf("N") == Kind::kSerial);
  CHECK_TRUE(kindOf("F") == Kind::kFlags);
  CHECK_TRUE(kindOf("") == Kind::kNothing);
}

TEST(Slcan, OtherCommandsAreUnknown) {
  for (const char* line : {"S", "S9", "S88", "OO", "o", "C1", "X", "\x80", "\n"})
    CHECK_TRUE_TEXT(kindOf(line) == Kind::kUnknown, line);
}

TEST(Slcan, EveryCommandIsAnswered) {
  for (const Kind kind : {Kind::kNothing, Kind::kOpen, Kind::kClose, Kind::kBitRate})
    CHECK_TRUE(slcanAnswer(kind) == "\r");
  CHECK_TRUE(slcanAnswer(Kind::kFrame) == "z\r");
  CHECK_TRUE(slcanAnswer(Kind::kUnknown) == "\a");
  CHECK_TRUE(slcanAnswer(Kind::kVersion) == "V1013\r");
  CHECK_TRUE(slcanAnswer(Kind::kSerial) == "N0001\r");
  CHECK_TRUE(slcanAnswer(Kind::kFlags) == "F00\r");
}

// What the driver parses: slc_bump_state takes a letter, 3 digits received, 3 digits sent.
TEST(Slcan, TheBusStateIsALine) {
  STRCMP_EQUAL("sa000000\r", stateOf(hal::CanState::kActive, 0, 0).c_str());
  STRCMP_EQUAL("sw097008\r", stateOf(hal::CanState::kWarning, 8, 97).c_str());
  STRCMP_EQUAL("sp130255\r", stateOf(hal::CanState::kPassive, 255, 130).c_str());
  STRCMP_EQUAL("sb000255\r", stateOf(hal::CanState::kBusOff, 255, 0).c_str());
  STRCMP_EQUAL("", stateOf(hal::CanState::kDown, 0, 0).c_str());
}

TEST(Slcan, CountersThatAreNotKnownAreZero) {
  CHECK_TRUE(slcanState({.state = hal::CanState::kActive}).view() == "sa000000\r");
}

TEST(Slcan, LinesArePutTogether) {
  STRCMP_EQUAL("O|", linesOf("O\r").c_str());
  STRCMP_EQUAL("||t1000|C|", linesOf("\r\rt1000\rC\r").c_str());
  STRCMP_EQUAL("", linesOf("S").c_str());
  STRCMP_EQUAL("S8|", linesOf("8\r").c_str());
}

TEST(Slcan, ALineThatIsTooLongIsUnknownAndTheNextIsNot) {
  const std::string lines = linesOf("t1238001122334455667788\rO\r");
  STRCMP_EQUAL("t123800112233445566778|O|", lines.c_str());
  CHECK_TRUE(kindOf("t123800112233445566778") == Kind::kUnknown);
}

TEST(Slcan, AnyTextIsUnderstoodOrRefused) {
  constexpr unsigned kSeed = 20240607;
  std::mt19937 random(kSeed);
  const std::string letters = "tTrRsOCSVNF0189aAfF\r\n\x80";
  for (int i = 0; i < 200000; ++i) {
    const auto line = reader.take(letters[random() % letters.size()]);
    if (line && slcanCommand(*line).kind == Kind::kFrame) CHECK_TRUE(isValid(slcanCommand(*line).frame));
  }
}
