#include "common/frames.hpp"

#include <CppUTest/TestHarness.h>

#include <array>
#include <cstdint>

using namespace strainfinger;

using Bytes = std::array<std::uint8_t, 8>;

TEST_GROUP(Frames) {
  const ContactFrame contact_{
      .angle_cdeg = 1000,
      .sigma_angle_cdeg = 290,
      .alternative_deg = -90,
      .flags = {FingerFlag::kContact, FingerFlag::kUncertain, FingerFlag::kSimulated},
      .quality_percent = 97,
      .sequence = 163,
  };
  const ForceFrame force_{
      .normal_mN = 1500,
      .tangential_mN = -226,
      .sigma_normal_half_mN = 7,
      .sigma_tangential_half_mN = 254,
      .flags = {FingerFlag::kContact, FingerFlag::kUncertain, FingerFlag::kSimulated},
      .sequence = 163,
  };
  const PatchFrame patch_{
      .width_um = 2040,
      .sigma_width_um = 65534,
      .chi_sixteenths = 19,
      .contacts = 2,
      .flags = {FingerFlag::kContact, FingerFlag::kUncertain, FingerFlag::kSimulated},
      .sequence = 163,
  };
  const HeartbeatFrame heartbeat_{
      .state = FingerState::kRun,
      .faults = {FingerFault::kGauges, FingerFault::kWatchdogReset, FingerFault::kNoisy},
      .uptime_s = 3661,
      .temperature_degC = -5,
      .tx_error_steps = 6,
      .rx_error_steps = 1,
      .table_crc = 0xA7,
  };

  /// Every value of a member, as its own type, with all other bits of the frame once 0 and once 1.
  template <typename Frame, typename Member>
  void checkEveryValue(Member Frame::*member, std::int64_t first, std::int64_t last) {
    for (const std::uint8_t others : {std::uint8_t{0x00}, std::uint8_t{0xFF}})
      for (std::int64_t raw = first; raw <= last; ++raw) {
        CanFrame frame = encode(Frame{}, 9);
        frame.data.fill(others);
        Frame values = decode<Frame>(frame).value();
        values.*member = memberOf<Member>(raw);
        const Frame back = decode<Frame>(encode(values, 9)).value();
        CHECK(rawOf(back.*member) == raw);
      }
  }
};

TEST(Frames, ContactHasTheseBytes) {
  const CanFrame frame = encode(contact_, 5);
  LONGS_EQUAL(0x185, frame.id);
  LONGS_EQUAL(8, frame.length);
  CHECK(frame.data == (Bytes{0xE8, 0x03,   // 1000: 10.00 deg
                             0x22, 0x01,   // 290: sigma 2.90 deg
                             0xA6,         // -90: 90 deg clockwise fits as well
                             0b1000'1001,  // simulated, uncertain, contact
                             97,           // quality 97 percent
                             163}));       // sequence
}

TEST(Frames, ForceHasTheseBytes) {
  const CanFrame frame = encode(force_, 5);
  LONGS_EQUAL(0x285, frame.id);
  LONGS_EQUAL(8, frame.length);
  CHECK(frame.data == (Bytes{0xDC, 0x05,   // 1500: 1.500 N
                             0x1E, 0xFF,   // -226: -0.226 N
                             7,            // sigma 3.5 mN
                             254,          // sigma 127 mN or more
                             0b1000'1001,  // simulated, uncertain, contact
                             163}));       // sequence of the CONTACT
}

TEST(Frames, HeartbeatHasTheseBytes) {
  const CanFrame frame = encode(heartbeat_, 63);
  LONGS_EQUAL(0x73F, frame.id);
  LONGS_EQUAL(8, frame.length);
  CHECK(frame.data == (Bytes{0x22,               // protocol 2, state 2: run
                             0b0010'0010, 0x01,  // watchdog_reset, gauges; noisy
                             0x4D, 0x0E,         // 3661 s
                             0xFB,               // -5 degC
                             0x16,               // receive errors 16 .. 31, transmit errors 96 .. 111
                             0xA7}));            // low byte of the tables' CRC-32
}

TEST(Frames, PatchHasTheseBytes) {
  const CanFrame frame = encode(patch_, 5);
  LONGS_EQUAL(0x385, frame.id);
  LONGS_EQUAL(8, frame.length);
  CHECK(frame.data == (Bytes{0xF8, 0x07,   // 2040: 2.040 mm
                             0xFE, 0xFF,   // sigma 65.534 mm or more
                             19,           // chi 1.1875
                             2,            // contacts
                             0b1000'1001,  // simulated, uncertain, contact
                             163}));       // sequence of the CONTACT
}

TEST(Frames, ASecondContactHasTheBytesOfTheFirst) {
  const CanFrame contact = encode(Contact2Frame{contact_}, 5), force = encode(Force2Frame{force_}, 63);
  LONGS_EQUAL(0x205, contact.id);
  LONGS_EQUAL(0x33F, force.id);
  CHECK(contact.data == encode(contact_, 5).data);
  CHECK(force.data == encode(force_, 63).data);
}

// The limits of ISO 11898, warning from 96 and passive from 128, and the neighbours of each.
TEST(Frames, ErrorCountersKeepTheirLimits) {
  for (const auto& [errors, steps] : {std::pair{0, 0},
                                      {15, 0},
                                      {16, 1},
                                      {95, 5},
                                      {96, 6},
                                      {127, 7},
                                      {128, 8},
                                      {223, 13},
                                      {224, 14},
                                      {239, 14},
                                      {240, 14},
                                      {255, 14}})
    LONGS_EQUAL(steps, errorSteps(static_cast<std::uint8_t>(errors)));
}

// A receiver of any version finds the version where it has always been.
TEST(Frames, TheProtocolIsInTheUpperHalfOfTheHeartbeatsFirstByte) {
  LONGS_EQUAL(2, kProtocolVersion);
  LONGS_EQUAL(2, encode(HeartbeatFrame{}, 1).data[0] >> 4);
  LONGS_EQUAL(1, decode<HeartbeatFrame>({0x701, 8, {0x12, 0, 0x4D, 0x0E, 0x19, 0, 0, 0xA7}})->protocol);
}

TEST(Frames, WhatWasNotSetIsNotKnown) {
  CHECK(encode(ContactFrame{}, 1).data == (Bytes{0xFF, 0xFF, 0xFF, 0xFF, 0x80, 0, 0xFF, 0}));
  CHECK(encode(ForceFrame{}, 1).data == (Bytes{0x00, 0x80, 0x00, 0x80, 0xFF, 0xFF, 0, 0}));
  CHECK(encode(PatchFrame{}, 1).data == (Bytes{0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0, 0, 0}));
  CHECK(encode(HeartbeatFrame{}, 1).data == (Bytes{0x20, 0, 0, 0xFF, 0xFF, 0x80, 0xFF, 0}));
}

TEST(Frames, DecodingGivesBackWhatWasEncoded) {
  CHECK(decode<ContactFrame>(encode(contact_, 1)) == contact_);
  CHECK(decode<ForceFrame>(encode(force_, 1)) == force_);
  CHECK(decode<PatchFrame>(encode(patch_, 1)) == patch_);
  CHECK(decode<HeartbeatFrame>(encode(heartbeat_, 1)) == heartbeat_);
}

TEST(Frames, EveryValueOfContactSurvives) {
  checkEveryValue(&ContactFrame::angle_cdeg, 0, 35999);
  checkEveryValue(&ContactFrame::angle_cdeg, 0xFFFF, 0xFFFF);
  checkEveryValue(&ContactFrame::sigma_angle_cdeg, 0, 0xFFFF);
  checkEveryValue(&ContactFrame::alternative_deg, -128, 127);
  checkEveryValue(&ContactFrame::flags, 0, 255);
  checkEveryValue(&ContactFrame::quality_percent, 0, 100);
  checkEveryValue(&ContactFrame::quality_percent, 255, 255);
  checkEveryValue(&ContactFrame::sequence, 0, 255);
}

TEST(Frames, EveryValueOfForceSurvives) {
  checkEveryValue(&ForceFrame::normal_mN, -32768, 32767);
  checkEveryValue(&ForceFrame::tangential_mN, -32768, 32767);
  checkEveryValue(&ForceFrame::sigma_normal_half_mN, 0, 255);
  checkEveryValue(&ForceFrame::sigma_tangential_half_mN, 0, 255);
  checkEveryValue(&ForceFrame::flags, 0, 255);
  checkEveryValue(&ForceFrame::sequence, 0, 255);
}

TEST(Frames, EveryValueOfPatchSurvives) {
  checkEveryValue(&PatchFrame::width_um, 0, 0xFFFF);
  checkEveryValue(&PatchFrame::sigma_width_um, 0, 0xFFFF);
  checkEveryValue(&PatchFrame::chi_sixteenths, 0, 255);
  checkEveryValue(&PatchFrame::contacts, 0, 255);
  checkEveryValue(&PatchFrame::flags, 0, 255);
  checkEveryValue(&PatchFrame::sequence, 0, 255);
}

TEST(Frames, EveryValueOfHeartbeatSurvives) {
  checkEveryValue(&HeartbeatFrame::state, 0, 15);
  checkEveryValue(&HeartbeatFrame::protocol, 0, 15);
  checkEveryValue(&HeartbeatFrame::faults, 0, 0xFFFF);
  checkEveryValue(&HeartbeatFrame::uptime_s, 0, 0xFFFF);
  checkEveryValue(&HeartbeatFrame::temperature_degC, -128, 127);
  checkEveryValue(&HeartbeatFrame::tx_error_steps, 0, 15);
  checkEveryValue(&HeartbeatFrame::rx_error_steps, 0, 15);
  checkEveryValue(&HeartbeatFrame::table_crc, 0, 255);
}

TEST(Frames, NoValueBeyondTheValidOnesIsSent) {
  const ContactFrame wrong{.angle_cdeg = 36000, .quality_percent = 101};
  const ContactFrame sent = decode<ContactFrame>(encode(wrong, 1)).value();
  LONGS_EQUAL(35999, sent.angle_cdeg);
  LONGS_EQUAL(100, sent.quality_percent);
  LONGS_EQUAL(15, decode<HeartbeatFrame>(encode(HeartbeatFrame{.protocol = 16}, 1))->protocol);
}

TEST(Frames, GaugesHasTheseBytes) {
  const CanFrame frame = encode(GaugesFrame{1u << 5 | 1u << 31, 600, 510}, 5);
  LONGS_EQUAL(0x085, frame.id);
  CHECK(frame.data == (Bytes{0x20, 0, 0, 0x80,  // gauges 5 and 31
                             0x58, 0x02,        // 600 s
                             0xFE, 0x01}));     // 510e-9 a second
}

TEST(Frames, FramesAreNotTakenForOneAnother) {
  CHECK_FALSE(decode<ForceFrame>(encode(contact_, 1)).has_value());
  CHECK_FALSE(decode<HeartbeatFrame>(encode(force_, 1)).has_value());
  CHECK_FALSE(decode<ContactFrame>(encode(heartbeat_, 1)).has_value());
  CHECK_FALSE(decode<ContactFrame>(encode(Contact2Frame{contact_}, 1)).has_value());
  CHECK_FALSE(decode<Force2Frame>(encode(force_, 1)).has_value());
}

TEST(Frames, ShortAndEmptyFramesAreRefused) {
  for (const int length : {0, 1, 7}) {
    CanFrame frame = encode(contact_, 1);
    frame.length = static_cast<std::uint8_t>(length);
    CHECK_FALSE(decode<ContactFrame>(frame).has_value());
  }
}

TEST(Frames, FunctionsAreThoseOfCanopensPredefinedSet) {
  LONGS_EQUAL(0x080, static_cast<int>(FunctionCode::kGauges));
  LONGS_EQUAL(0x180, static_cast<int>(FunctionCode::kContact));
  LONGS_EQUAL(0x200, static_cast<int>(FunctionCode::kContact2));
  LONGS_EQUAL(0x280, static_cast<int>(FunctionCode::kForce));
  LONGS_EQUAL(0x300, static_cast<int>(FunctionCode::kForce2));
  LONGS_EQUAL(0x380, static_cast<int>(FunctionCode::kPatch));
  LONGS_EQUAL(0x400, static_cast<int>(FunctionCode::kRaw));
  LONGS_EQUAL(0x480, static_cast<int>(FunctionCode::kInfo));
  LONGS_EQUAL(0x580, static_cast<int>(FunctionCode::kResponse));
  LONGS_EQUAL(0x600, static_cast<int>(FunctionCode::kRequest));
  LONGS_EQUAL(0x700, static_cast<int>(FunctionCode::kHeartbeat));
}
