#include "host/tables/response_table.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/model/impulse_response.hpp"
#include "host/model/pressure_profile.hpp"
#include "host/model/series.hpp"

namespace strainfinger::tables {
namespace {

using Eigen::Index, Eigen::MatrixXd;
using std::numbers::pi;

/// Of the elastic model, relative to the peak: a patch's weights are rounded to 3e-5 of it.
constexpr double kPatchTolerance = 1e-7;

/// Chebyshev points that a patch is fitted to in each direction.
constexpr int kPoints = 4;
constexpr int kWeights = static_cast<int>(std::tuple_size_v<ResponsePatch>);

using Samples = Eigen::Matrix<double, kPoints, kPoints>;  ///< at (second moment, angle)
using Design = Eigen::Matrix<double, kPoints * kPoints, kWeights>;
using Weights = Eigen::Vector<double, kWeights>;

double chebyshev(int i) { return std::cos((2 * i + 1) * pi / (2 * kPoints)); }

/// A patch's polynomial, in the order of ResponsePatch.
Eigen::RowVector<double, kWeights> basis(double s, double t) {
  return Eigen::RowVector<double, kWeights>{1, s, t, t * t, s * t, s * s};
}

Design makeDesign() {
  Design design;
  for (int i = 0; i < kPoints; ++i)
    for (int j = 0; j < kPoints; ++j) design.row(i * kPoints + j) = basis(chebyshev(j), chebyshev(i));
  return design;
}

/// Edges of the cells of the second moment [* 2^15]. Of an unknown width they are even steps of the width. Of
/// a known one they divide what the shear's moment can be, from half of the largest to all of it.
std::vector<int> cellEdges_q15(const config::Contact& contact) {
  if (contact.width_m)
    return *contact.width_m == 0 ? std::vector{0, 1 << 15} : std::vector{0, 1 << 14, 3 << 13, 1 << 15};
  std::vector<int> edges;
  for (int k = 0; k <= kMostCells; ++k) edges.push_back(k * k * (1 << 15) / (kMostCells * kMostCells));
  return edges;
}

/// What is below half of a known width's moment is in the table, but never looked up.
bool isUsed(const config::Contact& contact, int cell) { return contact.width_m.value_or(0) == 0 || cell > 0; }

/// Nodes with which the patches of a line load, whose response is the narrowest, are off by half a step of
/// their weights at most: a cubic term c t^3 / 6 leaves c / 24 at Chebyshev points, and c is at most
/// sum n^3 |h_n| times the cube of half the angle between nodes.
int enoughNodes(const model::ImpulseResponse& response) {
  double cubic = 0, peak = 0;
  for (int n = 0; n <= response.harmonics(); ++n) {
    const double harmonic = std::max(std::abs(response.even()[n]), std::abs(response.odd()[n]));
    cubic += harmonic * n * n * n;
    peak += harmonic;
  }
  const double halfNode_rad = std::cbrt(24 * std::ldexp(peak, -16) / cubic);
  return static_cast<int>(std::ceil(std::min<double>(pi / 2 / halfNode_rad, kMostPatches)));
}

/// A load's harmonics under the moments at which the patches are sampled, a column each, cell by cell.
MatrixXd spreadHarmonics(const Eigen::VectorXd& harmonics, const std::vector<int>& edges_q15,
                         double largestMoment_rad2) {
  const Index cells = static_cast<Index>(edges_q15.size()) - 1;
  MatrixXd columns(harmonics.size(), cells * kPoints);
  for (Index cell = 0; cell < cells; ++cell)
    for (int j = 0; j < kPoints; ++j) {
      const double low = edges_q15[static_cast<std::size_t>(cell)],
                   high = edges_q15[static_cast<std::size_t>(cell) + 1];
      const double part = std::ldexp(low + high + chebyshev(j) * (high - low), -16);
      for (Index n = 0; n < harmonics.size(); ++n)
        columns(n, cell * kPoints + j) =
            harmonics[n] *
            model::spreadFactor(model::Profile::kEllipse, static_cast<int>(n), part * largestMoment_rad2)
                .value;
    }
  return columns;
}

/// Nodes whose responses are summed in one product of matrices.
constexpr int kBatch = 8;

/// Cosines and sines of the harmonics, a column for each angle at which a batch of nodes is sampled.
struct Waves {
  MatrixXd cosines, sines;

  Waves(int firstNode, int nodes, Index harmonics)
      : cosines(harmonics, kBatch * kPoints), sines(harmonics, kBatch * kPoints) {
    for (int column = 0; column < kBatch * kPoints; ++column) {
      const double node = firstNode + column / kPoints + 0.5 + chebyshev(column % kPoints) / 2;
      double* cosine = cosines.col(column).data();
      double* sine = sines.col(column).data();
      model::visitMultiples(node * pi / nodes, static_cast<int>(harmonics) - 1,
                            [&](int n, double c, double s) {
                              cosine[n] = c;
                              sine[n] = s;
                            });
    }
  }
};

/// Patches to a load, as real numbers.
struct Patches {
  Eigen::Matrix<double, kWeights, Eigen::Dynamic> weights;
  Eigen::VectorXd error;  ///< the largest of each patch

  explicit Patches(int count) : weights(kWeights, count), error(count) {}
};

/// Lagrange's polynomial of a Chebyshev point.
double lagrange(int point, double x) {
  double product = 1;
  for (int i = 0; i < kPoints; ++i)
    if (i != point) product *= (x - chebyshev(i)) / (chebyshev(point) - chebyshev(i));
  return product;
}

/// The least-squares fit to a patch's samples. Its error is that to the cubic through the samples, which is
/// largest at the patch's corners and edges.
class PatchFit {
 public:
  PatchFit() {
    const Design design = makeDesign();
    projection_ = (design.transpose() * design).inverse() * design.transpose();
    for (int j = 0; j < kChecks; ++j)
      for (int i = 0; i < kChecks; ++i) setCheck(j * kChecks + i, checkAt(j), checkAt(i));
  }

  void operator()(const Samples& samples, int patch, Patches& patches) const {
    patches.weights.col(patch) = projection_ * samples.reshaped();
    patches.error[patch] = (check_ * samples.reshaped()).cwiseAbs().maxCoeff();
  }

 private:
  static constexpr int kChecks = 5;
  static double checkAt(int i) { return 2.0 * i / (kChecks - 1) - 1; }
  void setCheck(int row, double s, double t) {
    check_.row(row) = basis(s, t) * projection_;
    for (int i = 0; i < kPoints; ++i)
      for (int j = 0; j < kPoints; ++j) check_(row, i * kPoints + j) -= lagrange(j, s) * lagrange(i, t);
  }

  Eigen::Matrix<double, kWeights, kPoints * kPoints> projection_;
  Eigen::Matrix<double, kChecks * kChecks, kPoints * kPoints> check_;
};

/// Fits a batch of nodes; `columns` as spreadHarmonics() makes them.
void fitBatch(const MatrixXd& waves, const MatrixXd& columns, int firstNode, int nodes, Patches& patches) {
  static const PatchFit fit;
  const MatrixXd samples = columns.transpose() * waves;
  const int cells = static_cast<int>(columns.cols()) / kPoints;
  for (int node = firstNode; node < std::min(firstNode + kBatch, nodes); ++node)
    for (int cell = 0; cell < cells; ++cell)
      fit(samples.block<kPoints, kPoints>(cell * kPoints, (node - firstNode) * kPoints), node * cells + cell,
          patches);
}

ResponsePatch rounded(const Weights& weights, double unit) {
  ResponsePatch patch;
  for (int i = 0; i < kWeights; ++i)
    patch[static_cast<std::size_t>(i)] =
        static_cast<std::int16_t>(std::lround(std::ldexp(weights[i] / unit, 15)));
  return patch;
}

double largestSum(const Patches& patches) { return patches.weights.cwiseAbs().colwise().sum().maxCoeff(); }

int signOfLargest(const Patches& patches) {
  Index patch;
  patches.weights.row(0).cwiseAbs().maxCoeff(&patch);
  return patches.weights(0, patch) < 0 ? -1 : 1;
}

/// Weights' sizes add up to less than 2^15 after rounding, which may add 1/2 to each of them.
constexpr double kLargestSum = 32768 - 8;

void roundPatches(const config::Contact& contact, const Patches& normal, const Patches& tangential,
                  double growth, ResponseTable& table) {
  table.peakSign = signOfLargest(normal);
  table.strainPerUnit =
      (1 + growth) * std::max(largestSum(normal), largestSum(tangential)) * (32768 / kLargestSum);
  table.interpolationError = 0;
  for (int patch = 0; patch < table.nodes * table.cells; ++patch) {
    table.patches.push_back({rounded(normal.weights.col(patch), table.strainPerUnit),
                             rounded(tangential.weights.col(patch), table.strainPerUnit)});
    if (!isUsed(contact, patch % table.cells)) continue;
    table.interpolationError =
        std::max(table.interpolationError,
                 std::max(normal.error[patch], tangential.error[patch]) / table.strainPerUnit);
  }
}

}  // namespace

double largestMoment_m2(const config::FingerConfig& config) {
  const double radius_m = config.finger.outer_radius_m;
  const double width_rad = config.contact.width_m.value_or(config.contact.largest_width_m) / radius_m;
  return model::momentOf(model::Profile::kUniform, width_rad) * radius_m * radius_m;
}

ResponseTable responseTable(const config::FingerConfig& config, double growth) {
  const model::ImpulseResponse response(config.finger.annulus(), config.gauges.radius_m,
                                        config.gauges.component, config.gauges.arc_length_m, 0,
                                        kPatchTolerance);
  const std::vector<int> edges_q15 = cellEdges_q15(config.contact);
  ResponseTable table{};
  table.cells = static_cast<int>(edges_q15.size()) - 1;
  table.nodes = std::clamp(enoughNodes(response), kLeastNodes, kMostPatches / table.cells);
  std::copy(edges_q15.begin(), edges_q15.end(), table.cell_edge_q15.begin());
  table.largestMoment_m2 = largestMoment_m2(config);
  const double largest_rad2 = table.largestMoment_m2 / std::pow(config.finger.outer_radius_m, 2);
  const bool even = response.isEvenInNormal();
  const MatrixXd normalColumns =
      spreadHarmonics(even ? response.even() : response.odd(), edges_q15, largest_rad2);
  const MatrixXd tangentialColumns =
      spreadHarmonics(even ? response.odd() : response.even(), edges_q15, 2 * largest_rad2);
  Patches normal(table.nodes * table.cells), tangential(table.nodes * table.cells);
  for (int node = 0; node < table.nodes; node += kBatch) {
    const Waves waves(node, table.nodes, response.harmonics() + 1);
    fitBatch(even ? waves.cosines : waves.sines, normalColumns, node, table.nodes, normal);
    fitBatch(even ? waves.sines : waves.cosines, tangentialColumns, node, table.nodes, tangential);
  }
  roundPatches(config.contact, normal, tangential, growth, table);
  return table;
}

}  // namespace strainfinger::tables
