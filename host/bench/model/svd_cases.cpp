// Ways to the singular values of T C, and what the figures cost.

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <functional>

#include "host/base/no_value.hpp"
#include "host/bench/model/measured_case.hpp"
#include "host/bench/model/precise.hpp"
#include "host/bench/model/precise_contact.hpp"
#include "host/contact/decompositions.hpp"
#include "host/contact/jacobi.hpp"
#include "host/contact/slope_map.hpp"
#include "host/paper/figure.hpp"

namespace strainfinger::bench {
namespace {

using namespace contact;
using Eigen::MatrixXd;
using Values = std::vector<double>;

constexpr int kCompared = 14;

SlopeMapRequest request(SlopeRows rows, bool withShear) {
  SlopeMapRequest made;
  made.width_rad = 2e-3 / benchAnnulus().outer_radius_m;
  made.rows = rows;
  made.withShear = withShear;
  return made;
}

Values valuesOf(const std::vector<SingularPair>& pairs) {
  Values values;
  for (const SingularPair& pair : pairs) values.push_back(pair.value);
  return values;
}

Values ours(SlopeRows rows, bool withShear = true) {
  return valuesOf(singularPairs(SlopeMap(benchAnnulus(), request(rows, withShear))));
}

Values sortedValues(const std::vector<MatrixXd>& blocks) {
  Values values;
  for (const MatrixXd& block : blocks) {
    const ThinSvd svd = thinSvd(block);
    values.insert(values.end(), svd.values.begin(), svd.values.end());
  }
  std::ranges::sort(values, std::greater());
  return values;
}

/// Both signs of the angle and both parities in one matrix, as printed: 604 x 604.
Values wholeMatrix() {
  const SlopeMap map(benchAnnulus(), request(SlopeRows::kPrinted, true));
  const MatrixXd odd = map.block(false) / std::numbers::sqrt2, even = map.block(true) / std::numbers::sqrt2;
  MatrixXd all(2 * odd.rows(), 2 * odd.cols());
  all << odd, even, -odd, even;
  return sortedValues({all});
}

/// The blocks of the map's columns over other rows: n sines and cosines of slopes that the columns make.
class Columns {
 public:
  Columns() : annulus_(benchAnnulus()) {
    const SlopeMap map(annulus_, request(SlopeRows::kGauss, true));
    const model::HarmonicModel<double> responses(annulus_, annulus_.outer_radius_m);
    for (const bool isEven : {false, true}) {
      const Eigen::Index unknowns = map.block(isEven).cols();
      MatrixXd& slopes = slopes_[isEven ? 1 : 0];
      for (Eigen::Index k = 0; k < unknowns; ++k) {
        const FourierTractions made = map.tractions(isEven, Eigen::VectorXd::Unit(unknowns, k));
        if (k == 0) slopes.resize(made.rows(), unknowns);
        for (Eigen::Index n = 0; n < made.rows(); ++n) {
          const Eigen::RowVector2d response = responses(static_cast<int>(n)).row(model::kUr);
          const double normal = made(n, isEven ? 1 : 0), shear = made(n, isEven ? 2 : 3);
          slopes(n, k) =
              static_cast<double>(n) * (response[0] * (isEven ? -normal : normal) + response[1] * shear);
        }
      }
    }
  }

  Values values(const Eigen::VectorXd& angles_rad, const Eigen::VectorXd& weights) const {
    std::vector<MatrixXd> blocks;
    for (const bool isEven : {false, true}) {
      const MatrixXd& slopes = slopes_[isEven ? 1 : 0];
      const Eigen::RowVectorXd n =
          Eigen::RowVectorXd::LinSpaced(slopes.rows(), 0, static_cast<double>(slopes.rows() - 1));
      const Eigen::ArrayXXd phases = (angles_rad * n).array();
      const MatrixXd waves = isEven ? MatrixXd(phases.cos()) : MatrixXd(phases.sin());
      blocks.push_back(weights.asDiagonal() * waves * slopes);
    }
    return sortedValues(blocks);
  }

 private:
  model::Annulus<double> annulus_;
  std::array<MatrixXd, 2> slopes_;
};

const Columns& columns() {
  static const Columns made;
  return made;
}

/// The positive half of `count` Gauss-Legendre nodes over the width.
Values gauss(int count) {
  const double half_rad = request(SlopeRows::kGauss, true).width_rad / 2;
  const QuadratureRule rule = gaussRule({0, 0}, count);
  return columns().values(half_rad * rule.nodes.tail(count / 2), rule.weights.tail(count / 2).cwiseSqrt());
}

/// The positive half of `count` even points, the width's ends included.
Values evenPoints(int count) {
  const double half_rad = request(SlopeRows::kGauss, true).width_rad / 2;
  return columns().values(Eigen::VectorXd::LinSpaced(count / 2, half_rad / (count - 1), half_rad),
                          Eigen::VectorXd::Ones(count / 2));
}

/// Worst of the relative values, per largest, against 50 digits.
double errorOf(const Values& values) {
  static const Values known = preciseSingularValues(2e-3, kCompared);
  double worst = 0;
  for (std::size_t i = 0; i < known.size(); ++i) {
    const double value = i < values.size() ? values[i] / values[0] : 0;
    worst = std::max(worst, std::abs(value - known[i] / known[0]));
  }
  return worst;
}

MeasuredCase rowsCase(const char* method, int rows, Values (*make)(int)) {
  return {
      "svd", method, "rows", static_cast<double>(rows), errorOf(make(rows)), [=] { return make(rows)[1]; }};
}

MeasuredCase timeOnly(const char* method, const std::function<Values()>& make) {
  return {"saving", method, "harmonics", 300, kNoValue, [make] { return make()[1]; }};
}

}  // namespace

std::vector<MeasuredCase> svdCases() {
  std::vector<MeasuredCase> cases;
  for (const int rows : {16, 20, 24, 28, 32, 40, 48, 64})
    cases.push_back(rowsCase("Gauss rows", rows, gauss));
  for (const int rows : {40, 80, 160, 320, 604}) cases.push_back(rowsCase("even rows", rows, evenPoints));
  cases.push_back({"svd", "ours", "rows", 46, errorOf(ours(SlopeRows::kGauss)),
                   [] { return ours(SlopeRows::kGauss)[1]; }});
  cases.push_back(
      {"svd", "paper's, one matrix", "rows", 604, errorOf(wholeMatrix()), [] { return wholeMatrix()[1]; }});
  return cases;
}

std::vector<Saving> svdSavings() {
  return {{"the zero half of a parity: two blocks in place of the whole matrix (printed rows)",
           timeOnly("printed rows, by parity", [] { return ours(SlopeRows::kPrinted); }),
           timeOnly("printed rows, one matrix", wholeMatrix)},
          {"rows beyond the band limit: Gauss's in place of the printed ones",
           timeOnly("Gauss rows, shear", [] { return ours(SlopeRows::kGauss); }),
           timeOnly("printed rows, parity again", [] { return ours(SlopeRows::kPrinted); })},
          {"q columns without friction: pressure only in place of pressure and shear",
           timeOnly("Gauss rows, pressure", [] { return ours(SlopeRows::kGauss, false); }),
           timeOnly("Gauss rows, shear too", [] { return ours(SlopeRows::kGauss); })}};
}

std::vector<MeasuredCase> paperCases() {
  const auto data = [] {
    double rows = 0;
    for (const paper::Figure& figure : paper::figures())
      for (const plot::DataFile& file : figure.picture(paper::paperSubject()).data)
        rows += static_cast<double>(file.rows.size());
    return rows;
  };
  const auto claims = [] {
    double count = 0;
    for (const paper::Figure& figure : paper::figures()) count += static_cast<double>(figure.claims().size());
    return count;
  };
  return {{"paper", "data of all figures", "figures", 9, kNoValue, data},
          {"paper", "all claims", "figures", 9, kNoValue, claims}};
}

}  // namespace strainfinger::bench
