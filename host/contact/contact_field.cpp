#include "host/contact/contact_field.hpp"

#include <fmt/format.h>

#include <cmath>

#include "host/base/failure.hpp"
#include "host/model/series.hpp"

namespace strainfinger::contact {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::RowVectorXd;
using Eigen::VectorXd;
using model::Row;

/// Factors of cos n theta and sin n theta of one row; by the pairing of HarmonicResponse, p = -pressure.
struct RowSeries {
  VectorXd cosines, sines;

  RowSeries(const MatrixXd& table, Index i, bool isEven, const FourierTractions& t) {
    const auto normal = table.col(2 * i).array(), tangential = table.col(2 * i + 1).array();
    const VectorXd even = -normal * t.col(0).array() - tangential * t.col(3).array();
    const VectorXd odd = -normal * t.col(1).array() + tangential * t.col(2).array();
    cosines = isEven ? even : odd;
    sines = isEven ? odd : VectorXd(-even);
  }
};

/// All rows at r_b: displacements and tractions are known, strains and the hoop stress by Hooke's law.
model::HarmonicResponse<double> surfaceRows(const model::Annulus<double>& annulus, const SurfacePoint& point,
                                            const Traction& traction) {
  using namespace model;
  const double nu = annulus.poisson_ratio, twoMu = 2 * annulus.shear_modulus_pa;
  HarmonicResponse<double> rows = HarmonicResponse<double>::Zero();
  auto value = rows.col(0);
  value[kTrr] = -traction.pressure_pa;
  value[kTrt] = traction.shear_pa;
  value[kUr] = point.ur_m;
  value[kUt] = point.ut_m;
  value[kEtt] = (point.ur_m + point.utSlope_m) / annulus.outer_radius_m;
  value[kErr] = ((1 - 2 * nu) * value[kTrr] / twoMu - nu * value[kEtt]) / (1 - nu);
  value[kTtt] = (twoMu * value[kEtt] + nu * value[kTrr]) / (1 - nu);
  value[kErt] = value[kTrt] / twoMu;
  return rows;
}

MatrixXd atSurface(const SurfaceKernel& kernel, const Tractions& tractions,
                   std::span<const double> angles_rad, std::span<const Row> rows) {
  const SurfaceMotion motion(kernel, tractions);
  MatrixXd field(angles_rad.size(), rows.size());
  for (Index k = 0; k < field.rows(); ++k) {
    const double angle_rad = angles_rad[static_cast<std::size_t>(k)];
    const auto all = surfaceRows(kernel.annulus(), motion.at(angle_rad), tractionAt(tractions, angle_rad));
    for (Index i = 0; i < field.cols(); ++i) field(k, i) = all(rows[static_cast<std::size_t>(i)], 0);
  }
  return field;
}

void requireDeep(const model::Annulus<double>& annulus, double radius_m, double tolerance) {
  if (radius_m > annulus.outer_radius_m || radius_m < fieldLimit_m(annulus, tolerance)) return;
  throw Failure(ExitCode::kUsage,
                fmt::format("radius {} m is too close to the surface at {} m: its field needs more than {} "
                            "harmonics; choose the surface itself, or 0.2 % less",
                            radius_m, annulus.outer_radius_m, kMostFieldHarmonics));
}

}  // namespace

double fieldLimit_m(const model::Annulus<double>& annulus, double tolerance) {
  return annulus.outer_radius_m * std::pow(tolerance, 1.0 / kMostFieldHarmonics);
}

MatrixXd computeContactField(const SurfaceKernel& kernel, const Tractions& tractions, double radius_m,
                             std::span<const double> angles_rad, std::span<const Row> rows,
                             double tolerance) {
  const model::Annulus<double>& annulus = kernel.annulus();
  if (radius_m == annulus.outer_radius_m) return atSurface(kernel, tractions, angles_rad, rows);
  requireDeep(annulus, radius_m, tolerance);
  const MatrixXd table = model::truncatedSeries(annulus, radius_m, rows, {}, tolerance);
  const int last = static_cast<int>(table.rows()) - 1;
  const FourierTractions fourier = fourierTractions(tractions, last);
  MatrixXd cosines(table.rows(), rows.size()), sines = cosines;
  for (Index i = 0; i < cosines.cols(); ++i) {
    const RowSeries series(table, i, model::isEvenInNormalLoad(rows[static_cast<std::size_t>(i)]), fourier);
    cosines.col(i) = series.cosines;
    sines.col(i) = series.sines;
  }
  MatrixXd field(angles_rad.size(), rows.size());
  RowVectorXd c(table.rows()), s(table.rows());
  for (Index k = 0; k < field.rows(); ++k) {
    model::visitMultiples(angles_rad[static_cast<std::size_t>(k)], last,
                          [&](int n, double cosine, double sine) {
                            c[n] = cosine;
                            s[n] = sine;
                          });
    field.row(k) = c * cosines + s * sines;
  }
  return field;
}

}  // namespace strainfinger::contact
