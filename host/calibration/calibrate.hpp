#pragma once
// A finger as it was built, from what its gauges read under touches that nobody need have measured.

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "host/base/failure.hpp"
#include "host/calibration/finger_state.hpp"
#include "host/calibration/moved_zero.hpp"
#include "host/calibration/ring_response.hpp"
#include "host/config/finger_config.hpp"

namespace strainfinger::calibration {

/// What is known of the touch under which a row of readings was taken; what is empty isn't. Both loads 0:
/// nothing touched the finger.
struct KnownTouch {
  std::optional<double> angle_deg = {};
  std::optional<double> normal_n_per_m = {};
  std::optional<double> tangential_n_per_m = {};

  bool isUntouched() const { return normal_n_per_m == 0.0 && tangential_n_per_m == 0.0; }
};

/// Standard deviations of what is known: of a scale and of a hand.
struct KnownErrors {
  double load = 0.01;  ///< relative to the normal load
  double angle_deg = 0.5;
};

/// [noise] Of the largest reading: a weaker touch tells nothing of the finger. Information grows with the
/// square; the touch's own unknowns would only bend the fit, by more than noise where there are thousands.
inline constexpr double kWeakestTouch = 40;

enum class RowUse {
  kFitted,
  kUntouched,     ///< known to be; tells the zeros
  kWeak,          ///< tells little beside noise or beside the others, and is not known to be untouched
  kAmbiguous,     ///< touches at two places or of two widths explain it
  kWide,          ///< of unknown touch, and so wide that it may be a slip or two contacts
  kOverRange,     ///< a gauge at or beyond full scale
  kContradicted,  ///< what is known of the touch is not what its readings say
  kUnexplained,   ///< by no single touch at rest: two contacts, a slip, a zero that moved, another finger
};

struct RowResult {
  RowUse use = RowUse::kWeak;
  TouchState touch = TouchState::Zero();
  double chiSquared = 0;
  Eigen::VectorXd residual_strain;  ///< readings less the model's; empty where nothing was fitted
  int peakGauge = 0;                ///< that reads most, of either sign
};

struct Estimate {
  double value;
  double sigma;
};

class CalibrationResult {
 public:
  CalibrationResult(const Drawing& drawing, Eigen::VectorXd deviations, Eigen::MatrixXd covariance,
                    std::vector<RowResult> rows, Estimate modelError, bool isLoadKnown,
                    std::vector<MovedZero> movedZeros = {}, bool hasSettled = true)
      : drawing_(drawing),
        deviations_(std::move(deviations)),
        covariance_(std::move(covariance)),
        rows_(std::move(rows)),
        modelError_(modelError),
        isLoadKnown_(isLoadKnown),
        movedZeros_(std::move(movedZeros)),
        hasSettled_(hasSettled) {}

  Estimate gain(int gauge) const { return of(gauge, kGain, 1); }
  Estimate zero_strain(int gauge) const { return of(gauge, kZero, 0); }
  Estimate angleOffset_deg(int gauge) const;
  Estimate depthOffset_m(int gauge) const { return of(gauge, kDepthOffset, 0); }
  /// The mean of all offsets of angles: how far the ring as a whole is turned.
  double turn_deg() const;
  /// The part of turn_deg() that applied() writes into [gauges]: all of it where some gauge's offset would
  /// otherwise be outside the domain of calibration.angle_offset_deg, else 0.
  double drawnTurn_deg() const;
  Estimate coreRadius_m() const;
  Estimate poissonRatio() const;
  Estimate shearModulus_pa() const;
  /// Standard deviation of what readings are off the fitted model besides their noise, as a fraction of the
  /// touch's largest reading.
  Estimate modelError() const { return modelError_; }
  double residual_strain(int gauge) const;  ///< RMS over the rows that were fitted

  const std::vector<RowResult>& rows() const { return rows_; }
  int count(RowUse use) const;
  /// See movedZeros(); their rows are left out.
  const std::vector<MovedZero>& movedZeros() const { return movedZeros_; }
  /// False: the fit was stopped after as many steps as are made at most.
  bool hasSettled() const { return hasSettled_; }
  const Drawing& drawing() const { return drawing_; }
  /// What the zero of angles and the unit of force come from: touches, or else the drawing.
  bool isDirectionKnown() const { return drawing_.zeroOfAngle() == ZeroOfAngle::kKnown; }
  bool isLoadKnown() const { return isLoadKnown_; }
  /// In units of the tolerances, see Drawing; and their covariance, the prior counted in.
  const Eigen::VectorXd& deviations() const { return deviations_; }
  const Eigen::MatrixXd& covariance() const { return covariance_; }

  /// The config with all of it: core, Poisson's ratio and modulus in [finger], the gauges in [calibration],
  /// with the errors that what is not known of the finger makes of touches, gauges.model_error, and
  /// drawnTurn_deg() in [gauges]. The finger that [as_built] stands for stays what it is, but for that turn.
  config::FingerConfig applied() const;

 private:
  Estimate of(int gauge, GaugeUnknown unknown, double drawn) const;
  Estimate of(RubberUnknown unknown, double drawn) const;

  Drawing drawing_;
  Eigen::VectorXd deviations_;
  Eigen::MatrixXd covariance_;
  std::vector<RowResult> rows_;
  Estimate modelError_;
  bool isLoadKnown_;
  std::vector<MovedZero> movedZeros_;
  bool hasSettled_;
};

/// Gauges or their wires are to be mended: what was read before tells nothing of the finger afterwards.
class FaultyFinger : public Failure {
 public:
  explicit FaultyFinger(const std::string& message) : Failure(ExitCode::kFailure, message) {}
};

/// Maximum a posteriori estimate of the finger and of every touch together. Likelihood: readings are those of
/// the elastic model, plus noise of gauges.noise_strain and a model error, which is estimated. Prior: the
/// drawing, with the standard deviations of [tolerance]. A touch is a semi-ellipse of pressure with the shear
/// of partial slip; if contact.width_m is known, its second moment is held at w^2 / 12. Rows that no single
/// touch explains, and those of a zero that moved, are left out.
///
/// `known`: one a row, or none at all. `readings`: strain at nominal gain, a row a touch, a column a gauge;
/// all finite. [calibration] of the config is not looked at.
/// Throws Failure(kFailure), saying which row or gauge and what would help: rows that don't pair; a known
/// touch that can't be; known directions, or known loads, most of which the readings contradict; touches that
/// don't determine every gauge; readings that this drawing can't explain; a result outside the config's
/// domains. Throws FaultyFinger, with the repair in its message, for gauges that are dead, loose or wired
/// otherwise than drawn.
/// Cost: linear; 300 touches of 16 gauges take 3 s, 3,000 take 15 s.
CalibrationResult calibrate(const config::FingerConfig& config, std::span<const KnownTouch> known,
                            const Eigen::MatrixXd& readings, const KnownErrors& errors = {});

}  // namespace strainfinger::calibration
