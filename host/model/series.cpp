#include "host/model/series.hpp"

#include <fmt/format.h>

#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "host/base/failure.hpp"

namespace strainfinger::model {
namespace {

void require(bool holds, const std::string& message) {
  if (!holds) throw Failure(ExitCode::kUsage, message);
}

bool isWindow(double angle_rad) { return angle_rad >= 0 && angle_rad <= 2 * std::numbers::pi; }

}  // namespace

void requireDomain(const Annulus<double>& annulus, double radius_m, const Windows& windows,
                   double tolerance) {
  require(radius_m >= annulus.core_radius_m && radius_m <= annulus.outer_radius_m,
          fmt::format("radius {} m is outside the rubber: it must be from {} to {} m", radius_m,
                      annulus.core_radius_m, annulus.outer_radius_m));
  require(isWindow(windows.load_rad), "the load's width must be from 0 to a whole revolution");
  require(isWindow(windows.gauge_rad), "the gauge's length must be from 0 to a whole revolution");
  require(tolerance > 0 && tolerance < 1, "the tolerance must be above 0 and below 1");
}

namespace {

Failure notConvergent(const Annulus<double>& annulus, double radius_m) {
  return {ExitCode::kUsage,
          fmt::format(
              "radius {} m is too close to the surface at {} m, where the response to a line load is a "
              "delta function: the series needs more than {} harmonics; choose a smaller radius or a wider "
              "load or, for a load of some width, the surface itself",
              radius_m, annulus.outer_radius_m, kMaxHarmonics)};
}

/// Sum of all harmonics after n, as a multiple of harmonic n.
double restAfter(int n, double gamma) {
  const double ratio = gamma * (1 + 1.0 / n) * (1 + 1.0 / n);
  return ratio < 1 ? ratio / (1 - ratio) : std::numeric_limits<double>::infinity();
}

/// Grows one row of the table a harmonic and knows when to stop.
class GrowingSeries {
 public:
  GrowingSeries(std::span<const Row> rows, double gamma, double tolerance)
      : rows_(rows), gamma_(gamma), tolerance_(tolerance), power_(2 * rows.size()) {}

  void append(int n, const HarmonicResponse<double>& response, double factor) {
    done_ = n > 0;
    const double rest = n > 0 ? restAfter(n, gamma_) : 0;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const double larger = response.row(rows_[i]).cwiseAbs().maxCoeff();
      for (const Traction traction : {kNormal, kTangential}) {
        const double value = factor * response(rows_[i], traction);
        double& power = power_[2 * i + static_cast<std::size_t>(traction)];
        power += value * value * (n == 0 ? 1 : 0.5);
        values_.push_back(value);
        if (larger > 0 && larger * rest > tolerance_ * std::sqrt(power)) done_ = false;
      }
    }
  }

  bool done() const { return done_; }

  Eigen::MatrixXd table() const {
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const auto columns = static_cast<Eigen::Index>(power_.size());
    const auto harmonics = static_cast<Eigen::Index>(values_.size()) / columns;
    return Eigen::Map<const RowMajor>(values_.data(), harmonics, columns);
  }

 private:
  std::span<const Row> rows_;
  double gamma_, tolerance_;
  bool done_ = false;
  std::vector<double> power_;
  std::vector<double> values_;
};

}  // namespace

Eigen::MatrixXd truncatedSeries(const Annulus<double>& annulus, double radius_m, std::span<const Row> rows,
                                const Windows& windows, double tolerance) {
  requireDomain(annulus, radius_m, windows, tolerance);
  const HarmonicModel<double> model(annulus, radius_m);
  const double gamma = radius_m / annulus.outer_radius_m;
  const bool hopeless = gamma >= 1 || std::log(tolerance) / std::log(gamma) > kMaxHarmonics;
  GrowingSeries series(rows, gamma, tolerance);
  for (int n = 0; !hopeless && n <= kMaxHarmonics; ++n) {
    series.append(n, model(n), windows.factor(n));
    if (series.done()) return series.table();
  }
  throw notConvergent(annulus, radius_m);
}

namespace {

/// Factors of cos n angle, or of sin n angle, of those rows that have any.
template <typename Scalar>
struct HalfSeries {
  Eigen::MatrixX<Scalar> factors;
  std::vector<Eigen::Index> rows;

  HalfSeries(Eigen::Index harmonics, std::size_t mostRows)
      : factors(harmonics, static_cast<Eigen::Index>(mostRows)) {}

  void append(Eigen::Index row, double load, const auto& responses) {
    if (load == 0) return;
    factors.col(static_cast<Eigen::Index>(rows.size())) = Scalar(load) * responses;
    rows.push_back(row);
  }
  /// Adds the sums over harmonics first, first + 1, ... of as many phases.
  void addTo(auto&& result, const auto& phases, Eigen::Index first) const {
    const auto count = static_cast<Eigen::Index>(rows.size());
    if (count == 0) return;
    const Eigen::RowVectorX<Scalar> sums = phases * factors.block(first, 0, phases.size(), count);
    for (Eigen::Index i = 0; i < count; ++i) result[rows[static_cast<std::size_t>(i)]] += sums[i];
  }
};

}  // namespace

// By the pairing of HarmonicResponse p^c gives cosines of the rows that are even in a normal load and minus
// sines of the others; q^c gives sines and cosines.
template <typename Scalar>
Eigen::MatrixX<Scalar> sumSeries(const Eigen::MatrixX<Scalar>& table, std::span<const Row> rows,
                                 const Annulus<double>& annulus, const SurfaceLoad& load,
                                 std::span<const double> angles_rad) {
  const LineCoefficients line(annulus, load);
  HalfSeries<Scalar> cosines(table.rows(), rows.size()), sines(table.rows(), rows.size());
  for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(rows.size()); ++i) {
    const auto normal = table.col(2 * i + kNormal), tangential = table.col(2 * i + kTangential);
    if (isEvenInNormalLoad(rows[static_cast<std::size_t>(i)])) {
      cosines.append(i, line.normal, normal);
      sines.append(i, line.tangential, tangential);
    } else {
      cosines.append(i, line.tangential, tangential);
      sines.append(i, -line.normal, normal);
    }
  }
  cosines.factors.row(0) /= 2;
  Eigen::MatrixX<Scalar> result = Eigen::MatrixX<Scalar>::Zero(static_cast<Eigen::Index>(angles_rad.size()),
                                                               static_cast<Eigen::Index>(rows.size()));
  const int last = static_cast<int>(table.rows()) - 1;
  Eigen::RowVectorX<Scalar> c(kBlock), s(kBlock);
  for (Eigen::Index k = 0; k < result.rows(); ++k) {
    const Scalar angle = Scalar(angles_rad[static_cast<std::size_t>(k)]) - Scalar(load.centre_rad);
    visitMultiples(angle, last, [&](int n, Scalar cosine, Scalar sine) {
      const int place = n % kBlock;
      c[place] = cosine;
      s[place] = sine;
      if (place < kBlock - 1 && n < last) return;
      cosines.addTo(result.row(k), c.head(place + 1), n - place);
      sines.addTo(result.row(k), s.head(place + 1), n - place);
    });
  }
  return result;
}

template Eigen::MatrixX<double> sumSeries(const Eigen::MatrixX<double>&, std::span<const Row>,
                                          const Annulus<double>&, const SurfaceLoad&,
                                          std::span<const double>);
template Eigen::MatrixX<long double> sumSeries(const Eigen::MatrixX<long double>&, std::span<const Row>,
                                               const Annulus<double>&, const SurfaceLoad&,
                                               std::span<const double>);

}  // namespace strainfinger::model
