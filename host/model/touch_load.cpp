#include "host/model/touch_load.hpp"

#include <algorithm>
#include <cmath>

namespace strainfinger::model {
namespace {

using Eigen::VectorXd;

/// Factors of harmonics 0 .. last and their derivatives to the moment.
struct SpreadFactors {
  VectorXd values, slopes;

  SpreadFactors(Profile profile, double moment_rad2, int last) : values(last + 1), slopes(last + 1) {
    for (int n = 0; n <= last; ++n) {
      const SpreadFactor factor = spreadFactor(profile, n, moment_rad2);
      values[n] = factor.value;
      slopes[n] = factor.slope;
    }
  }
};

}  // namespace

double frictionUsed(const TouchLoad& load) {
  const double most = load.friction * load.normal_n_per_m, shear = std::abs(load.tangential_n_per_m);
  return shear < most ? shear / most : 1;
}

double shearMoment_rad2(const TouchLoad& load) { return load.moment_rad2 * (2 - frictionUsed(load)); }

LoadSpectrum trueSpectrum(const TouchLoad& load, int last) {
  const VectorXd wide = SpreadFactors(load.profile, load.moment_rad2, last).values;
  LoadSpectrum spectrum{load.normal_n_per_m * wide, load.tangential_n_per_m * wide};
  const double stuck = 1 - frictionUsed(load);
  if (load.profile != Profile::kEllipse || stuck == 0) return spectrum;
  const VectorXd narrow = SpreadFactors(load.profile, load.moment_rad2 * stuck, last).values;
  const double slid_n_per_m = std::copysign(load.friction * load.normal_n_per_m, load.tangential_n_per_m);
  spectrum.tangential = slid_n_per_m * (wide - stuck * narrow);
  return spectrum;
}

LoadSpectrum fittedSpectrum(const TouchLoad& load, int last) {
  const SpreadFactors pressure(load.profile, load.moment_rad2, last);
  const SpreadFactors shear(load.profile, shearMoment_rad2(load), last);
  return {load.normal_n_per_m * pressure.values, load.tangential_n_per_m * shear.values};
}

std::array<LoadSpectrum, 3> fittedSlopes(const TouchLoad& load, int last) {
  const SpreadFactors pressure(load.profile, load.moment_rad2, last);
  const SpreadFactors shear(load.profile, shearMoment_rad2(load), last);
  const double used = frictionUsed(load);
  const VectorXd widened = load.tangential_n_per_m * shear.slopes;  // to the shear's own moment
  // The used friction's own derivatives are -used / P and used / Q; in full sliding it stays at 1.
  const bool slides = used == 1;
  const double perNormal = slides ? 0 : load.moment_rad2 * used / load.normal_n_per_m;
  const VectorXd none = VectorXd::Zero(last + 1);
  const double perTangential = slides ? 0 : -load.moment_rad2 * used;
  return {LoadSpectrum{pressure.values, perNormal * widened},
          LoadSpectrum{none, shear.values + perTangential * shear.slopes},
          LoadSpectrum{load.normal_n_per_m * pressure.slopes, (2 - used) * widened}};
}

}  // namespace strainfinger::model
