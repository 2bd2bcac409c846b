#include "host/bench/score.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/fixed_real.hpp"

namespace strainfinger::bench {
namespace {

constexpr double kGross_pitch = 0.5;

Eigen::Vector3d errorOf(const Place<double>& answer, const Place<double>& truth) {
  const double apart = std::remainder(answer.position_pitch - truth.position_pitch, double{kGauges});
  return {std::isfinite(apart) ? apart : kGauges / 2.0, answer.normal - truth.normal,
          answer.tangential - truth.tangential};
}

}  // namespace

Place<double> placeOf(const TableImage& tables, const Contact& contact) {
  const std::uint32_t beyond_q32 = contact.angle.raw() - tables.gauge_angle_q32[0];
  const double turn = std::ldexp(static_cast<std::int32_t>(beyond_q32), -32);
  return {turn * kGauges, toReal(contact.normal), toReal(contact.tangential)};
}

Place<double> placeOf(const TableImage& tables, const OwnLocator& locator) {
  return placeOf(tables, locator.contact());
}

Place<double> placeOf(const TableImage&, const Place<float>& place) {
  return {double{place.position_pitch}, double{place.normal}, double{place.tangential}};
}

Place<double> placeOf(const TableImage&, const Place<double>& place) { return place; }

Score scoreOf(const BenchFinger& finger, std::span<const Reading> readings,
              std::span<const Place<double>> answers) {
  Score score;
  score.readings = static_cast<int>(readings.size());
  Eigen::Vector3d overBound = Eigen::Vector3d::Zero(), squares = overBound;
  double worst = 0, squaresOfAll = 0, bounds = 0;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const Eigen::Vector3d error = errorOf(answers[i], readings[i].truth);
    squaresOfAll += error[0] * error[0];
    bounds += std::pow(readings[i].bound[0], 2);
    if (std::abs(error[0]) > kGross_pitch) {
      ++score.gross;
      continue;
    }
    squares += error.cwiseAbs2();
    overBound += error.cwiseQuotient(readings[i].bound).cwiseAbs2();
    worst = std::max(worst, std::abs(error[0]));
  }
  const double right = score.readings - score.gross;
  const Eigen::Vector3d rms = (squares / right).cwiseSqrt();
  const bool noisy = readings.front().bound[0] > 0;
  score.overBound = noisy ? (overBound / right).cwiseSqrt().eval()
                          : Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()).eval();
  score.arc_um = finger.arc_um(rms[0]);
  score.arcBound_um = finger.arc_um(std::sqrt(bounds / score.readings));
  score.arcWorst_um = finger.arc_um(worst);
  score.arcOfAll_um = finger.arc_um(std::sqrt(squaresOfAll / score.readings));
  score.normal_n_per_m = rms[1];
  score.tangential_n_per_m = rms[2];
  return score;
}

}  // namespace strainfinger::bench
