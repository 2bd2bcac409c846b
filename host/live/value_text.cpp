#include "host/live/value_text.hpp"

#include <fmt/format.h>

#include <cmath>

#include "host/base/angles.hpp"
#include "host/can/remedies.hpp"
#include "host/live/words.hpp"

namespace strainfinger::live {
namespace {

constexpr const char* kUnknown = "?";

constexpr const char* kOrMore = ">=";  // not ≥: a screen may have ASCII alone

/// Before what stands for that or anything beyond it.
const char* beyondMark(const Said& said) {
  if (!(std::abs(said.value) >= said.largest)) return "";
  return said.value < 0 ? "<=" : kOrMore;
}

std::string numberText(const Said& said, int decimals) {
  if (std::isnan(said.value)) return kUnknown;
  return fmt::format("{}{:.{}f}", beyondMark(said), said.value, decimals);
}

std::string withSigma(const std::string& value, const Said& sigma, int decimals, const char* unit) {
  return fmt::format("{} ± {}{}{}", value, numberText(sigma, decimals), *unit == '\0' ? "" : " ", unit);
}

std::string touchText(const can::TouchReport& touch) {
  std::string text = fmt::format("angle {}  normal {}  tangential {}  width {}", angleText(touch),
                                 normalText(touch), tangentialText(touch), widthText(touch));
  if (touch.second)
    text += fmt::format("  second {}, {}, {}", angleText(*touch.second), normalText(*touch.second),
                        tangentialText(*touch.second));
  return text;
}

std::string stateText(const FingerView& finger) {
  if (finger.isTouched()) return touchText(*finger.touch);
  return finger.touch ? "nothing touches it" : "no touch known";
}

}  // namespace

std::string measured(const Said& value, const Said& sigma, int decimals, const char* unit) {
  if (std::isnan(value.value)) return kUnknown;
  return withSigma(numberText(value, decimals), sigma, decimals, unit);
}

std::string measuredSigned(const Said& value, const Said& sigma, int decimals, const char* unit) {
  if (std::isnan(value.value)) return kUnknown;
  return withSigma(fmt::format("{}{:+.{}f}", beyondMark(value), value.value, decimals), sigma, decimals,
                   unit);
}

std::string angleText(const can::ContactReport& contact) {
  return measured({contact.angle_deg}, {contact.sigmaAngle_deg, can::largestValues().sigmaAngle_deg}, 2,
                  "deg");
}

std::string normalText(const can::ContactReport& contact) {
  return measured({contact.normal_n, can::largestValues().normal_n},
                  {contact.sigmaNormal_n, can::largestValues().sigmaNormal_n}, 3, "N");
}

std::string tangentialText(const can::ContactReport& contact) {
  return measuredSigned({contact.tangential_n, can::largestValues().tangential_n},
                        {contact.sigmaTangential_n, can::largestValues().sigmaTangential_n}, 3, "N");
}

std::string widthText(const can::TouchReport& touch) {
  const can::LargestValues& largest = can::largestValues();
  return measured({touch.width_m * 1e3, largest.width_m * 1e3},
                  {touch.sigmaWidth_m * 1e3, largest.sigmaWidth_m * 1e3}, 2, "mm");
}

std::string durationText(std::uint16_t seconds) {
  if (seconds == kNotKnown<std::uint16_t>) return kUnknown;
  return fmt::format("{}{}:{:02}:{:02}", can::isLargest(seconds) ? kOrMore : "", seconds / 3600,
                     seconds / 60 % 60, seconds % 60);
}

std::string qualityText(const can::ContactReport& contact) {
  if (std::isnan(contact.quality_percent)) return {};
  const std::string quality = fmt::format("quality {:.0f} %", contact.quality_percent);
  if (std::isnan(contact.alternative_deg)) return quality;
  const bool isOrBeyond = std::abs(contact.alternative_deg) >= can::largestValues().alternative_deg;
  return fmt::format("{} or at {:.0f} deg{}", quality,
                     withinATurn_deg(contact.angle_deg + contact.alternative_deg),
                     isOrBeyond ? " or beyond" : "");
}

std::string stateWord(const FingerView& finger) {
  if (finger.isForeign()) return "another protocol";
  return finger.isSilent() ? "silent" : wordFor(kFingerStateNames, static_cast<int>(finger.heartbeat.state));
}

namespace {

/// Of the finger as a whole, whatever it says of itself.
std::vector<std::string> outwardTroublesOf(const FingerView& finger) {
  std::vector<std::string> troubles;
  if (finger.isSilent())
    troubles.push_back(fmt::format("silent for {:.1f} s", static_cast<double>(finger.silence_us) / 1e6));
  else if (finger.isForeign())
    troubles.push_back(can::foreignText(finger.heartbeat.protocol));
  if (finger.hasTwin)
    troubles.push_back(
        fmt::format("{}: {}", can::kTwinText, can::forNode(can::kTwinRemedy, finger.bus, finger.node)));
  if (finger.hasOtherTables) troubles.push_back("its tables are not those of the config (-c)");
  return troubles;
}

void addGaugesOutOfUse(const FingerView& finger, std::vector<std::string>& troubles) {
  const auto gauges = bitNumbers(finger.gauges ? finger.gauges->out_of_use : 0);
  if (!gauges.empty()) troubles.push_back(fmt::format("gauges out of use: {}", fmt::join(gauges, ", ")));
}

}  // namespace

std::vector<std::string> troublesOf(const FingerView& finger) {
  std::vector<std::string> troubles = outwardTroublesOf(finger);
  for (const int bit : bitNumbers(finger.heartbeat.faults.raw())) {
    const ValueName* const name = can::findName(kFingerFaultNames, bit);
    troubles.push_back(fmt::format("fault {}{}{}", wordFor(kFingerFaultNames, bit),
                                   name != nullptr ? ": " : "", name != nullptr ? name->comment : ""));
  }
  addGaugesOutOfUse(finger, troubles);
  return troubles;
}

std::string warningsText(const FingerView& finger) {
  std::vector<std::string> warnings = outwardTroublesOf(finger);
  const auto faults = wordsFor(kFingerFaultNames, finger.heartbeat.faults.raw());
  if (!faults.empty()) warnings.push_back(fmt::format("faults: {}", fmt::join(faults, ", ")));
  addGaugesOutOfUse(finger, warnings);
  return fmt::format("{}", fmt::join(warnings, "; "));
}

std::string flagsText(const FingerView& finger) {
  if (!finger.touch) return {};
  FingerFlags flags = finger.touch->flags;
  flags.set(FingerFlag::kContact, false);
  return fmt::format("{}", fmt::join(wordsFor(kFingerFlagNames, flags.raw()), ", "));
}

std::string plainLine(const BusView& bus, const FingerView& finger) {
  std::string line = fmt::format("{:.3f} s  {} node {}  {}  {}  {} contacts/s  {} lost",
                                 static_cast<double>(bus.time_us) / 1e6, bus.name, finger.node,
                                 stateWord(finger), stateText(finger), finger.contactsPerSecond, finger.lost);
  for (const std::string& more : {flagsText(finger), warningsText(finger)})
    if (!more.empty()) line.append("  ").append(more);
  return line;
}

}  // namespace strainfinger::live
