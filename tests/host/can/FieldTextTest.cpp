#include "host/can/field_text.hpp"

#include <CppUTest/TestHarness.h>

#include <string>

#include "common/commands.hpp"
#include "common/frames.hpp"

using namespace strainfinger;
using namespace strainfinger::can;

TEST_GROUP(FieldText) {
  template <typename Frame>
  static FieldValue valueOf(const Frame& frame, const char* column) {
    const CanFrame encoded = encode(frame, 5);
    for (const FieldValue& value : fieldValues(*findAnyFrame(encoded), encoded))
      if (columnName(value.field->meaning) == column) return value;
    FAIL(column);
    return {};
  }
  template <typename Frame>
  static std::string textOf(const Frame& frame, const char* column) {
    return can::textOf(valueOf(frame, column));
  }
};

TEST(FieldText, NumbersAreExactAndInTheirUnit) {
  STRCMP_EQUAL("102.1", textOf(ContactFrame{.angle_cdeg = 10'210}, "angle_deg").c_str());
  STRCMP_EQUAL("-0.226", textOf(ForceFrame{.tangential_mN = -226}, "tangential_n").c_str());
  STRCMP_EQUAL("0.0075", textOf(ForceFrame{.sigma_normal_half_mN = 15}, "sigma_normal_n").c_str());
  STRCMP_EQUAL("32", textOf(HeartbeatFrame{.tx_error_steps = 2}, "tx_errors").c_str());
}

TEST(FieldText, TheLargestMeansThatOrMore) {
  STRCMP_EQUAL("0.1265", textOf(ForceFrame{.sigma_normal_half_mN = 253}, "sigma_normal_n").c_str());
  STRCMP_EQUAL(">=0.127", textOf(ForceFrame{.sigma_normal_half_mN = 254}, "sigma_normal_n").c_str());
  STRCMP_EQUAL(">=32.767", textOf(ForceFrame{.normal_mN = 32'767}, "normal_n").c_str());
  STRCMP_EQUAL("<=-32.767", textOf(ForceFrame{.tangential_mN = -32'767}, "tangential_n").c_str());
  STRCMP_EQUAL("-32.766", textOf(ForceFrame{.tangential_mN = -32'766}, "tangential_n").c_str());
  STRCMP_EQUAL(">=65534", textOf(HeartbeatFrame{.uptime_s = 65'534}, "uptime_s").c_str());
  STRCMP_EQUAL("359.99", textOf(ContactFrame{.angle_cdeg = 35'999}, "angle_deg").c_str());
}

TEST(FieldText, WhatIsNotKnownIsSaidSo) {
  STRCMP_EQUAL("?", textOf(ContactFrame{}, "angle_deg").c_str());
  STRCMP_EQUAL("?", textOf(ContactFrame{}, "alternative_deg").c_str());
  CHECK_FALSE(valueOf(ContactFrame{}, "angle_deg").isKnown);
  // 36,000 is none of an angle's values, and not the one that stands for "not known" either.
  const CanFrame frame{0x185, 8, {0xA0, 0x8C}};
  STRCMP_EQUAL("?", can::textOf(fieldValues(*findAnyFrame(frame), frame).front()).c_str());
}

TEST(FieldText, FlagsAndChoicesAreNames) {
  STRCMP_EQUAL(
      "contact+simulated",
      textOf(ContactFrame{.flags = {FingerFlag::kContact, FingerFlag::kSimulated}}, "flags").c_str());
  STRCMP_EQUAL("none", textOf(ContactFrame{}, "flags").c_str());
  STRCMP_EQUAL("hang", textOf(InfoFrame{.crash = Crash::kHang}, "crash").c_str());
  STRCMP_EQUAL("9", textOf(HeartbeatFrame{.state = FingerState{9}}, "state").c_str());
}

TEST(FieldText, WhatARequestLeavesOutIsNotKnown) {
  STRCMP_EQUAL("?", textOf(RequestFrame{.length = 1, .command = Command::kTare}, "argument").c_str());
  STRCMP_EQUAL("200", textOf(contactRateRequest(200), "argument").c_str());
}

// Other stacks pad (BUS_REQUESTS.md): what a command does not count is not there.
TEST(FieldText, PaddingSaysNothing) {
  const auto argumentIn = [](const CanFrame& frame) {
    const auto values = fieldValues(*findAnyFrame(frame), frame);
    STRCMP_EQUAL("?", can::textOf(values.back()).c_str());  // the word
    return can::textOf(values[values.size() - 2]);
  };
  const CanFrame forced{0x605, 8, {0x02, 0x01, 0x01, 0xCC, 0xCC, 0xCC, 0xCC, 0xCC}};
  STRCMP_EQUAL("1", argumentIn(forced).c_str());
  const CanFrame tare{0x605, 8, {0x01, 0x01, 0xCC, 0xCC, 0xCC, 0xCC, 0xCC, 0xCC}};
  STRCMP_EQUAL("?", argumentIn(tare).c_str());
  const CanFrame wait{0x585, 8, {0x03, 0x81, 0x07, 0x0A, 0xCC, 0xCC, 0xCC, 0xCC}};
  STRCMP_EQUAL("10", can::textOf(fieldValues(*findAnyFrame(wait), wait).back()).c_str());
}

TEST(FieldText, RawIsAFrameToo) { STRCMP_EQUAL("1234", textOf(RawFrame{.code_1 = 1234}, "code_1").c_str()); }
