#pragma once
// What touches the finger, and when.

#include <optional>
#include <vector>

#include "host/model/pressure_profile.hpp"

namespace strainfinger::simulation {

/// One contact at one moment. Angles counter-clockwise seen from the tip, not reduced to a revolution; the
/// normal load is positive pressing, the tangential load positive towards growing angles.
struct Touch {
  double angle_rad = 0;
  double normal_n_per_m = 0;
  double tangential_n_per_m = 0;
  /// Width of the contact, the full base of its pressure as an arc of the surface (fingers report 0.87 of a
  /// semi-ellipse's); 0: a line load. Empty: contact.width_m of the finger's
  /// config, pressed uniformly; where that is unknown too, a line load.
  std::optional<double> width_m = {};
  model::Profile profile = model::Profile::kEllipse;
  bool operator==(const Touch&) const = default;
};

/// A quantity over time: straight lines between points, constant before the first and after the last.
class Course {
 public:
  struct Point {
    double time_s;
    double value;
  };
  /// At least one point, in order of time; of two points at one time the later one counts from there on.
  explicit Course(std::vector<Point> points);
  double at(double time_s) const;
  /// The point of the largest value, the first of equal ones.
  Point largest() const;

 private:
  std::vector<Point> points_;
};

/// One contact over its life; the courses count time from its start.
struct TouchCourse {
  double start_s;
  double end_s;
  Course angle_deg;
  Course normal_n_per_m;
  Course tangential_n_per_m;
  std::optional<Course> width_m = {};  ///< empty: as Touch
  model::Profile profile = model::Profile::kEllipse;
};

/// Touches over time, once or over and over again.
class Scenario {
 public:
  /// `repeat_s` > 0: begin again after this time, which no touch outlasts, and `pause_s` more, in which
  /// nothing touches.
  explicit Scenario(std::vector<TouchCourse> touches, std::optional<double> repeat_s = std::nullopt,
                    double pause_s = 0);

  /// The touches in force: start <= time < end, and some normal load, without which nothing touches, whatever
  /// the tangential one. Linear in the number of touches.
  std::vector<Touch> at(double time_s) const;

  /// The first touch, of those that press, that no friction holds even where it presses most; its number
  /// counts from 1.
  struct Slip {
    int number;
    Touch touch;
  };
  std::optional<Slip> firstSlip(double friction_coefficient) const;

  /// The largest width of a touch; 0 where none has one.
  double widest_m() const;

  /// When it is over, once: without the pause before it begins again.
  double duration_s() const;

 private:
  std::vector<TouchCourse> touches_;
  std::optional<double> repeat_s_;
  double pause_s_;
};

}  // namespace strainfinger::simulation
