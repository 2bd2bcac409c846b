#include "host/can/frame_catalogue.hpp"

#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>

#include "common/frames.hpp"

using namespace strainfinger;
using namespace strainfinger::can;

TEST_GROUP(FrameCatalogue) {
  FieldSpec field(const char* frame, const char* name) {
    for (const FrameEntry& entry : frameCatalogue())
      for (const FieldSpec& each : entry.fields)
        if (std::string(frame) == entry.spec.name && std::string(name) == each.meaning.name) return each;
    FAIL(name);
    return {};
  }

  template <typename Check>
  void forEachField(Check check) {
    for (const FrameEntry& entry : frameCatalogue())
      for (const FieldSpec& each : entry.fields) check(each);
  }

  static bool isName(const std::string& name) {
    return !name.empty() && name.size() <= 32 &&
           name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") == std::string::npos;
  }
  static bool isPlainText(const std::string& text) {
    for (const char c : text)
      if (c < ' ' || c > '~' || c == '"') return false;
    return true;
  }
};

TEST(FrameCatalogue, ADeviceWithANodeBeyondAFingersIsNoFinger) {
  LONGS_EQUAL(1, fingerNode(0x181).value());
  LONGS_EQUAL(63, fingerNode(0x73F).value());
  CHECK_FALSE(fingerNode(0x1C1).has_value());  // node 65, whose low six bits are 1
  CHECK_FALSE(fingerNode(0x180).has_value());
}

TEST(FrameCatalogue, FindsFramesByIdentifierAndLength) {
  STRCMP_EQUAL("CONTACT", findFrame({0x181, 8, {}})->spec.name);
  STRCMP_EQUAL("FORCE", findFrame({0x2BF, 8, {}})->spec.name);
  STRCMP_EQUAL("PATCH", findFrame({0x381, 8, {}})->spec.name);
  STRCMP_EQUAL("CONTACT2", findFrame({0x23F, 8, {}})->spec.name);
  STRCMP_EQUAL("FORCE2", findFrame({0x301, 8, {}})->spec.name);
  STRCMP_EQUAL("HEARTBEAT", findFrame({0x701, 8, {}})->spec.name);
}

TEST(FrameCatalogue, FindsNoOtherFrames) {
  CHECK(findFrame({0x181, 7, {}}) == nullptr);
  CHECK(findFrame({0x180, 8, {}}) == nullptr);
  CHECK(findFrame({0x1C0, 8, {}}) == nullptr);
  CHECK(findFrame({0x401, 8, {}}) == nullptr);  // RAW is reserved
  CHECK(findFrame({0x701, 1, {}}) == nullptr);  // the heartbeat of a CANopen device
}

TEST(FrameCatalogue, NamesUnitsAndCommentsAreFitForADbcFile) {
  forEachField([](const FieldSpec& each) {
    CHECK(isName(each.meaning.name));
    CHECK(isPlainText(each.meaning.unit));
    CHECK(isPlainText(each.meaning.comment));
    for (const ValueName& name : each.meaning.names) CHECK(isName(name.name) && isPlainText(name.comment));
  });
}

TEST(FrameCatalogue, NamesAreUniqueInTheirFrame) {
  for (const FrameEntry& entry : frameCatalogue()) {
    std::set<std::string> names;
    for (const FieldSpec& each : entry.fields) {
      CHECK(names.insert(each.meaning.name).second);
      if (each.meaning.kind == FieldKind::kFlags)
        for (const ValueName& flag : each.meaning.names) CHECK(names.insert(flag.name).second);
    }
  }
}

TEST(FrameCatalogue, PhysicalValuesAreTheNearestToTheDecimal) {
  CHECK(toPhysical(field("CONTACT", "angle"), 3573) == 35.73);
  CHECK(toPhysical(field("FORCE", "normal"), -226) == -0.226);
  CHECK(toPhysical(field("FORCE", "sigma_normal"), 7) == 0.0035);
  CHECK(toPhysical(field("CONTACT", "alternative"), -127) == -127.0);
  CHECK(toPhysical(field("PATCH", "width"), 2041) == 0.002041);
  CHECK(toPhysical(field("PATCH", "chi"), 17) == 1.0625);
  CHECK(toPhysical(field("HEARTBEAT", "tx_errors"), 6) == 96.0);
}

TEST(FrameCatalogue, WhatIsNotValidHasNoPhysicalValue) {
  CHECK_FALSE(toPhysical(field("CONTACT", "angle"), 0xFFFF).has_value());
  CHECK_FALSE(toPhysical(field("CONTACT", "angle"), 36000).has_value());
  CHECK_FALSE(toPhysical(field("FORCE", "normal"), -32768).has_value());
  CHECK_FALSE(toPhysical(field("HEARTBEAT", "temperature"), -128).has_value());
}

// All of up to 20 bits, a million and the last of more.
TEST(FrameCatalogue, EveryValidRawValueIsSoManyStepsOfThePhysicalOne) {
  forEachField([](const FieldSpec& each) {
    const auto check = [&](std::int64_t raw) {
      CHECK(std::llround(*toPhysical(each, raw) / stepOf(each.meaning)) == raw);
    };
    const std::int64_t least = minRaw(each.bits), most = maxRaw(each.bits);
    const std::int64_t step = std::max<std::int64_t>((most - least) >> 20, 1);
    for (std::int64_t raw = least; raw <= most; raw += step) check(raw);
    check(most);
  });
}

TEST(FrameCatalogue, FindsFramesOfAWrongLengthByTheirFunction) {
  STRCMP_EQUAL("CONTACT", findFunction(0x185)->spec.name);
  for (const std::uint16_t id : std::array<std::uint16_t, 5>{0x180, 0x1C0, 0x605, 0x7FF, 0x000})
    POINTERS_EQUAL(nullptr, findFunction(id));
}

TEST(FrameCatalogue, FindsRequestsAndResponses) {
  STRCMP_EQUAL("REQUEST", findCommand({0x605, 2, {0x01, 0x01}})->spec.name);
  STRCMP_EQUAL("RESPONSE", findCommand({0x585, 8, {0x02, 0x82}})->spec.name);
}

// What a CANopen drive's SDO server and its client say (CiA 301): 1000h, 1018h:1, a whole segment, an abort.
TEST(FrameCatalogue, DrivesSdoFramesAreNoCommands) {
  for (const CanFrame& frame : {CanFrame{0x605, 8, {0x40, 0x00, 0x10, 0x00}},
                                CanFrame{0x585, 8, {0x43, 0x00, 0x10, 0x00, 0x92, 0x01}},
                                CanFrame{0x585, 8, {0x4F, 0x18, 0x10, 0x01, 0x11}},
                                CanFrame{0x585, 8, {0x00, 'd', 'r', 'i', 'v', 'e'}},
                                CanFrame{0x585, 8, {0x80, 0x00, 0x10, 0x00, 0x00, 0x00, 0x02, 0x06}},
                                CanFrame{0x585, 8, {0x02, 0xFF}}, CanFrame{0x185, 8, {0x02, 0x82}}})
    POINTERS_EQUAL(nullptr, findCommand(frame));
}
