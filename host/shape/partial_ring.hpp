#pragma once
// A ring of which some gauges are left out.

#include <map>
#include <memory>
#include <vector>

#include "host/shape/shape.hpp"

namespace strainfinger::shape {

/// The finger with only these of its gauges: ascending, one at least.
config::FingerConfig withGauges(const config::FingerConfig& config, const std::vector<int>& gauges);

/// Estimators of a finger by all of its gauges, and by some of them, made when they are asked for; that is
/// what they cost.
class RingEstimators {
 public:
  /// Throws as ShapeEstimator does.
  explicit RingEstimators(const config::FingerConfig& config);

  /// `gauges` as in withGauges(), five at least. Stays where it is.
  const ShapeEstimator& by(const std::vector<int>& gauges);

 private:
  config::FingerConfig config_;
  std::map<std::vector<int>, std::unique_ptr<const ShapeEstimator>> made_;
};

}  // namespace strainfinger::shape
