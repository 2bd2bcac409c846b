#pragma once
// Signorini's problem on cells of uniform pressure: which of them touch under a load.

#include <Eigen/Core>
#include <vector>

#include "host/contact/indenter.hpp"
#include "host/contact/surface_kernel.hpp"

namespace strainfinger::contact {

/// Uniform cells, or some that were cut.
struct Grid {
  Eigen::VectorXd edges_rad;  ///< one more than cells

  Eigen::Index cells() const { return edges_rad.size() - 1; }
  Eigen::VectorXd middles_rad() const { return (edges_rad.head(cells()) + edges_rad.tail(cells())) / 2; }
  Eigen::VectorXd widths_rad() const { return edges_rad.tail(cells()) - edges_rad.head(cells()); }
};

/// One grid: heights of the gap over the cells, and the cells' influence on each other.
class CellContact {
 public:
  /// Keeps a reference to the grid. Costs 2 ms for 128 cells.
  CellContact(const SurfaceKernel& kernel, const Indenter& indenter, const Grid& grid);

  /// The cells that touch under a load, from those that may. Cells that pull leave, those that penetrate
  /// join.
  std::vector<Eigen::Index> touching(double load_n_per_m, std::vector<Eigen::Index> active) const;

  std::vector<Eigen::Index> all() const;

  /// How far the shape comes below the straight line between a cell's ends, or above it; 0 if the cell is as
  /// narrow as measured points are apart.
  double roughness_m(Eigen::Index cell) const;

 private:
  void fillGaps(const Indenter& indenter);
  Eigen::VectorXd solve(const std::vector<Eigen::Index>& active, double load_n_per_m) const;
  std::vector<Eigen::Index> nextActive(const std::vector<Eigen::Index>& active,
                                       const Eigen::VectorXd& solution) const;

  const Grid& grid_;
  double radius_m_;
  Eigen::MatrixXd matrix_;
  Eigen::VectorXd gap_m_, below_m_, above_m_, points_;
};

}  // namespace strainfinger::contact
