#include "host/cli/truth_table.hpp"

#include <fmt/format.h>

#include <optional>
#include <string>

#include "host/base/angles.hpp"
#include "host/simulation/touch_errors.hpp"

namespace strainfinger::cli {
namespace {

using simulation::ComparedTouch;
using simulation::Touch;

constexpr const char* kHeading =
    "        |          truth           |            estimate, with its sigma            | estimate - truth\n"
    "   time |  angle   normal  tangent |      angle            normal           tangent |   arc  normal "
    "tangent\n"
    "      s |    deg      N/m      N/m |        deg               N/m               N/m |    mm     N/m     "
    "N/m\n";
constexpr const char* kNoTruth = "     -        -        -";

/// In contact a finger has something to say every kContactPeriod_ms; a beat more and it says nothing.
constexpr double kSilence_s = 1.2e-3 * kContactPeriod_ms;

std::string truthText(const std::optional<Touch>& touch) {
  if (!touch) return kNoTruth;
  return fmt::format("{:6.2f} {:8.2f} {:+8.2f}", degreesOf(touch->angle_rad), touch->normal_n_per_m,
                     touch->tangential_n_per_m);
}

std::string differenceText(const can::ContactReport& contact, const std::optional<Touch>& touch,
                           const config::Finger& finger) {
  if (!touch) return "";
  const auto error = simulation::errorOf(contact, *touch, finger);
  return fmt::format(" {:+6.3f}  {:+6.2f}  {:+6.2f}", error.arc_m * 1e3, error.normal_n_per_m,
                     error.tangential_n_per_m);
}

/// Over `unit`; the largest that a finger can say stands for anything beyond it too.
std::string sigmaText(double sigma, double largest, double unit) {
  return fmt::format("{}{:.2f}", sigma >= largest ? ">=" : "", sigma / unit);
}

}  // namespace

TruthTable::TruthTable(std::FILE* stream, const config::Finger& finger) : stream_(stream), finger_(finger) {
  std::fputs(kHeading, stream_);
}

void TruthTable::add(const simulation::Moment& moment) {
  if (moment.compared) inContact_ = moment.compared->report.flags.has(FingerFlag::kContact);
  if (moment.time_s < nextLine_s_) return;
  if (moment.compared && inContact_)
    print(*moment.compared);
  else if ((moment.truth.empty() && !inContact_) || moment.time_s > nextLine_s_ + kSilence_s)
    print({moment.time_s, moment.truth, {}});
  else
    return;
  nextLine_s_ += kPeriod_s;
}

void TruthTable::print(const ComparedTouch& compared) const {
  auto told = simulation::toldTouches(compared.truth, compared.report);
  if (told.empty()) told.emplace_back();
  const char* const doubt = compared.report.flags.has(FingerFlag::kUncertain) ? "  uncertain" : "";
  std::string time = fmt::format("{:7.3f}", compared.time_s);
  for (const auto& [touch, contact] : told) {
    write(fmt::format("{} | {} | {}\n", time, truthText(touch),
                      contact ? estimateText(*contact, touch) + doubt : "nothing"));
    time.assign(time.size(), ' ');
  }
}

std::string TruthTable::estimateText(const can::ContactReport& contact,
                                     const std::optional<Touch>& touch) const {
  const can::LargestValues& largest = can::largestValues();
  const double length_m = finger_.length_m;
  return fmt::format(
      "{:7.2f} ±{:>6}   {:6.2f} ±{:>6}   {:+7.2f} ±{:>6} |{}", contact.angle_deg,
      sigmaText(contact.sigmaAngle_deg, largest.sigmaAngle_deg, 1), contact.normal_n / length_m,
      sigmaText(contact.sigmaNormal_n, largest.sigmaNormal_n, length_m), contact.tangential_n / length_m,
      sigmaText(contact.sigmaTangential_n, largest.sigmaTangential_n, length_m),
      differenceText(contact, touch, finger_));
}

}  // namespace strainfinger::cli
