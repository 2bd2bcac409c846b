#pragma once
// What pressed on the finger, from one row of gauge strains: as much as they tell, and no more.

#include <optional>

#include "host/config/ring_spacing.hpp"
#include "host/config/unseen_errors.hpp"
#include "host/shape/curvature.hpp"
#include "host/shape/resolved_pressure.hpp"
#include "host/shape/touch_search.hpp"

namespace strainfinger::shape {

/// An estimate and its standard deviation.
struct Measured {
  double value;
  double sigma;
};

/// Holds what is estimated with 95 %.
struct Band {
  double low;
  double high;
};

/// What is measured is that of the profile, if there is one, and of an ellipse if there is none.
struct Shape {
  Touch touch;  ///< the best one, of elliptic pressure
  Measured angle_rad{};
  Measured normal_n_per_m{};
  Measured tangential_n_per_m{};
  /// Width of the semi-ellipse with the load's second moment; nothing if a line load fits within kSure.
  std::optional<Measured> width_m;
  double widthLimit_m = 0;  ///< the width is below with 95 %, told from a line or not
  /// Of a round indenter that makes such a width under such a load (0: flat); with the width only.
  /// Its errors are skewed, more than the width's: the band is not symmetric, and open above where infinite.
  std::optional<Measured> curvature_per_m;
  std::optional<Band> curvatureBand_per_m;
  int directions = 0;          ///< of a pressure of this width that are above the noise, as ResolvedPressure
  bool isOddResolved = false;  ///< whether an uneven pressure would show
  /// The profile that fits better than all others by kSure; nothing if the readings don't separate them.
  std::optional<Profile> profile;
  /// Of residuals as large as these or larger from noise alone; with a width those of the best profile.
  double fitProbability = 0;
  std::optional<double> rivalAngle_rad;
  /// The ring's pitch is above config::kSparse: then there is neither width nor class, and answers may be
  /// farther off than their sigmas say.
  bool isSparse = false;
  /// Another profile fits the readings too, and has a load, place or width outside its band of 95 %: what is
  /// estimated is that of an elliptic pressure, if it is one.
  bool isOfEllipse = false;
  bool isWidthAtLimit = false;  ///< as wide or as narrow as the fit may go: the width is not to be trusted
  /// Standard deviation of a reading from the model: noise, and the model error of these readings.
  double deviation_strain = 0;
};

/// Below this probability residuals are not noise: two touches, a bad gauge, another noise.
inline constexpr double kUnlikely = 1e-3;

/// The estimator of one finger. Immutable; costs 20 ms to make, 70 ms for 32 gauges.
class ShapeEstimator {
 public:
  /// Noise and model error are those of config.gauges, friction and component are the config's, gauges where
  /// its calibration says; its contact width isn't used.
  explicit ShapeEstimator(const config::FingerConfig& config)
      : ShapeEstimator(config, config::isSparse(config)) {}
  /// The same of a ring of which gauges were left out; whether it is sparse is a matter of the whole one.
  ShapeEstimator(const config::FingerConfig& config, bool isSparse);

  /// Nothing if the finger isn't touched. Domain: a finite strain a gauge, less its zero and over its gain.
  /// `largest_strain`: of the touch, where it is a gauge's that was left out. Costs 3 ms for 32 gauges in the
  /// default finger.
  std::optional<Shape> estimate(const Eigen::VectorXd& strains, double largest_strain = 0) const;

  /// The resolved part of the pressure at offsets from the touch's angle, over its width, or over the limit
  /// of the width where there is none.
  PressureEstimate pressure(const Shape& shape, const Eigen::VectorXd& strains,
                            const Eigen::VectorXd& offsets_rad) const;

  /// Half of the arc that pressure() speaks of [rad].
  double pressedHalf_rad(const Shape& shape) const;

  const TouchModel& model() const { return model_; }

 private:
  ResolvedPressure resolution(const Shape& shape) const;
  void addMeasures(const TouchFit& noisy, Shape& shape) const;
  void addClass(const TouchFit& ellipse, const Eigen::VectorXd& strains, Shape& shape) const;
  double probability(double chiSquared) const;
  void addUnseenErrors(TouchFit& fit) const;

  config::FingerConfig config_;
  TouchModel model_;
  TouchSearch search_;
  CurvatureScale curvature_;
  config::UnseenErrors unseen_;
  bool isSparse_;
};

}  // namespace strainfinger::shape
