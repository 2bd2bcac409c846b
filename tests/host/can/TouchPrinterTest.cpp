#include "host/can/touch_printer.hpp"

#include <CppUTest/TestHarness.h>

#include <array>
#include <string>

#include "common/frames.hpp"

using namespace strainfinger;
using namespace strainfinger::can;

TEST_GROUP(TouchPrinter) {
  static constexpr FingerFlags kTouched{FingerFlag::kContact, FingerFlag::kSimulated};
  const ContactFrame contact_{
      .angle_cdeg = 3573, .sigma_angle_cdeg = 12, .flags = kTouched, .quality_percent = 97, .sequence = 163};
  const ForceFrame force_{.normal_mN = 290,
                          .tangential_mN = -226,
                          .sigma_normal_half_mN = 7,
                          .sigma_tangential_half_mN = 9,
                          .flags = kTouched,
                          .sequence = 163};
  const PatchFrame patch_{.width_um = 2040,
                          .sigma_width_um = 150,
                          .chi_sixteenths = 17,
                          .contacts = 1,
                          .flags = kTouched,
                          .sequence = 163};
  std::string printed_;

  static constexpr const char* kRow =
      "1.500000,can0,5,35.73,0.29,-0.226,0.00204,0.12,0.0035,0.0045,0.00015,97,1.0625,contact+simulated,163,,"
      ",,,1,,,,,\n";

  std::string rows() const { return printed_.substr(printed_.find('\n') + 1); }

  template <typename Frame>
  static void take(TouchPrinter & printer, const Frame& frame, std::int64_t time_ns = 1'500'000'000,
                   std::uint8_t node = 5, const char* interface = "can0") {
    printer.print(time_ns, interface, encode(frame, node));
  }
};

TEST(TouchPrinter, PrintsARowATouchAtTheTimeOfItsContact) {
  TouchPrinter printer(printed_, TableFormat::kCsv);
  STRCMP_EQUAL(
      "time_s,interface,node,angle_deg,normal_n,tangential_n,width_m,sigma_angle_deg,sigma_normal_n,"
      "sigma_tangential_n,sigma_width_m,quality_percent,chi,flags,sequence,angle2_deg,normal2_n,tangential2_"
      "n,"
      "alternative_deg,contacts,sigma_angle2_deg,sigma_normal2_n,sigma_tangential2_n,quality2_percent,"
      "alternative2_deg\n",
      printed_.c_str());
  take(printer, contact_);
  take(printer, force_, 1'600'000'000);
  STRCMP_EQUAL("", rows().c_str());
  take(printer, patch_, 1'700'000'000);
  STRCMP_EQUAL(kRow, rows().c_str());
}

TEST(TouchPrinter, PrintsASecondContact) {
  TouchPrinter printer(printed_, TableFormat::kCsv);
  PatchFrame patch = patch_;
  patch.contacts = 2;
  ContactFrame contact = contact_;
  contact.angle_cdeg = 18000;
  ForceFrame force = force_;
  force.normal_mN = 1;
  take(printer, contact_), take(printer, force_), take(printer, patch);
  take(printer, Contact2Frame{contact}), take(printer, Force2Frame{force});
  STRCMP_CONTAINS(",163,180,0.001,-0.226,,2,0.12,0.0035,0.0045,97,\n", rows().c_str());
}

TEST(TouchPrinter, TheEndOfASecondContactHasNoForceAndNoPlace) {
  TouchPrinter printer(printed_, TableFormat::kCsv);
  PatchFrame patch = patch_;
  patch.contacts = 2;
  take(printer, contact_), take(printer, force_), take(printer, patch);
  take(printer, Contact2Frame{contact_}), take(printer, Force2Frame{force_});
  printed_.clear();
  ContactFrame contact = contact_;
  ForceFrame force = force_;
  contact.sequence = force.sequence = patch.sequence = 164;
  patch.contacts = 1;
  take(printer, contact), take(printer, force), take(printer, patch);
  take(printer, Contact2Frame{ContactFrame{.sequence = 164}});
  take(printer, Force2Frame{ForceFrame{.normal_mN = 0, .tangential_mN = 0, .sequence = 164}});
  STRCMP_CONTAINS(",contact+simulated,164,,0,0,,1,,,,,\n", printed_.c_str());
}

TEST(TouchPrinter, TheEndOfATouchHasNoForceAndNoPlace) {
  TouchPrinter printer(printed_, TableFormat::kCsv);
  take(printer, ContactFrame{});
  take(printer, ForceFrame{.normal_mN = 0, .tangential_mN = 0});
  take(printer, PatchFrame{});
  STRCMP_EQUAL("1.500000,can0,5,,0,0,,,,,,,,,0,,,,,0,,,,,\n", rows().c_str());
}

TEST(TouchPrinter, PrintsObjects) {
  TouchPrinter printer(printed_, TableFormat::kJson);
  take(printer, contact_), take(printer, force_),
      take(printer, PatchFrame{.flags = kTouched, .sequence = 163});
  STRCMP_EQUAL(
      "{\"time_s\":1.5,\"interface\":\"can0\",\"node\":5,\"angle_deg\":35.73,\"normal_n\":0.29,\"tangential_"
      "n\":"
      "-0.226,\"width_m\":null,\"sigma_angle_deg\":0.12,\"sigma_normal_n\":0.0035,\"sigma_tangential_n\":0."
      "0045,"
      "\"sigma_width_m\":null,\"quality_percent\":97,\"chi\":null,\"flags\":\"contact+simulated\","
      "\"sequence\":163,"
      "\"angle2_deg\":null,\"normal2_n\":null,\"tangential2_n\":null,\"alternative_deg\":null,\"contacts\":0,"
      "\"sigma_angle2_deg\":null,\"sigma_normal2_n\":null,\"sigma_tangential2_n\":null,"
      "\"quality2_percent\":null,\"alternative2_deg\":null}\n",
      printed_.c_str());
}

TEST(TouchPrinter, FingersDontMix) {
  TouchPrinter printer(printed_, TableFormat::kCsv);
  for (const char* interface : {"can0", "can1"})
    for (const std::uint8_t node : std::array<std::uint8_t, 2>{5, 6})
      take(printer, contact_, 1'500'000'000, node, interface);
  take(printer, force_), take(printer, patch_);
  STRCMP_EQUAL(kRow, rows().c_str());
}

TEST(TouchPrinter, WhatATouchLostIsEmptyOnceTheNextComes) {
  TouchPrinter printer(printed_, TableFormat::kCsv);
  take(printer, contact_), take(printer, patch_);
  printer.print(0, "can0", {0x7FF, 0, {}});
  STRCMP_EQUAL("", rows().c_str());
  ContactFrame next = contact_;
  ++next.sequence;
  take(printer, next, 1'600'000'000);
  STRCMP_EQUAL("1.500000,can0,5,35.73,,,0.00204,0.12,,,0.00015,97,1.0625,contact+simulated,163,,,,,1,,,,,\n",
               rows().c_str());
}

// Nothing follows but HEARTBEATs, of which one may get between the frames of a touch.
TEST(TouchPrinter, TheEndOfATouchIsToldWhateverOfItWasLost) {
  TouchPrinter printer(printed_, TableFormat::kCsv);
  take(printer, ContactFrame{.flags = {FingerFlag::kSimulated}, .sequence = 7});
  take(printer, HeartbeatFrame{}, 1'510'000'000);
  STRCMP_EQUAL("", rows().c_str());
  take(printer, HeartbeatFrame{}, 1'610'000'000);
  STRCMP_EQUAL("1.500000,can0,5,,,,,,,,,,,simulated,7,,,,,,,,,,\n", rows().c_str());
  take(printer, ForceFrame{.sequence = 7}), take(printer, PatchFrame{.sequence = 7});
  printer.finish();
  STRCMP_EQUAL("1.500000,can0,5,,,,,,,,,,,simulated,7,,,,,,,,,,\n", rows().c_str());
}

TEST(TouchPrinter, AContactThatComesTwiceIsOne) {
  TouchPrinter printer(printed_, TableFormat::kCsv);
  take(printer, contact_), take(printer, force_), take(printer, contact_), take(printer, patch_);
  take(printer, contact_);
  printer.finish();
  STRCMP_EQUAL(kRow, rows().c_str());
}

TEST(TouchPrinter, AFingerThatStartsAnewMaySayTheSame) {
  TouchPrinter printer(printed_, TableFormat::kCsv);
  for (int start = 0; start < 2; ++start) {
    take(printer, contact_), take(printer, force_), take(printer, patch_);
    take(printer, HeartbeatFrame{}), take(printer, HeartbeatFrame{});
  }
  STRCMP_EQUAL((std::string(kRow) + kRow).c_str(), rows().c_str());
}

TEST(TouchPrinter, AtTheEndOfTheLogWhatIsThereIsPrinted) {
  TouchPrinter printer(printed_, TableFormat::kCsv);
  take(printer, contact_), take(printer, contact_), take(printer, force_);
  printer.finish();
  STRCMP_EQUAL("1.500000,can0,5,35.73,0.29,-0.226,,0.12,0.0035,0.0045,,97,,contact+simulated,163,,,,,,,,,,\n",
               rows().c_str());
}

TEST(TouchPrinter, ASecondContactIsPrintedWhereThePatchWasLost) {
  TouchPrinter printer(printed_, TableFormat::kCsv);
  ContactFrame contact = contact_;
  contact.angle_cdeg = 18000;
  take(printer, contact_), take(printer, Contact2Frame{contact});
  printer.finish();
  STRCMP_CONTAINS(",163,180,,,,,0.12,,,97,\n", rows().c_str());
}
