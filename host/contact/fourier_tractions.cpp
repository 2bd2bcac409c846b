#include "host/contact/fourier_tractions.hpp"

#include <numbers>

#include "host/model/harmonic.hpp"
#include "host/model/series.hpp"

namespace strainfinger::contact {

FourierTractions fourierTractions(const Tractions& tractions, int harmonics) {
  FourierTractions sums = FourierTractions::Zero(harmonics + 1, 4);
  for (const LineTraction& line : lineTractions(tractions, harmonics))
    model::visitMultiples(line.angle_rad, harmonics, [&](int n, double c, double s) {
      sums.row(n) += Eigen::RowVector4d(line.pressure_pa_rad * c, line.pressure_pa_rad * s,
                                        line.shear_pa_rad * c, line.shear_pa_rad * s);
    });
  sums /= std::numbers::pi;
  sums.row(0) /= 2;
  return sums;
}

Traction tractionAt(const FourierTractions& tractions, double angle_rad) {
  Traction sum;
  model::visitMultiples(angle_rad, static_cast<int>(tractions.rows()) - 1, [&](int n, double c, double s) {
    sum.pressure_pa += tractions(n, 0) * c + tractions(n, 1) * s;
    sum.shear_pa += tractions(n, 2) * c + tractions(n, 3) * s;
  });
  return sum;
}

// By the pairing of HarmonicResponse, p = -pressure.
SurfacePoint surfaceAt(const model::Annulus<double>& annulus, const FourierTractions& tractions,
                       double angle_rad) {
  using namespace model;
  const HarmonicModel<double> harmonic(annulus, annulus.outer_radius_m);
  SurfacePoint point;
  visitMultiples(angle_rad, static_cast<int>(tractions.rows()) - 1, [&](int n, double c, double s) {
    const HarmonicResponse<double> response = harmonic(n);
    const auto row = tractions.row(n);
    const double urCos = -response(kUr, kNormal) * row[0] - response(kUr, kTangential) * row[3];
    const double urSin = -response(kUr, kNormal) * row[1] + response(kUr, kTangential) * row[2];
    const double utCos = -response(kUt, kNormal) * row[1] + response(kUt, kTangential) * row[2];
    const double utSin = response(kUt, kNormal) * row[0] + response(kUt, kTangential) * row[3];
    point.ur_m += urCos * c + urSin * s;
    point.ut_m += utCos * c + utSin * s;
    point.urSlope_m += n * (urSin * c - urCos * s);
    point.utSlope_m += n * (utSin * c - utCos * s);
  });
  return point;
}

}  // namespace strainfinger::contact
