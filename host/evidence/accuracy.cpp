#include "host/evidence/accuracy.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <numeric>

#include "host/base/angles.hpp"
#include "host/base/no_value.hpp"

namespace strainfinger::evidence {

double Errors::mean() const {
  return std::accumulate(errors_.begin(), errors_.end(), 0.0) / static_cast<double>(errors_.size());
}

double Errors::rms() const {
  return std::sqrt(std::inner_product(errors_.begin(), errors_.end(), errors_.begin(), 0.0) /
                   static_cast<double>(errors_.size()));
}

double Errors::quantile(double share) const {
  if (errors_.empty()) return kNoValue;
  std::vector<double> magnitudes;
  for (const double error : errors_) magnitudes.push_back(std::abs(error));
  const double place = std::ceil(share * static_cast<double>(magnitudes.size())) - 1;
  const auto at = magnitudes.begin() + static_cast<std::ptrdiff_t>(std::max(place, 0.0));
  std::nth_element(magnitudes.begin(), at, magnitudes.end());
  return *at;
}

void Accuracy::add(const Parameters& truth, const Parameters& bound, const Answer& answer) {
  Parameters error = answer.values - truth;
  error[kAngle] = shortWay_rad(answer.values[kAngle], truth[kAngle]);
  const Parameters overBound = error.cwiseQuotient(bound), overSigma = error.cwiseQuotient(answer.sigmas);
  const bool isGross = !(std::abs(error[kAngle]) <= gross_rad_);  // no number is no place
  const bool isFar = (overSigma.array().abs() > kFarSigmas).any();
  ++touches_;
  flagged_ += answer.isFlagged;
  gross_ += isGross;
  silent_ += isGross && !answer.isFlagged;
  overconfident_ += isFar && !answer.isFlagged;
  const auto keep = [](Errors& errors, double value) {
    if (std::isfinite(value)) errors.add(value);
  };
  for (Eigen::Index i = 0; i < error.size(); ++i) {
    const auto parameter = static_cast<std::size_t>(i);
    if (!isGross) keep(errors_[parameter], error[i]);
    if (!isGross && std::isfinite(bound[i])) keep(overBound_[parameter], overBound[i]);
    if (!answer.isFlagged) keep(overSigma_[parameter], overSigma[i]);
  }
}

}  // namespace strainfinger::evidence
