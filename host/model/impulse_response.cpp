#include "host/model/impulse_response.hpp"

#include <array>
#include <numbers>

#include "host/model/series.hpp"

namespace strainfinger::model {
namespace {

struct Sums {
  double even = 0, odd = 0, evenSlope = 0, oddSlope = 0;
  Sums& operator+=(const Sums& other) {
    even += other.even;
    odd += other.odd;
    evenSlope += other.evenSlope;
    oddSlope += other.oddSlope;
    return *this;
  }
};

}  // namespace

// A pressing load of 1 N/m has the coefficients p_n^c = -1 / (pi r_b), a tangential one q_n^c = 1 / (pi r_b),
// half of that at n = 0. By the pairing of HarmonicResponse p^c gives cosines of e_rr and minus sines of
// e_rt, q^c gives sines of e_rr and cosines of e_rt.
ImpulseResponse::ImpulseResponse(const Annulus<double>& annulus, double radius_m, StrainComponent component,
                                 double gaugeArc_m, double contactWidth_m, double tolerance)
    : normalIsEven_(isEvenInNormalLoad(rowOf(component))) {
  const std::array rows{rowOf(component)};
  const Windows windows{contactWidth_m / annulus.outer_radius_m, gaugeArc_m / radius_m};
  Eigen::MatrixXd table = truncatedSeries(annulus, radius_m, rows, windows, tolerance);
  table /= std::numbers::pi * annulus.outer_radius_m;
  table.row(0) /= 2;
  if (normalIsEven_) table.col(kNormal) *= -1;
  even_ = table.col(normalIsEven_ ? kNormal : kTangential);
  odd_ = table.col(normalIsEven_ ? kTangential : kNormal);
}

ImpulseResponse::Value ImpulseResponse::at(double angle_rad) const {
  Sums all, block;
  visitMultiples(angle_rad, harmonics(), [&](int n, double c, double s) {
    if (n % kBlock == 0) {
      all += block;
      block = {};
    }
    block.even += even_[n] * c;
    block.odd += odd_[n] * s;
    block.evenSlope -= n * even_[n] * s;
    block.oddSlope += n * odd_[n] * c;
  });
  all += block;
  return normalIsEven_ ? Value{all.even, all.odd, all.evenSlope, all.oddSlope}
                       : Value{all.odd, all.even, all.oddSlope, all.evenSlope};
}

ImpulseResponse::Strain ImpulseResponse::under(const LoadSpectrum& load, double angle_rad) const {
  const Eigen::VectorXd& evenLoad = normalIsEven_ ? load.normal : load.tangential;
  const Eigen::VectorXd& oddLoad = normalIsEven_ ? load.tangential : load.normal;
  Strain all{}, block{};
  visitMultiples(angle_rad, harmonics(), [&](int n, double c, double s) {
    if (n % kBlock == 0) {
      all = {all.strain + block.strain, all.slope + block.slope};
      block = {};
    }
    const double even = evenLoad[n] * even_[n], odd = oddLoad[n] * odd_[n];
    block.strain += even * c + odd * s;
    block.slope += n * (odd * c - even * s);
  });
  return {all.strain + block.strain, all.slope + block.slope};
}

}  // namespace strainfinger::model
