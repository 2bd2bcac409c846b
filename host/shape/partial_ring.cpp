#include "host/shape/partial_ring.hpp"

#include <numeric>

namespace strainfinger::shape {

config::FingerConfig withGauges(const config::FingerConfig& config, const std::vector<int>& gauges) {
  config::FingerConfig partial = config;
  partial.gauges.count = static_cast<int>(gauges.size());
  partial.gauges.angles_deg.clear();
  for (const int gauge : gauges) partial.gauges.angles_deg.push_back(config.gauges.angle_deg(gauge));
  for (std::vector<double> config::Calibration::*list :
       {&config::Calibration::gain, &config::Calibration::angle_offset_deg,
        &config::Calibration::depth_offset_m}) {
    const std::vector<double>& all = config.calibration.*list;
    if (all.empty()) continue;
    (partial.calibration.*list).clear();
    for (const int gauge : gauges)
      (partial.calibration.*list).push_back(all[static_cast<std::size_t>(gauge)]);
  }
  return partial;
}

RingEstimators::RingEstimators(const config::FingerConfig& config) : config_(config) {
  std::vector<int> all(static_cast<std::size_t>(config.gauges.count));
  std::iota(all.begin(), all.end(), 0);
  by(all);
}

const ShapeEstimator& RingEstimators::by(const std::vector<int>& gauges) {
  auto& estimator = made_[gauges];
  if (!estimator) {
    const bool areAll = static_cast<int>(gauges.size()) == config_.gauges.count;
    estimator = std::make_unique<const ShapeEstimator>(areAll ? config_ : withGauges(config_, gauges),
                                                       config::isSparse(config_));
  }
  return *estimator;
}

}  // namespace strainfinger::shape
