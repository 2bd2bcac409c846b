#include "host/live/view_json.hpp"

#include <cmath>
#include <initializer_list>
#include <span>
#include <utility>

#include "host/can/frame_catalogue.hpp"
#include "host/live/value_text.hpp"
#include "host/live/words.hpp"

namespace strainfinger::live {
namespace {

using Json = nlohmann::ordered_json;

Json numberOrNull(double value) { return std::isnan(value) ? Json() : Json(value); }

Json listOrNull(const std::vector<double>& values) { return values.empty() ? Json() : Json(values); }

template <typename Raw>
Json knownOrNull(Raw raw) {
  return raw == kNotKnown<Raw> ? Json() : Json(raw);
}

/// As `decode` gives them.
Json namesOf(std::span<const ValueName> names, std::uint32_t bits) {
  Json list = Json::array();
  for (const int bit : bitNumbers(bits)) list.push_back(can::nameText(names, bit));
  return list;
}

/// The keys of values that stand for themselves or more: the largest that a finger can say.
Json keysOf(std::initializer_list<std::pair<const char*, bool>> isOrMore) {
  Json keys = Json::array();
  for (const auto& [key, is] : isOrMore)
    if (is) keys.push_back(key);
  return keys;
}

Json contactJson(const can::ContactReport& contact) {
  const can::LargestValues& largest = can::largestValues();
  return {
      {"angle_deg", numberOrNull(contact.angle_deg)},
      {"sigma_angle_deg", numberOrNull(contact.sigmaAngle_deg)},
      {"alternative_deg", numberOrNull(contact.alternative_deg)},
      {"normal_n", numberOrNull(contact.normal_n)},
      {"sigma_normal_n", numberOrNull(contact.sigmaNormal_n)},
      {"tangential_n", numberOrNull(contact.tangential_n)},
      {"sigma_tangential_n", numberOrNull(contact.sigmaTangential_n)},
      {"quality_percent", numberOrNull(contact.quality_percent)},
      {"or_more", keysOf({{"normal_n", std::abs(contact.normal_n) >= largest.normal_n},
                          {"tangential_n", std::abs(contact.tangential_n) >= largest.tangential_n},
                          {"alternative_deg", std::abs(contact.alternative_deg) >= largest.alternative_deg},
                          {"sigma_angle_deg", contact.sigmaAngle_deg >= largest.sigmaAngle_deg},
                          {"sigma_normal_n", contact.sigmaNormal_n >= largest.sigmaNormal_n},
                          {"sigma_tangential_n", contact.sigmaTangential_n >= largest.sigmaTangential_n}})}};
}

Json touchJson(const FingerView& finger) {
  const can::TouchReport& touch = *finger.touch;
  const can::LargestValues& largest = can::largestValues();
  Json json = contactJson(touch);
  json["time_s"] = static_cast<double>(finger.touched_us) / 1e6;
  json["since_s"] = static_cast<double>(finger.since_us) / 1e6;
  json["width_m"] = numberOrNull(touch.width_m);
  json["sigma_width_m"] = numberOrNull(touch.sigmaWidth_m);
  json["chi"] = numberOrNull(touch.chi);
  for (const Json& key : keysOf({{"width_m", touch.width_m >= largest.width_m},
                                 {"sigma_width_m", touch.sigmaWidth_m >= largest.sigmaWidth_m},
                                 {"chi", touch.chi >= largest.chi}}))
    json["or_more"].push_back(key);
  json["touched"] = touch.flags.has(FingerFlag::kContact);
  json["flags"] = namesOf(kFingerFlagNames, touch.flags.raw());
  json["sequence"] = touch.sequence;
  json["second"] = touch.second ? contactJson(*touch.second) : Json();
  return json;
}

Json spanJson(const ForceSpan& span) {
  return {{"least_normal_n", numberOrNull(span.leastNormal_n)},
          {"most_normal_n", numberOrNull(span.mostNormal_n)},
          {"least_tangential_n", numberOrNull(span.leastTangential_n)},
          {"most_tangential_n", numberOrNull(span.mostTangential_n)}};
}

Json gaugesJson(const GaugesFrame& gauges) {
  const Json rate = knownOrNull(gauges.zero_rate_nano_per_s);
  return {{"out_of_use", bitNumbers(gauges.out_of_use)},
          {"zero_age_s", knownOrNull(gauges.zero_age_s)},
          {"zero_rate_per_s", rate.is_null() ? rate : Json(gauges.zero_rate_nano_per_s / 1e9)},
          {"or_more", keysOf({{"zero_age_s", can::isLargest(gauges.zero_age_s)},
                              {"zero_rate_per_s", can::isLargest(gauges.zero_rate_nano_per_s)}})}};
}

Json infoJson(const InfoFrame& info) {
  return {{"version", std::to_string(info.version_major) + "." + std::to_string(info.version_minor)},
          {"board", info.board},
          {"reset_cause", can::nameText(kResetCauseNames, static_cast<int>(info.reset_cause))},
          {"crash", can::nameText(kCrashNames, static_cast<int>(info.crash))}};
}

const char* nameOf(hal::CanState state) {
  switch (state) {
    case hal::CanState::kActive:
      return "active";
    case hal::CanState::kWarning:
      return "warning";
    case hal::CanState::kPassive:
      return "passive";
    case hal::CanState::kBusOff:
      return "bus_off";
    case hal::CanState::kDown:
      break;
  }
  return "down";
}

Json fingerJson(const FingerView& finger) {
  const HeartbeatFrame& heartbeat = finger.heartbeat;
  return {{"node", finger.node},
          {"silence_s", static_cast<double>(finger.silence_us) / 1e6},
          {"silent", finger.isSilent()},
          {"protocol", heartbeat.protocol},
          {"foreign", finger.isForeign()},
          {"state", finger.isForeign()
                        ? Json()
                        : Json(can::nameText(kFingerStateNames, static_cast<int>(heartbeat.state)))},
          {"faults", namesOf(kFingerFaultNames, heartbeat.faults.raw())},
          {"table_crc", finger.isForeign() ? Json() : Json(fmt::format("{:02X}", heartbeat.table_crc))},
          {"uptime_s", knownOrNull(heartbeat.uptime_s)},
          {"temperature_degc", knownOrNull(heartbeat.temperature_degC)},
          {"contacts_per_s", finger.contactsPerSecond},
          {"jitter_s", numberOrNull(finger.jitter_s)},
          {"received", finger.received},
          {"lost", finger.lost},
          {"restarts", finger.restarts},
          {"has_twin", finger.hasTwin},
          {"other_tables", finger.hasOtherTables},
          {"troubles", troublesOf(finger)},
          {"strongest_n", finger.strongest_n},
          {"touch", finger.touch ? touchJson(finger) : Json()},
          {"span", spanJson(finger.span)},
          {"strains", listOrNull(finger.strains)},
          {"fitted", listOrNull(finger.fitted)},
          {"gauges", finger.gauges ? gaugesJson(*finger.gauges) : Json()},
          {"info", finger.info ? infoJson(*finger.info) : Json()},
          {"or_more", keysOf({{"uptime_s", can::isLargest(heartbeat.uptime_s)}})}};
}

}  // namespace

Json toJson(const BusView& bus) {
  Json fingers = Json::array();
  for (const FingerView& finger : bus.fingers) fingers.push_back(fingerJson(finger));
  return {{"bus", bus.name},
          {"bus_state", nameOf(bus.state)},
          {"time_s", static_cast<double>(bus.time_us) / 1e6},
          {"frames_per_s", bus.framesPerSecond},
          {"load", bus.load},
          {"missed", bus.missed},
          {"fingers", std::move(fingers)}};
}

Json toJson(const config::FingerConfig& config) {
  Json gauges = Json::array();
  for (int gauge = 0; gauge < config.gauges.count; ++gauge) gauges.push_back(config.gauges.angle_deg(gauge));
  return {{"core_radius_m", config.finger.core_radius_m},
          {"outer_radius_m", config.finger.outer_radius_m},
          {"gauge_radius_m", config.gauges.radius_m},
          {"gauge_angles_deg", std::move(gauges)}};
}

}  // namespace strainfinger::live
