#include "host/can/frame_printer.hpp"

#include <CppUTest/TestHarness.h>

#include <string>

#include "common/frames.hpp"

using namespace strainfinger;
using namespace strainfinger::can;

TEST_GROUP(FramePrinter) {
  const ContactFrame contact_{.angle_cdeg = 3573,
                              .alternative_deg = -90,
                              .flags = {FingerFlag::kContact, FingerFlag::kSimulated},
                              .quality_percent = 97,
                              .sequence = 163};
  std::string printed_;

  /// The lines below the header.
  std::string rows() const { return printed_.substr(printed_.find('\n') + 1); }

  template <typename Frame>
  void print(TableFormat format, const Frame& frame, std::optional<std::int64_t> time_ns = 1500000) {
    FramePrinter printer(printed_, format);
    CHECK(printer.print(time_ns, "can0", encode(frame, 5)));
  }
};

TEST(FramePrinter, TheTableHasAColumnForEachFieldOfAnyFrame) {
  FramePrinter printer(printed_, TableFormat::kCsv);
  STRCMP_EQUAL(
      "time_s,interface,node,frame,angle_deg,sigma_angle_deg,alternative_deg,flags,quality_percent,sequence,"
      "normal_n,tangential_n,sigma_normal_n,sigma_tangential_n,width_m,sigma_width_m,chi,contacts,state,"
      "protocol,faults,uptime_s,temperature_"
      "degc,"
      "tx_errors,rx_errors,table_crc,reset_cause,crash,restarts,version_major,version_minor,crash_address,"
      "board,out_of_use,zero_age_s,zero_rate_per_s,command,argument,word,status,value\n",
      printed_.c_str());
}

TEST(FramePrinter, PrintsContactAsARow) {
  print(TableFormat::kCsv, contact_);
  STRCMP_EQUAL("0.001500,can0,5,CONTACT,35.73,,-90,contact+simulated,97,163,,,,,,,,,,,,,,,,,,,,,,,,,,,,,,,\n",
               rows().c_str());
}

TEST(FramePrinter, PrintsForceAsARow) {
  print(TableFormat::kCsv, ForceFrame{.normal_mN = 290, .tangential_mN = -226, .sigma_normal_half_mN = 7});
  STRCMP_EQUAL("0.001500,can0,5,FORCE,,,,,,0,0.29,-0.226,0.0035,,,,,,,,,,,,,,,,,,,,,,,,,,,,\n",
               rows().c_str());
}

TEST(FramePrinter, PrintsPatchAsARow) {
  print(TableFormat::kCsv,
        PatchFrame{.width_um = 2040, .chi_sixteenths = 17, .contacts = 1, .flags = {}, .sequence = 9});
  STRCMP_EQUAL("0.001500,can0,5,PATCH,,,,,,9,,,,,0.00204,,1.0625,1,,,,,,,,,,,,,,,,,,,,,,,\n", rows().c_str());
}

TEST(FramePrinter, PrintsASecondContactInTheColumnsOfTheFirst) {
  print(TableFormat::kCsv, Contact2Frame{contact_});
  STRCMP_EQUAL(
      "0.001500,can0,5,CONTACT2,35.73,,-90,contact+simulated,97,163,,,,,,,,,,,,,,,,,,,,,,,,,,,,,,,\n",
      rows().c_str());
}

TEST(FramePrinter, StepsOfMoreThanAUnitAreWholeNumbers) {
  print(TableFormat::kJson, HeartbeatFrame{.tx_error_steps = 8, .rx_error_steps = 0});
  STRCMP_CONTAINS("\"tx_errors\":128,\"rx_errors\":0,", printed_.c_str());
}

TEST(FramePrinter, PrintsHeartbeatAsARow) {
  print(TableFormat::kCsv,
        HeartbeatFrame{.state = FingerState::kFault,
                       .faults = {FingerFault::kTables, FingerFault::kCan, FingerFault::kNoisy},
                       .uptime_s = 12,
                       .tx_error_steps = 6,
                       .table_crc = 167});
  STRCMP_EQUAL(
      "0.001500,can0,5,HEARTBEAT,,,,,,,,,,,,,,,fault,2,tables+can+noisy,12,,96,,167,,,,,,,,,,,,,,,\n",
      rows().c_str());
}

TEST(FramePrinter, PrintsInfoAsARow) {
  print(TableFormat::kCsv, InfoFrame{.reset_cause = ResetCause::kSoftware,
                                     .crash = Crash::kAssertion,
                                     .restarts = 2,
                                     .crash_address = 4096,
                                     .board = 77});
  STRCMP_EQUAL("0.001500,can0,5,INFO,,,,,,,,,,,,,,,,,,,,,,,software,assertion,2,0,0,4096,77,,,,,,,,\n",
               rows().c_str());
}

TEST(FramePrinter, PrintsGaugesByTheirNumbers) {
  print(TableFormat::kJson, GaugesFrame{.out_of_use = 1u << 5 | 1u << 31, .zero_age_s = 12});
  STRCMP_CONTAINS("\"out_of_use\":\"5+31\",\"zero_age_s\":12,\"zero_rate_per_s\":null", printed_.c_str());
}

TEST(FramePrinter, PrintsAnObjectWithTheFramesOwnFields) {
  print(TableFormat::kJson, contact_);
  STRCMP_EQUAL(
      "{\"time_s\":0.0015,\"interface\":\"can0\",\"node\":5,\"frame\":\"CONTACT\",\"angle_deg\":35.73,"
      "\"sigma_angle_deg\":null,\"alternative_deg\":-90,\"flags\":\"contact+simulated\",\"quality_percent\":"
      "97,"
      "\"sequence\":163}\n",
      printed_.c_str());
}

TEST(FramePrinter, PrintsRequestsAndResponses) {
  FramePrinter printer(printed_, TableFormat::kJson);
  CHECK(printer.print({}, "can0", {0x605, 4, {0x03, 0x02, 0xC8, 0x00}}));
  CHECK(printer.print({}, "can0", {0x585, 8, {0x06, 0x83, 0x07, 0x2D, 0, 0, 0, 0}}));
  CHECK(printer.print({}, "can0", {0x585, 8, {0x02, 0x81, 0x04, 0, 0, 0, 0, 0}}));
  STRCMP_EQUAL(
      "{\"time_s\":null,\"interface\":\"can0\",\"node\":5,\"frame\":\"REQUEST\",\"command\":"
      "\"contact_rate\",\"argument\":200,\"word\":null}\n"
      "{\"time_s\":null,\"interface\":\"can0\",\"node\":5,\"frame\":\"RESPONSE\",\"command\":\"keep\","
      "\"status\":\"wait\",\"value\":45}\n"
      "{\"time_s\":null,\"interface\":\"can0\",\"node\":5,\"frame\":\"RESPONSE\",\"command\":\"tare\","
      "\"status\":\"touched\",\"value\":null}\n",
      printed_.c_str());
}

TEST(FramePrinter, AResponseHasColumnsOfItsOwn) {
  FramePrinter printer(printed_, TableFormat::kCsv);
  CHECK(printer.print(1500000, "can0", {0x585, 8, {0x06, 0x83, 0x07, 0x2D, 0, 0, 0, 0}}));
  STRCMP_CONTAINS(",keep,,,wait,45\n", printed_.c_str());
}

TEST(FramePrinter, QuotesInterfacesWhereTheyNeedIt) {
  FramePrinter csv(printed_, TableFormat::kCsv), json(printed_, TableFormat::kJson);
  CHECK(csv.print({}, "a,\"b", encode(contact_, 5)) && json.print({}, "a\"\xFF", encode(contact_, 5)));
  STRCMP_CONTAINS(",\"a,\"\"b\",5,", printed_.c_str());
  STRCMP_CONTAINS("\"interface\":\"a\\\"\xEF\xBF\xBD\",", printed_.c_str());
}

TEST(FramePrinter, TimesHaveTheDigitsOfTheLog) {
  print(TableFormat::kCsv, ForceFrame{}, 1609779922655421000);
  STRCMP_CONTAINS("1609779922.655421,can0", rows().c_str());
}

TEST(FramePrinter, NanosecondsAreKept) {
  print(TableFormat::kCsv, ForceFrame{}, 1609779922655421789);
  STRCMP_CONTAINS("1609779922.655421789,can0", rows().c_str());
}

TEST(FramePrinter, NoTimeIsAnEmptyField) {
  print(TableFormat::kCsv, ForceFrame{}, std::nullopt);
  STRCMP_CONTAINS(",can0,5,FORCE", rows().c_str());
}

TEST(FramePrinter, ValuesWithoutANameArePrintedAsNumbers) {
  print(TableFormat::kJson, HeartbeatFrame{.state = static_cast<FingerState>(9)});
  STRCMP_CONTAINS("\"state\":\"9\"", printed_.c_str());
}

TEST(FramePrinter, OtherFramesAreNotPrinted) {
  FramePrinter printer(printed_, TableFormat::kJson);
  CHECK_FALSE(printer.print(0, "can0", {0x80, 8, {}}));
  CHECK_FALSE(printer.print(0, "can0", {0x185, 7, {}}));
  STRCMP_EQUAL("", printed_.c_str());
}
