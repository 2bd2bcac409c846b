#include "host/simulation/touch_errors.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/base/angles.hpp"

namespace strainfinger::simulation {
namespace {

/// Of the contact from the touch, the short way around.
double angleOff_rad(const can::ContactReport& contact, const Touch& touch) {
  return shortWay_rad(contact.angle_deg * kRadPerDeg, touch.angle_rad);
}

std::vector<can::ContactReport> contactsOf(const can::TouchReport& report) {
  if (!report.flags.has(FingerFlag::kContact)) return {};
  std::vector<can::ContactReport> contacts{report};
  if (report.second) contacts.push_back(*report.second);
  return contacts;
}

struct Distance {
  double angle_rad;
  std::size_t touch, contact;
};

/// Between all touches and all contacts, the nearest first; a contact of unknown place is far from all.
std::vector<Distance> distancesOf(const std::vector<Touch>& truth,
                                  const std::vector<can::ContactReport>& contacts) {
  std::vector<Distance> distances;
  for (std::size_t touch = 0; touch < truth.size(); ++touch)
    for (std::size_t contact = 0; contact < contacts.size(); ++contact) {
      const double angle_rad = std::fabs(angleOff_rad(contacts[contact], truth[touch]));
      distances.push_back({std::fmin(angle_rad, std::numbers::pi), touch, contact});
    }
  std::ranges::stable_sort(distances, {}, &Distance::angle_rad);
  return distances;
}

}  // namespace

std::vector<ToldTouch> toldTouches(const std::vector<Touch>& truth, const can::TouchReport& report) {
  std::vector<ToldTouch> told;
  for (const Touch& touch : truth) told.push_back({touch, {}});
  const auto contacts = contactsOf(report);
  std::vector<bool> isTaken(contacts.size());
  for (const Distance& distance : distancesOf(truth, contacts)) {
    if (told[distance.touch].contact || isTaken[distance.contact]) continue;
    told[distance.touch].contact = contacts[distance.contact];
    isTaken[distance.contact] = true;
  }
  for (std::size_t i = 0; i < contacts.size(); ++i)
    if (!isTaken[i]) told.push_back({{}, contacts[i]});
  return told;
}

TouchError errorOf(const can::ContactReport& contact, const Touch& truth, const config::Finger& finger) {
  const double radius_m = finger.outer_radius_m, length_m = finger.length_m;
  const double angle_rad = angleOff_rad(contact, truth);
  return {.arc_m = angle_rad * radius_m,
          .normal_n_per_m = contact.normal_n / length_m - truth.normal_n_per_m,
          .tangential_n_per_m = contact.tangential_n / length_m - truth.tangential_n_per_m,
          .sigmaArc_m = contact.sigmaAngle_deg * kRadPerDeg * radius_m,
          .sigmaNormal_n_per_m = contact.sigmaNormal_n / length_m,
          .sigmaTangential_n_per_m = contact.sigmaTangential_n / length_m};
}

void Deviation::add(double value) {
  ++count_;
  squares_ += value * value;
  worst_ = std::max(worst_, std::fabs(value));
}

double Deviation::rms() const { return std::sqrt(squares_ / static_cast<double>(count_)); }

double Deviation::worst() const { return count_ > 0 ? worst_ : kNoValue; }

void TouchErrors::add(const Moment& moment, const config::Finger& finger) {
  if (moment.compared) {
    add(*moment.compared, finger);
    isTold_ = moment.compared->report.flags.has(FingerFlag::kContact);
  }
  if (!moment.truth.empty() && !isTold_) untold_s += SimulatedGauges::kSamplePeriod_us * 1e-6;
}

void TouchErrors::add(const ComparedTouch& compared, const config::Finger& finger) {
  const FingerFlags flags = compared.report.flags;
  const auto told = toldTouches(compared.truth, compared.report);
  if (!flags.has(FingerFlag::kContact)) {
    if (!compared.truth.empty()) ++missed;
  } else if (compared.truth.empty()) {
    ++phantom;
  } else if (flags.has(FingerFlag::kUncertain)) {
    ++uncertain;
  } else if (!std::ranges::all_of(told, &ToldTouch::isWhole)) {
    ++otherNumber;
  } else {
    for (const auto& [truth, contact] : told) add(errorOf(*contact, *truth, finger));
  }
}

void TouchErrors::add(const TouchError& error) {
  arc_m.add(error.arc_m);
  normal_n_per_m.add(error.normal_n_per_m);
  tangential_n_per_m.add(error.tangential_n_per_m);
}

}  // namespace strainfinger::simulation
