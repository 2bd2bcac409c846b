#include "host/contact/slope_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/base/failure.hpp"
#include "host/contact/decompositions.hpp"
#include "host/model/harmonic.hpp"
#include "host/model/series.hpp"

namespace strainfinger::contact {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using std::numbers::pi;

double sinc(double x) { return x == 0 ? 1 : std::sin(x) / x; }

/// (1/pi) int (1 + cos(2 pi theta / width))/2 cos n theta dtheta over the width.
VectorXd hanningCoefficients(double width_rad, int count) {
  VectorXd coefficients(count);
  for (int n = 0; n < count; ++n) {
    const double x = n * width_rad / 2;
    coefficients[n] = width_rad / (2 * pi) * (sinc(x) + (sinc(x - pi) + sinc(x + pi)) / 2);
  }
  return coefficients;
}

void requireDomain(const SlopeMapRequest& request) {
  if (!(request.width_rad > 0 && request.width_rad <= pi))
    throw Failure(ExitCode::kUsage, "the width must be above 0 and at most half the surface");
  if (request.harmonics < kLeastHarmonics || request.harmonics > kMostHarmonics)
    throw Failure(ExitCode::kUsage,
                  fmt::format("the harmonics must be from {} to {}", kLeastHarmonics, kMostHarmonics));
}

/// n times the response of u_r to (normal, tangential) tractions, one row a harmonic.
Eigen::MatrixX2d slopeResponses(const model::Annulus<double>& annulus, int harmonics) {
  const model::HarmonicModel<double> harmonic(annulus, annulus.outer_radius_m);
  Eigen::MatrixX2d responses(harmonics + 1, 2);
  for (int n = 0; n <= harmonics; ++n) responses.row(n) = n * harmonic(n).row(model::kUr);
  return responses;
}

}  // namespace

SlopeMap::SlopeMap(const model::Annulus<double>& annulus, const SlopeMapRequest& request)
    : request_(request) {
  requireDomain(request);
  placeRows();
  hanning_ = hanningCoefficients(request.width_rad, 2 * request.harmonics + 1);
  const Index kept = (request.window == WindowCut::kHalf ? request.harmonics / 2 : 2 * request.harmonics) + 1;
  hanning_.tail(hanning_.size() - kept).setZero();
  windowCosines_ = window(false);
  windowSines_ = window(true);
  const Eigen::MatrixX2d responses = slopeResponses(annulus, request.harmonics);
  MatrixXd cosines(angles_rad_.size(), responses.rows()), sines = cosines;
  for (Index i = 0; i < angles_rad_.size(); ++i)
    model::visitMultiples(angles_rad_[i], request.harmonics, [&](int n, double c, double s) {
      cosines(i, n) = weights_[i] * c;
      sines(i, n) = weights_[i] * s;
    });
  // As surfaceAt() has it: u_r' = n (A pressureCos + B shearSin) sin - n (A pressureSin - B shearCos) cos.
  const Index columns = windowCosines_.cols();
  odd_.resize(angles_rad_.size(), columns * (request.withShear ? 2 : 1));
  even_.resizeLike(odd_);
  odd_.leftCols(columns) = sines * (responses.col(0).asDiagonal() * windowCosines_);
  even_.leftCols(columns) = -cosines * (responses.col(0).asDiagonal() * windowSines_);
  if (!request.withShear) return;
  odd_.rightCols(columns) = sines * (responses.col(1).asDiagonal() * windowSines_);
  even_.rightCols(columns) = cosines * (responses.col(1).asDiagonal() * windowCosines_);
}

void SlopeMap::placeRows() {
  const int printed = 2 * request_.harmonics + 4;
  const double half_rad = request_.width_rad / 2;
  if (request_.rows == SlopeRows::kPrinted) {
    const Index half = printed / 2;
    angles_rad_ = VectorXd::LinSpaced(half, half_rad / (printed - 1), half_rad);
    weights_ = VectorXd::Constant(half, std::numbers::sqrt2);
    return;
  }
  const int count = 2 * (12 + static_cast<int>(request_.harmonics * half_rad / 2));
  const QuadratureRule rule = gaussRule({0, 0}, count);
  angles_rad_ = half_rad * rule.nodes.tail(count / 2);
  weights_ = (rule.weights.tail(count / 2) * printed).cwiseSqrt();  // of 2: twice the share of the width
}

/// Window times cos j (sin j), column j, as coefficients of cos n (sin n), row n.
MatrixXd SlopeMap::window(bool ofSines) const {
  MatrixXd result(request_.harmonics + 1, request_.harmonics / 2 + 1);
  for (Index j = 0; j < result.cols(); ++j)
    for (Index n = 0; n < result.rows(); ++n)
      result(n, j) = (hanning_[std::abs(n - j)] + (ofSines ? -1 : 1) * hanning_[n + j]) / 2;
  result.row(0) /= 2;
  return result;
}

FourierTractions SlopeMap::tractions(bool isEvenSlope, const VectorXd& unknowns) const {
  FourierTractions result = FourierTractions::Zero(windowCosines_.rows(), 4);
  const Index columns = windowCosines_.cols();
  result.col(isEvenSlope ? 1 : 0) = (isEvenSlope ? windowSines_ : windowCosines_) * unknowns.head(columns);
  if (request_.withShear)
    result.col(isEvenSlope ? 2 : 3) = (isEvenSlope ? windowCosines_ : windowSines_) * unknowns.tail(columns);
  return result;
}

std::vector<SingularPair> singularPairs(const SlopeMap& map) {
  std::vector<SingularPair> pairs;
  for (const bool isEven : {false, true}) {
    const ThinSvd svd = thinSvd(map.block(isEven));
    for (Index i = 0; i < svd.values.size(); ++i)
      pairs.push_back({svd.values[i], isEven, svd.right.col(i), svd.left.col(i)});
  }
  std::ranges::stable_sort(pairs, std::greater(), &SingularPair::value);
  return pairs;
}

}  // namespace strainfinger::contact
