#include "host/tables/response_table.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "host/model/impulse_response.hpp"

namespace strainfinger::tables {
namespace {

constexpr int kPoints = 4;  ///< Chebyshev points a patch has in each direction

double chebyshev(int i) { return std::cos((2 * i + 1) * std::numbers::pi / (2 * kPoints)); }

/// Basis of a patch at (s, t), in the order of ResponsePatch.
Eigen::RowVectorXd basis(double s, double t) {
  Eigen::RowVectorXd row(6);
  row << 1, s, t, t * t, s * t, s * s;
  return row;
}

/// Weights from values at the Chebyshev points, t fastest.
Eigen::MatrixXd fitMatrix(bool wide) {
  const int columns = wide ? kPoints : 1;
  Eigen::MatrixXd design(kPoints * columns, 6);
  for (int j = 0; j < columns; ++j)
    for (int i = 0; i < kPoints; ++i)
      design.row(j * kPoints + i) = basis(wide ? chebyshev(j) : 0, chebyshev(i));
  return design.completeOrthogonalDecomposition().pseudoInverse();
}

/// What a semi-elliptic traction of half width a makes of harmonic n: 2 J1(n a) / (n a).
double semiEllipse(double x) { return x < 1e-4 ? 1 - x * x / 8 : 2 * std::cyl_bessel_j(1.0, x) / x; }

/// Responses (rows: angles; columns: moments) of the harmonics' sums.
Eigen::MatrixXd values(const Eigen::VectorXd& harmonics, const Eigen::MatrixXd& waves,
                       const std::vector<double>& halfWidths_rad) {
  Eigen::MatrixXd windowed(harmonics.size(), static_cast<Eigen::Index>(halfWidths_rad.size()));
  for (Eigen::Index j = 0; j < windowed.cols(); ++j)
    for (Eigen::Index n = 0; n < windowed.rows(); ++n)
      windowed(n, j) =
          harmonics[n] * semiEllipse(static_cast<double>(n) * halfWidths_rad[static_cast<std::size_t>(j)]);
  return waves * windowed;
}

}  // namespace

ResponseTable responseTable(const config::FingerConfig& config) {
  const bool wide = !std::getenv("KNOWN");
  ResponseTable table;
  table.nodes = wide ? 96 : 384;
  table.cells = wide ? 8 : 1;
  const double largest = 8e-3;
  table.largestMoment_m2 = largest * largest / 12;
  for (int k = 0; k <= table.cells; ++k)
    table.cell_edge_q15[static_cast<std::size_t>(k)] =
        static_cast<std::uint16_t>(std::lround(32768 * std::pow(double(k) / table.cells, 1.5)));
  for (int k = 0; k < table.cells; ++k)
    table.cell_rate_q8[static_cast<std::size_t>(k)] =
        static_cast<std::uint16_t>(2.0 * 256 * 32768 /
                                   (table.cell_edge_q15[static_cast<std::size_t>(k + 1)] -
                                    table.cell_edge_q15[static_cast<std::size_t>(k)]));
  const model::ImpulseResponse response(config.finger.annulus(), config.gauges.radius_m,
                                        config.gauges.component, config.gauges.arc_length_m, 0, 1e-9);
  table.peakSign = response.at(0).normal < 0 ? -1 : 1;
  const Eigen::Index harmonics = response.harmonics() + 1;
  // Cosines and sines at the Chebyshev angles of every node.
  Eigen::MatrixXd cosines(table.nodes * kPoints, harmonics), sines(table.nodes * kPoints, harmonics);
  for (int node = 0; node < table.nodes; ++node)
    for (int i = 0; i < kPoints; ++i) {
      const double angle = (node + 0.5 + chebyshev(i) / 2) * std::numbers::pi / table.nodes;
      const double c1 = std::cos(angle), s1 = std::sin(angle);
      double c = 1, s = 0;
      for (Eigen::Index n = 0; n < harmonics; ++n) {
        cosines(node * kPoints + i, n) = c;
        sines(node * kPoints + i, n) = s;
        const double next = c * c1 - s * s1;
        s = s * c1 + c * s1;
        c = next;
      }
    }
  const int columns = wide ? kPoints : 1;
  std::vector<double> normalHalf, tangentialHalf;
  for (int k = 0; k < table.cells; ++k)
    for (int j = 0; j < columns; ++j) {
      const double low = table.cell_edge_q15[static_cast<std::size_t>(k)] / 32768.0,
                   high = table.cell_edge_q15[static_cast<std::size_t>(k + 1)] / 32768.0;
      const double u = wide ? (low + high) / 2 + chebyshev(j) * (high - low) / 2 : 0;
      normalHalf.push_back(2 * std::sqrt(u * table.largestMoment_m2) / config.finger.outer_radius_m);
      tangentialHalf.push_back(std::numbers::sqrt2 * normalHalf.back());
    }
  const bool even = response.isEvenInNormal();
  const Eigen::MatrixXd normal =
      values(even ? response.even() : response.odd(), even ? cosines : sines, normalHalf);
  const Eigen::MatrixXd tangential =
      values(even ? response.odd() : response.even(), even ? sines : cosines, tangentialHalf);
  const Eigen::MatrixXd fit = fitMatrix(wide);
  Eigen::MatrixXd weights(6, table.nodes * table.cells * 2);
  for (int node = 0; node < table.nodes; ++node)
    for (int cell = 0; cell < table.cells; ++cell)
      for (int load = 0; load < 2; ++load) {
        const Eigen::MatrixXd block =
            (load == 0 ? normal : tangential).block(node * kPoints, cell * columns, kPoints, columns);
        weights.col((node * table.cells + cell) * 2 + load) = fit * block.reshaped();
      }
  const double largestSum = weights.cwiseAbs().colwise().sum().maxCoeff();
  table.strainPerUnit = largestSum * 32768 / 32760;
  table.patches.resize(static_cast<std::size_t>(table.nodes * table.cells));
  for (std::size_t p = 0; p < table.patches.size(); ++p)
    for (std::size_t i = 0; i < 6; ++i) {
      const auto at = [&](int load) {
        return static_cast<std::int16_t>(
            std::lround(weights(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(2 * p) + load) /
                        table.strainPerUnit * 32768));
      };
      table.patches[p].normal[i] = at(0);
      table.patches[p].tangential[i] = at(1);
    }
  return table;
}

}  // namespace strainfinger::tables
