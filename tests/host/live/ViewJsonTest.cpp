#include "host/live/view_json.hpp"

#include "host/live/value_text.hpp"
#include "tests/host/live/views.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::live;

TEST_GROUP(ViewJson) {
  nlohmann::ordered_json jsonOf(const FingerView& finger) {
    return toJson(busWith({finger})).at("fingers").at(0);
  }
};

TEST(ViewJson, NumbersAreInSiUnits) {
  FingerView finger = touchedFinger();
  finger.touched_us = 12'250'000;
  const auto json = jsonOf(finger);
  const auto& touch = json.at("touch");
  DOUBLES_EQUAL(0.282, touch.at("normal_n"), 0);
  DOUBLES_EQUAL(0.003, touch.at("sigma_tangential_n"), 0);
  DOUBLES_EQUAL(0.00204, touch.at("width_m"), 0);
  DOUBLES_EQUAL(12.25, touch.at("time_s"), 0);
  DOUBLES_EQUAL(0.0002, json.at("jitter_s"), 0);
  LONGS_EQUAL(3723, json.at("uptime_s"));
}

TEST(ViewJson, WhatIsNotKnownIsNull) {
  FingerView finger = touchedFinger();
  finger.touch->angle_deg = kNoValue;
  finger.heartbeat.uptime_s = kNotKnown<std::uint16_t>;
  finger.heartbeat.temperature_degC = kNotKnown<std::int8_t>;
  finger.gauges.reset();
  const auto json = jsonOf(finger);
  CHECK_TRUE(json.at("touch").at("angle_deg").is_null());
  CHECK_TRUE(json.at("touch").at("second").is_null());
  for (const char* key : {"uptime_s", "temperature_degc", "gauges", "info"})
    CHECK_TRUE(json.at(key).is_null());
  CHECK_TRUE(json.at("span").at("most_normal_n").is_null());
}

TEST(ViewJson, ValuesThatStandForThatOrMoreAreListedByTheirKeys) {
  FingerView finger = touchedFinger();
  STRCMP_EQUAL("[]", jsonOf(finger).at("or_more").dump().c_str());
  STRCMP_EQUAL("[]", jsonOf(finger).at("touch").at("or_more").dump().c_str());
  finger.touch->tangential_n = -32.767;
  finger.touch->sigmaNormal_n = 0.127;
  finger.touch->sigmaWidth_m = 0.065534;
  finger.touch->chi = 15.875;
  finger.touch->second = can::ContactReport{.sigmaAngle_deg = 655.34, .sigmaTangential_n = 0.127};
  finger.heartbeat.uptime_s = 0xFFFE;
  finger.gauges->zero_age_s = 0xFFFE;
  const auto json = jsonOf(finger);
  const auto& touch = json.at("touch");
  STRCMP_EQUAL("[\"tangential_n\",\"sigma_normal_n\",\"sigma_width_m\",\"chi\"]",
               touch.at("or_more").dump().c_str());
  DOUBLES_EQUAL(0.127, touch.at("sigma_normal_n"), 0);
  STRCMP_EQUAL("[\"sigma_angle_deg\",\"sigma_tangential_n\"]",
               touch.at("second").at("or_more").dump().c_str());
  STRCMP_EQUAL("[\"uptime_s\"]", json.at("or_more").dump().c_str());
  STRCMP_EQUAL("[\"zero_age_s\"]", json.at("gauges").at("or_more").dump().c_str());
}

TEST(ViewJson, FlagsFaultsAndGaugesAreLists) {
  FingerView finger = touchedFinger();
  finger.heartbeat.faults = {FingerFault::kNoisy};
  finger.gauges->out_of_use = 0x8001;
  const auto json = jsonOf(finger);
  STRCMP_EQUAL("[\"contact\",\"stale_zero\",\"simulated\"]", json.at("touch").at("flags").dump().c_str());
  STRCMP_EQUAL("[\"noisy\"]", json.at("faults").dump().c_str());
  STRCMP_EQUAL("[0,15]", json.at("gauges").at("out_of_use").dump().c_str());
}

TEST(ViewJson, AFingerThatSaysNothingHasNoTouch) {
  FingerView finger = touchedFinger();
  finger.silence_us = 2'000'000;
  finger.touch.reset();
  CHECK_TRUE(jsonOf(finger).at("silent"));
  DOUBLES_EQUAL(2, jsonOf(finger).at("silence_s"), 0);
  CHECK_TRUE(jsonOf(finger).at("touch").is_null());
  STRCMP_EQUAL("[\"silent for 2.0 s\"]", jsonOf(finger).at("troubles").dump().c_str());
}

TEST(ViewJson, AFingerOfAnotherProtocolHasNoState) {
  FingerView finger = touchedFinger();
  finger.heartbeat = {.protocol = kProtocolVersion + 1};
  const auto json = jsonOf(finger);
  for (const char* key : {"state", "uptime_s", "temperature_degc"}) CHECK_TRUE(json.at(key).is_null());
  STRCMP_EQUAL("[]", json.at("faults").dump().c_str());  // the page goes through it
  LONGS_EQUAL(kProtocolVersion + 1, json.at("protocol").get<int>());
  CHECK_TRUE(json.at("foreign"));
  STRCMP_EQUAL("another protocol", stateWord(finger).c_str());
}

TEST(ViewJson, TroublesAreInTheWordsOfTheTerminal) {
  FingerView finger = touchedFinger();
  STRCMP_EQUAL("[]", jsonOf(finger).at("troubles").dump().c_str());
  finger.hasTwin = finger.hasOtherTables = true;
  const auto json = jsonOf(finger);
  for (const auto& trouble : json.at("troubles"))
    STRCMP_CONTAINS(trouble.get<std::string>().c_str(), warningsText(finger).c_str());
  LONGS_EQUAL(2, json.at("troubles").size());
  STRCMP_CONTAINS("`strainfinger config --can can0 -n 1 --set-node NODE`",
                  json.at("troubles").at(0).get<std::string>().c_str());
}

TEST(ViewJson, TheShapeIsTheConfigs) {
  config::FingerConfig config;
  config.gauges.count = 4;
  STRCMP_EQUAL(
      "{\"core_radius_m\":0.0089,\"outer_radius_m\":0.0127,\"gauge_radius_m\":0.0094,"
      "\"gauge_angles_deg\":[0.0,90.0,180.0,270.0]}",
      toJson(config).dump().c_str());
}
