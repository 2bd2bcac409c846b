#include "host/health/can_links.hpp"

#include <CppUTest/TestHarness.h>

#include <string>

#include "host/base/failure.hpp"

using namespace strainfinger;
using namespace strainfinger::health;

namespace {

/// As iproute2 6.1 prints a loopback, an adapter and a virtual interface.
constexpr const char* kThree =
    R"([{"ifindex":1,"ifname":"lo","flags":["LOOPBACK","UP","LOWER_UP"],"mtu":65536,"link_type":"loopback"},
{"ifindex":5,"ifname":"can0","flags":["NOARP","UP","LOWER_UP","ECHO"],"mtu":16,"qdisc":"pfifo_fast",
 "operstate":"UP","txqlen":10,"link_type":"can","linkinfo":{"info_kind":"can","info_data":{
 "state":"ERROR-PASSIVE","berr_counter":{"tx":128,"rx":7},"restart_ms":100,
 "bittiming":{"bitrate":500000,"sample_point":"0.875","tq":125,"prop_seg":6,"phase_seg1":7,"phase_seg2":2,"sjw":1},
 "clock":24000000}}},
{"ifindex":6,"ifname":"vcan0","flags":["NOARP"],"mtu":72,"link_type":"can","linkinfo":{"info_kind":"vcan"}}])";

}  // namespace

TEST_GROUP(CanLinks) {};

TEST(CanLinks, AreThoseOfCanAlone) {
  const std::vector<CanLink> links = parseCanLinks(kThree);
  LONGS_EQUAL(2, links.size());
  STRCMP_EQUAL("can0", links[0].name.c_str());
  STRCMP_EQUAL("vcan0", links[1].name.c_str());
  CHECK_TRUE(parseCanLinks("[]").empty());
}

TEST(CanLinks, TellOfTheirController) {
  const CanLink can0 = parseCanLinks(kThree)[0];
  CHECK_TRUE(can0.isUp);
  STRCMP_EQUAL("ERROR-PASSIVE", can0.state.c_str());
  LONGS_EQUAL(500'000, can0.bitrate.value());
  DOUBLES_EQUAL(0.875, can0.samplePoint.value(), 0);
  LONGS_EQUAL(100, can0.restart_ms.value());
  LONGS_EQUAL(128, can0.txErrors.value());
  LONGS_EQUAL(7, can0.rxErrors.value());
  CHECK_FALSE(can0.isListenOnly);
}

TEST(CanLinks, AVirtualOneHasNoController) {
  const CanLink vcan0 = parseCanLinks(kThree)[1];
  CHECK_FALSE(vcan0.isUp);
  STRCMP_EQUAL("", vcan0.state.c_str());
  CHECK_FALSE(vcan0.bitrate || vcan0.samplePoint || vcan0.restart_ms || vcan0.txErrors || vcan0.rxErrors);
}

TEST(CanLinks, FractionsMayBeNumbersAndBitRatesFixed) {
  const CanLink link = parseCanLinks(
      R"([{"ifname":"can1","flags":[],"link_type":"can","linkinfo":{"info_kind":"can","info_data":{
      "state":"STOPPED","ctrlmode":["LISTEN-ONLY","TRIPLE-SAMPLING"],"bittiming_bitrate":125000,"bitrate_const":[125000,250000],
      "bittiming":{"sample_point":0.8}}}}])")[0];
  LONGS_EQUAL(125'000, link.bitrate.value());
  DOUBLES_EQUAL(0.8, link.samplePoint.value(), 0);
  CHECK_TRUE(link.isListenOnly);
}

TEST(CanLinks, WhatIsNoSuchListIsToldApart) {
  // The first is what iproute2 before 5.16 does.
  for (
      const char* text :
      {R"([{"ifname":"can0","flags":[],"link_type":"can","linkinfo":{state ERROR-ACTIVE }}])", "", "{}x",
       R"([{"link_type":"can"}])", R"(["can0"])",
       R"([{"ifname":"can0","flags":[],"link_type":"can","linkinfo":{"info_data":{"restart_ms":1e10}}}])",
       R"([{"ifname":"can0","flags":[],"link_type":"can","linkinfo":{"info_data":{"bittiming":{"sample_point":"0.8x"}}}}])"})
    try {
      parseCanLinks(text);
      FAIL(text);
    } catch (const Failure& failure) {
      LONGS_EQUAL(1, static_cast<int>(failure.code()));
      STRCMP_CONTAINS("iproute2", failure.what());
    }
}
