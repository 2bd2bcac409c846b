#pragma once
// What of a run is needed for its picture.

#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "host/plot/touch_picture.hpp"
#include "host/simulation/simulated_finger.hpp"
#include "host/simulation/strain_fit.hpp"

namespace strainfinger::cli {

/// Keeps one point of the track every kTrackPeriod_s, and the readings of the set with the greatest loads, if
/// possible of one whose contacts were all told. Memory: 10 kB per second of the run.
class TouchRecorder {
 public:
  static constexpr double kTrackPeriod_s = 0.025;  ///< 10 s make an SVG of 250 kB

  /// `told`: what the firmware knows of the finger; `factors`: what it multiplies the strains by, one a gauge
  /// (tables::correctionFactors()).
  TouchRecorder(const config::FingerConfig& told, std::vector<double> factors)
      : told_(told), fit_(told), factors_(std::move(factors)) {}

  /// `readings`: the firmware's of that moment.
  void add(const simulation::Moment& moment, const firmware::Readings& readings);

  /// What there is to draw: the truth is of `strains`, of the finger that was recorded, and the fit of what
  /// the firmware knows of it, so that gauge less fit is what the firmware could not explain.
  plot::TouchRecord record(const simulation::GaugeStrains& strains) const;

 private:
  /// Touches that are not told, and contacts that are none, negative; the loads in all. What is greater is
  /// shown.
  using Worth = std::pair<std::ptrdiff_t, double>;
  static Worth worthOf(const simulation::ComparedTouch& compared);
  void addToTrack(const simulation::Moment& moment);

  config::FingerConfig told_;
  simulation::StrainFit fit_;
  std::vector<double> factors_;
  std::vector<plot::TrackPoint> track_;
  double periodEnd_s_ = 0;
  bool isTold_ = false;  ///< the last point of the track is of a report
  simulation::ComparedTouch shown_;
  Worth worth_{std::numeric_limits<std::ptrdiff_t>::min(), 0};
  firmware::Readings readings_;  ///< of what is shown
};

}  // namespace strainfinger::cli
