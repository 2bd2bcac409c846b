#include "host/model/field.hpp"

#include "host/model/series.hpp"
#include "host/model/surface_field.hpp"

namespace strainfinger::model {

Eigen::MatrixXd computeField(const Annulus<double>& annulus, double radius_m, const SurfaceLoad& load,
                             std::span<const double> angles_rad, std::span<const Row> rows,
                             double tolerance) {
  if (radius_m == annulus.outer_radius_m && load.width_rad > 0)
    return computeSurfaceField(annulus, load, angles_rad, rows);
  const Windows windows{.load_rad = load.width_rad};
  const Eigen::MatrixXd table = truncatedSeries(annulus, radius_m, rows, windows, tolerance);
  return sumSeries(table, rows, annulus, load, angles_rad);
}

}  // namespace strainfinger::model
