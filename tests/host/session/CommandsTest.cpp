#include "host/session/commands.hpp"

#include <fmt/format.h>

#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::session;

TEST_GROUP(SessionCommands) {
  static double load(const char* text) {
    const Command command = parseCommand(text, 0.02);
    return std::holds_alternative<LoadIs>(command) ? std::get<LoadIs>(command).normal_n_per_m : -1;
  }
  static double angle(const char* text) {
    const Command command = parseCommand(text, 0.02);
    return std::holds_alternative<AngleIs>(command) ? std::get<AngleIs>(command).angle_deg : -1;
  }
  static void isUnclear(const char* text, const char* named) {
    const Command command = parseCommand(text, 0.02);
    CHECK_TEXT(std::holds_alternative<Unclear>(command), text);
    STRCMP_CONTAINS(named, std::get<Unclear>(command).why.c_str());
  }
  /// A command as it would be said; "" for none.
  static std::string textOf(const std::optional<Command>& command) {
    struct Visitor {
      std::string operator()(const LoadIs& load) const {
        return fmt::format("load {} N/m", load.normal_n_per_m);
      }
      std::string operator()(const AngleIs& angle) const { return fmt::format("angle {}", angle.angle_deg); }
      std::string operator()(const Hold&) const { return "hold"; }
      std::string operator()(const Tare&) const { return "tare"; }
      std::string operator()(const MayTare&) const { return "may it tare"; }
      std::string operator()(const Skip&) const { return "skip"; }
      std::string operator()(const Undo&) const { return "undo"; }
      std::string operator()(const Quit&) const { return "quit"; }
      std::string operator()(const Unclear& unclear) const { return unclear.why; }
    };
    return command ? std::visit(Visitor{}, *command) : "";
  }
  /// What keys make: the last command, "" for none.
  static std::string typed(const std::string& keys) {
    KeyReader reader(0.02);
    std::string last;
    for (const char key : keys)
      if (const auto command = reader.press(static_cast<unsigned char>(key))) last = textOf(command);
    return last;
  }
};

// 50 g weigh 0.4903 N, on 20 mm 24.517 N/m.
TEST(SessionCommands, ALoadIsInItsUnit) {
  DOUBLES_EQUAL(24.516625, load("load 50 g"), 1e-9);
  DOUBLES_EQUAL(24.516625, load("load 0.05kg"), 1e-9);
  DOUBLES_EQUAL(100, load("  load   2 N "), 1e-9);
  DOUBLES_EQUAL(24.5, load("load 24.5 N/m\r"), 1e-9);
}

TEST(SessionCommands, UnitsMayBeInAnyCase) {
  DOUBLES_EQUAL(24.516625, load("load 50 G"), 1e-9);
  DOUBLES_EQUAL(24.516625, load("load 0.05 Kg"), 1e-9);
  DOUBLES_EQUAL(100, load("load 2 n"), 1e-9);
  DOUBLES_EQUAL(14, load("load 14 n/M"), 1e-9);
  DOUBLES_EQUAL(40, angle("angle 40 Deg"), 0);
}

TEST(SessionCommands, ADecimalCommaIsToldWithThePoint) {
  isUnclear("load 0,5 N", "\"0,5 N\": write 0.5 with a point");
  isUnclear("load 24,5N/m", "write 24.5 with a point");
  isUnclear("angle -37,5", "write -37.5 with a point");
}

TEST(SessionCommands, AnAngleIsInDegrees) {
  DOUBLES_EQUAL(40, angle("angle 40"), 0);
  DOUBLES_EQUAL(350, angle("angle -10 deg"), 1e-9);
  DOUBLES_EQUAL(0, angle("angle -360"), 1e-9);
  DOUBLES_EQUAL(360, angle("angle 360"), 1e-9);
}

TEST(SessionCommands, WhatIsNotUnderstoodIsToldWithWhatWouldBe) {
  isUnclear("load 50", "say the unit");
  isUnclear("load g", "200 g");
  isUnclear("load -5 g", "more than 0");
  isUnclear("load nan g", "no load");
  isUnclear("load 0 N", "more than 0");
  isUnclear("angle 400", "from -360 to 360");
  isUnclear("angle inf", "no angle");
  isUnclear("angle 4 rad", "degrees");
  isUnclear("", "say load, angle, hold, skip, undo, tare or quit");
  isUnclear("quit now", "say load");
}

TEST(SessionCommands, WordsStandForThemselves) {
  CHECK(std::holds_alternative<Hold>(parseCommand("hold", 1)));
  CHECK(std::holds_alternative<Tare>(parseCommand("tare", 1)));
  CHECK(std::holds_alternative<Skip>(parseCommand("skip", 1)));
  CHECK(std::holds_alternative<Undo>(parseCommand("undo", 1)));
  CHECK(std::holds_alternative<Quit>(parseCommand("quit\r", 1)));
}

TEST(SessionCommands, KeysMakeTheSameCommands) {
  STRCMP_EQUAL("load 100 N/m", typed("l2 N\r").c_str());
  STRCMP_EQUAL("angle 45", typed("a4\x7f"
                                 "45\n")
                               .c_str());
  STRCMP_EQUAL("skip", typed("s").c_str());
  STRCMP_EQUAL("undo", typed("u").c_str());
  STRCMP_EQUAL("quit", typed("q").c_str());
}

TEST(SessionCommands, WhatIsPressedIsHeldWhileItsLoadIsTyped) {
  KeyReader reader(0.02);
  STRCMP_EQUAL("hold", textOf(reader.press('l')).c_str());
  CHECK_FALSE(reader.press('2').has_value());
}

TEST(SessionCommands, ATareWantsAYes) {
  STRCMP_EQUAL("tare", typed("ty").c_str());
  STRCMP_EQUAL("may it tare", typed("tn").c_str());
  STRCMP_EQUAL("may it tare", typed("t\r").c_str());
  isUnclear("tare?", "say load, angle");  // of keys alone
}

TEST(SessionCommands, AKeyThatIsNotObeyedAsksNothing) {
  for (const char key : {'l', 'a', 't'}) {
    KeyReader reader(0.02);
    CHECK_TRUE(reader.press(static_cast<unsigned char>(key)).has_value());
    reader.answer(false);
    STRCMP_EQUAL("", reader.prompt().c_str());
    STRCMP_EQUAL("quit", textOf(reader.press('q')).c_str());
  }
}

TEST(SessionCommands, WhatWasEnteredWronglyIsCorrectedUntilItIsTaken) {
  KeyReader reader(0.02);
  reader.press('l');
  reader.answer(true);
  for (const char key : std::string_view("50")) reader.press(static_cast<unsigned char>(key));
  STRCMP_CONTAINS("say the unit", textOf(reader.press('\r')).c_str());
  reader.answer(false);
  STRCMP_CONTAINS(": 50_", reader.prompt().c_str());
  reader.press('g');
  STRCMP_EQUAL("load 24.516625 N/m", textOf(reader.press('\r')).c_str());
  reader.answer(true);
  STRCMP_EQUAL("", reader.prompt().c_str());
}

TEST(SessionCommands, EscapeDropsWhatIsTyped) {
  STRCMP_EQUAL("quit", typed("l20\x1bq").c_str());
  STRCMP_EQUAL("hold", typed("l20q").c_str());  // q is typed there
}

TEST(SessionCommands, ThePromptShowsWhatIsTyped) {
  KeyReader reader(0.02);
  STRCMP_EQUAL("", reader.prompt().c_str());
  reader.press('l');
  reader.press('2');
  STRCMP_CONTAINS("Return or Esc: 2_", reader.prompt().c_str());
}
