#include "host/can/dbc.hpp"

#include <CppUTest/TestHarness.h>

#include <string>

using namespace strainfinger;

// What the numbers mean is checked with a parser that is not ours: tests/commands/canmatrix_test.py.
TEST_GROUP(Dbc) {
  void checkHas(const char* line, const std::string& text = can::dbcText({5}, 500)) {
    STRCMP_CONTAINS(line, std::string("\n").append(text).c_str());
  }
};

TEST(Dbc, IsOfOneNode) {
  checkHas("\nBU_: FINGER_5 HOST\n");
  checkHas("\nBO_ 389 CONTACT: 8 FINGER_5\n");
  checkHas("\nBO_ 645 FORCE: 8 FINGER_5\n");
  checkHas("\nBO_ 1797 HEARTBEAT: 8 FINGER_5\n");
}

TEST(Dbc, OfSeveralNodesEachMessageHasItsNodeInItsName) {
  const std::string text = can::dbcText({1, 12}, 500);
  checkHas("\nBU_: FINGER_1 FINGER_12 HOST\n", text);
  checkHas("\nBO_ 385 CONTACT_1: 8 FINGER_1\n", text);
  checkHas("\nBO_ 396 CONTACT_12: 8 FINGER_12\n", text);
  checkHas("\nBO_ 1548 REQUEST_12: 8 HOST\n SG_ length : 0|8@1+ (1,0) [0|7] \"\" FINGER_12\n", text);
  CHECK_TRUE(text.find(" CONTACT:") == std::string::npos);
}

TEST(Dbc, HasSignalsWithUnitAndRange) {
  checkHas("\n SG_ angle : 0|16@1+ (0.01,0) [0|359.99] \"deg\" HOST\n");
  checkHas("\n SG_ normal : 0|16@1- (0.001,0) [-32.767|32.767] \"N\" HOST\n");
  checkHas("\n SG_ sigma_normal : 32|8@1+ (0.0005,0) [0|0.127] \"N\" HOST\n");
  checkHas("\n SG_ width : 0|16@1+ (1e-06,0) [0|0.065534] \"m\" HOST\n");
  checkHas("\n SG_ chi : 32|8@1+ (0.0625,0) [0|15.875] \"\" HOST\n");
  checkHas("\n SG_ rx_errors : 52|4@1+ (16,0) [0|224] \"\" HOST\n");
  checkHas("\n SG_ alternative : 32|8@1- (1,0) [-127|127] \"deg\" HOST\n");
}

TEST(Dbc, HasASignalForEachFlag) {
  checkHas("\n SG_ simulated : 47|1@1+ (1,0) [0|1] \"\" HOST\n");
  checkHas("\n SG_ noisy : 16|1@1+ (1,0) [0|1] \"\" HOST\n");
  checkHas("\n SG_ watchdog_reset : 13|1@1+ (1,0) [0|1] \"\" HOST\n");
}

TEST(Dbc, ASecondContactHasTheSignalsOfTheFirst) {
  const auto signalsOf = [text = can::dbcText({5}, 500)](const std::string& message) {
    const std::size_t line = text.find("BO_ " + message + ": 8 FINGER_5\n");
    CHECK_TRUE(line != std::string::npos);
    const std::size_t first = text.find(" SG_", line);
    return text.substr(first, text.find("\n\n", first) - first);
  };
  STRCMP_EQUAL(signalsOf("389 CONTACT").c_str(), signalsOf("517 CONTACT2").c_str());
  STRCMP_EQUAL(signalsOf("645 FORCE").c_str(), signalsOf("773 FORCE2").c_str());
}

TEST(Dbc, BitsWithoutANameAreOneSignal) {
  checkHas("\nBO_ 133 GAUGES: 8 FINGER_5\n");
  checkHas("\n SG_ out_of_use : 0|32@1+ (1,0) [0|4294967295] \"\" HOST\n");
}

TEST(Dbc, NamesValues) {
  checkHas("\nVAL_ 1797 state 0 \"boot\" 1 \"zeroing\" 2 \"run\" 3 \"fault\" ;\n");
  checkHas("\nVAL_ 389 simulated 0 \"no\" 1 \"yes\" ;\n");
  checkHas("\nVAL_ 389 sigma_angle 65534 \"this_or_more\" 65535 \"not_known\" ;\n");
  checkHas("\nVAL_ 645 normal 32767 \"this_or_more\" -32767 \"this_or_less\" -32768 \"not_known\" ;\n");
}

TEST(Dbc, ARequestGoesTheOtherWay) {
  checkHas("\nBO_ 1541 REQUEST: 8 HOST\n");
  checkHas("\n SG_ argument : 16|16@1+ (1,0) [0|65535] \"\" FINGER_5\n");
  checkHas("\nBO_ 1413 RESPONSE: 8 FINGER_5\n");
  checkHas("\n SG_ status : 16|8@1+ (1,0) [0|255] \"\" HOST\n");
  CHECK_TRUE(can::dbcText({5}, 500).find("GenMsgCycleTime\" BO_ 1541") == std::string::npos);
}

TEST(Dbc, SaysHowOftenFramesCome) {
  checkHas("\nBA_ \"GenMsgCycleTime\" BO_ 389 50;\n");
  checkHas("\nBA_ \"GenMsgDelayTime\" BO_ 389 2;\n");
  for (const char* touch : {"389", "517", "645", "773", "901"})
    checkHas(std::string("\nBA_ \"GenMsgDelayTime\" BO_ ").append(touch).append(" 2;\n").c_str());
  checkHas("\nBA_ \"GenMsgCycleTime\" BO_ 1797 100;\n");
  checkHas("\nBA_ \"GenMsgDelayTime\" BO_ 645 10;\n", can::dbcText({5}, 100));
}

TEST(Dbc, IsPlainAscii) {
  for (const char c : can::dbcText({63}, 1000)) CHECK(c == '\n' || (c >= ' ' && c <= '~'));
}
