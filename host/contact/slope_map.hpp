#pragma once
// The paper's map T C from windowed tractions to the slope of the surface, and its singular values.

#include <Eigen/Core>
#include <vector>

#include "host/contact/fourier_tractions.hpp"

namespace strainfinger::contact {

/// Where the slope is looked at.
enum class SlopeRows {
  kGauss,    ///< so many Gauss-Legendre nodes that nothing is lost: the continuum's singular values
  kPrinted,  ///< the paper's 2 n_c + 4 even points, both edges included (eq. 5, theta_w the total width)
};

/// Up to which harmonic the Hanning window's coefficients go.
enum class WindowCut {
  kHalf,  ///< n_c / 2, as printed: products end at n_c
  kFull,  ///< as far as products reach n_c, where they are cut
};

inline constexpr int kLeastHarmonics = 2, kMostHarmonics = 5'000;

struct SlopeMapRequest {
  double width_rad = 0;   ///< of the contact
  int harmonics = 300;    ///< n_c
  bool withShear = true;  ///< false: a frictionless indenter's columns only
  SlopeRows rows = SlopeRows::kGauss;
  WindowCut window = WindowCut::kHalf;
};

/// Unknowns are the Fourier coefficients 0..n_c/2 of a pressure and a shear, which the Hanning window over
/// the contact confines to it before they act (paper, sec. 4, eq. 5 to 13). Cosines of the pressure and sines
/// of the shear make odd slopes, the others even ones, so that the map is two blocks over half the points
/// each. The slope of the constant term is 0 (in eq. 9 a displacement stands there).
class SlopeMap {
 public:
  /// Domain: 0 < width_rad <= pi, kLeastHarmonics <= harmonics <= kMostHarmonics. Throws Failure(kUsage)
  /// outside it. Costs 1 ms for 2 mm and 300 harmonics by Gauss's rows, without shear half.
  SlopeMap(const model::Annulus<double>& annulus, const SlopeMapRequest& request);

  /// Rows: the angles, each times its weight [m/rad]; columns: unknowns of the pressure, then of the shear
  /// [Pa].
  const Eigen::MatrixXd& block(bool isEvenSlope) const { return isEvenSlope ? even_ : odd_; }

  const Eigen::VectorXd& angles_rad() const { return angles_rad_; }  ///< the positive ones
  /// What a slope at these angles is multiplied by: the root of the point's share of the width times
  /// 2 n_c + 4, and of 2 for the negative angle. So singular values are those of the printed sampling.
  const Eigen::VectorXd& weights() const { return weights_; }

  /// The windowed tractions that unknowns of a block stand for (C in the paper).
  FourierTractions tractions(bool isEvenSlope, const Eigen::VectorXd& unknowns) const;

 private:
  void placeRows();
  Eigen::MatrixXd window(bool ofSines) const;

  SlopeMapRequest request_;
  Eigen::VectorXd angles_rad_, weights_;
  Eigen::VectorXd hanning_;  // (1/pi) int window cos n theta
  Eigen::MatrixXd windowCosines_, windowSines_;
  Eigen::MatrixXd even_, odd_;
};

/// A matched pair of slope and tractions.
struct SingularPair {
  double value = 0;          ///< [m/(rad Pa)]
  bool isEvenSlope = false;  ///< even slope, odd shape, odd pressure; or the reverse
  Eigen::VectorXd unknowns;  ///< of the block, of norm 1: a column of V
  Eigen::VectorXd slopes;    ///< weighted, at the map's angles, of norm 1: a column of U
};

/// All pairs of both blocks, largest value first. Costs 2 ms by Gauss's rows for 2 mm and 300 harmonics, 100
/// ms by the printed ones.
std::vector<SingularPair> singularPairs(const SlopeMap& map);

}  // namespace strainfinger::contact
