#include "host/simulation/scenario.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

#include "host/base/angles.hpp"

namespace strainfinger::simulation {
namespace {

/// Without the rounding of the subtraction, which would leave 1e-14 N/m of a load that is over.
double since(double start_s, double time_s) { return std::round(1e9 * (time_s - start_s)) / 1e9; }

Touch touchAt(const TouchCourse& touch, double time_s) {
  const double since_s = since(touch.start_s, time_s);
  Touch now{touch.angle_deg.at(since_s) * kRadPerDeg, touch.normal_n_per_m.at(since_s),
            touch.tangential_n_per_m.at(since_s)};
  if (touch.width_m) now.width_m = touch.width_m->at(since_s);
  now.profile = touch.profile;
  return now;
}

}  // namespace

Course::Course(std::vector<Point> points) : points_(std::move(points)) { assert(!points_.empty()); }

double Course::at(double time_s) const {
  const auto later = [](double time, const Point& point) { return time < point.time_s; };
  const auto next = std::upper_bound(points_.begin(), points_.end(), time_s, later);
  if (next == points_.begin()) return points_.front().value;
  if (next == points_.end()) return points_.back().value;
  const auto last = next - 1;
  return std::lerp(last->value, next->value, (time_s - last->time_s) / (next->time_s - last->time_s));
}

Course::Point Course::largest() const { return *std::ranges::max_element(points_, {}, &Point::value); }

Scenario::Scenario(std::vector<TouchCourse> touches, std::optional<double> repeat_s, double pause_s)
    : touches_(std::move(touches)), repeat_s_(repeat_s), pause_s_(pause_s) {}

std::vector<Touch> Scenario::at(double time_s) const {
  const double within_s = repeat_s_ ? std::fmod(time_s, *repeat_s_ + pause_s_) : time_s;
  std::vector<Touch> inForce;
  for (const TouchCourse& course : touches_) {
    if (within_s < course.start_s || within_s >= course.end_s) continue;
    const Touch touch = touchAt(course, within_s);
    if (touch.normal_n_per_m != 0) inForce.push_back(touch);
  }
  return inForce;
}

std::optional<Scenario::Slip> Scenario::firstSlip(double friction_coefficient) const {
  int number = 0;
  for (const TouchCourse& course : touches_) {
    ++number;
    const Touch touch = touchAt(course, course.start_s + course.normal_n_per_m.largest().time_s);
    if (touch.normal_n_per_m > 0 &&
        std::abs(touch.tangential_n_per_m) > friction_coefficient * touch.normal_n_per_m)
      return Slip{number, touch};
  }
  return std::nullopt;
}

double Scenario::widest_m() const {
  double widest_m = 0;
  for (const TouchCourse& touch : touches_)
    if (touch.width_m) widest_m = std::max(widest_m, touch.width_m->largest().value);
  return widest_m;
}

double Scenario::duration_s() const {
  double end_s = 0;
  for (const TouchCourse& touch : touches_) end_s = std::max(end_s, touch.end_s);
  return repeat_s_.value_or(end_s);
}

}  // namespace strainfinger::simulation
