#include "host/cli/truth_table.hpp"

#include <fmt/format.h>

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

std::string truthText(const std::vector<Touch>& truth) {
  if (truth.empty()) return kNoTruth;
  const Touch& touch = truth.front();
  return fmt::format("{:6.2f} {:8.2f} {:+8.2f}{}", withinATurn_deg(touch.angle_rad / kRadPerDeg),
                     touch.normal_n_per_m, touch.tangential_n_per_m, truth.size() > 1 ? " and more" : "");
}

std::string differenceText(const ComparedTouch& touch, const config::Finger& finger) {
  if (touch.truth.size() != 1) return "";
  const auto error = simulation::errorOf(touch.report, touch.truth.front(), finger);
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
    write(fmt::format("{:7.3f} | {} | nothing\n", moment.time_s, truthText(moment.truth)));
  else
    return;
  nextLine_s_ += kPeriod_s;
}

void TruthTable::print(const ComparedTouch& touch) const {
  const can::TouchReport& report = touch.report;
  const can::LargestValues& largest = can::largestValues();
  const double length_m = finger_.length_m;
  write(fmt::format(
      "{:7.3f} | {} | {:7.2f} ±{:>6}   {:6.2f} ±{:>6}   {:+7.2f} ±{:>6} |{}{}\n", touch.time_s,
      truthText(touch.truth), report.angle_deg, sigmaText(report.sigmaAngle_deg, largest.sigmaAngle_deg, 1),
      report.normal_n / length_m, sigmaText(report.sigmaNormal_n, largest.sigmaNormal_n, length_m),
      report.tangential_n / length_m,
      sigmaText(report.sigmaTangential_n, largest.sigmaTangential_n, length_m),
      differenceText(touch, finger_), report.flags.has(FingerFlag::kUncertain) ? "  uncertain" : ""));
}

}  // namespace strainfinger::cli
