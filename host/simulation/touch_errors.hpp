#pragma once
// How far reports are from the truth.

#include <cstdint>
#include <optional>
#include <vector>

#include "host/config/finger_config.hpp"
#include "host/simulation/simulated_finger.hpp"

namespace strainfinger::simulation {

/// A touch and the contact that was told of it; one of them may be missing.
struct ToldTouch {
  std::optional<Touch> truth;
  std::optional<can::ContactReport> contact;
  bool isWhole() const { return truth && contact; }
};

/// The touches, in order, each with the contact that is nearest to it and to no other touch that is left;
/// then the contacts of no touch. A report that nothing touches has no contacts.
std::vector<ToldTouch> toldTouches(const std::vector<Touch>& truth, const can::TouchReport& report);

/// One contact against one true touch. Sigmas are those reported, NaN where not known.
struct TouchError {
  double arc_m = 0;  ///< of the surface, the short way around, towards +theta
  double normal_n_per_m = 0;
  double tangential_n_per_m = 0;
  double sigmaArc_m = 0;
  double sigmaNormal_n_per_m = 0;
  double sigmaTangential_n_per_m = 0;
};
TouchError errorOf(const can::ContactReport& contact, const Touch& truth, const config::Finger& finger);

/// Root mean square and largest magnitude of what was added.
class Deviation {
 public:
  void add(double value);
  double rms() const;  ///< NaN without any, as worst()
  double worst() const;
  std::uint64_t count() const { return count_; }

 private:
  std::uint64_t count_ = 0;
  double squares_ = 0;
  double worst_ = 0;
};

/// Statistics over the contacts of a run's reports.
struct TouchErrors {
  Deviation arc_m;
  Deviation normal_n_per_m;
  Deviation tangential_n_per_m;
  std::uint64_t uncertain = 0;    ///< reports flagged so: they don't count above
  std::uint64_t otherNumber = 0;  ///< reports of more or fewer contacts than there were touches: nor do these
  std::uint64_t phantom = 0;      ///< reports of a contact while nothing touched
  std::uint64_t missed = 0;       ///< reports of no contact while something touched
  double untold_s = 0;  ///< for which something touched and the last report, if any, was of no contact

  /// A sample set, with the report that was complete with it, if any.
  void add(const Moment& moment, const config::Finger& finger);
  void add(const ComparedTouch& compared, const config::Finger& finger);

 private:
  void add(const TouchError& error);

  bool isTold_ = false;
};

}  // namespace strainfinger::simulation
