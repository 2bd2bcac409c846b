#pragma once
// The field below the surface as a sum of the oracle's harmonics, in 100 digits, as many as 1e-30 takes.

#include <array>
#include <cmath>
#include <vector>

#include "host/model/surface_load.hpp"
#include "tests/host/model/michell_oracle.hpp"

namespace strainfinger::testing {

class ExactField {
 public:
  ExactField(const model::Annulus<double>& annulus, double radius_m) : finger_(widen(annulus)) {
    const MichellOracle oracle(finger_);
    const double gamma = radius_m / annulus.outer_radius_m;
    const int last = static_cast<int>(std::log(1e-30) / std::log(gamma)) + 50;
    for (int n = 0; n <= last; ++n) responses_.push_back(oracle.respond(n, radius_m));
  }

  /// All rows at an angle to the load's centre, averaged over a gauge of that width.
  std::array<Wide, model::kRowCount> at(const model::SurfaceLoad& load, double angle_rad,
                                        double gauge_rad = 0) const {
    using namespace model;
    const Wide unit = 1 / (boost::math::constants::pi<Wide>() * finger_.outer_radius_m);
    const Wide p = -load.normal_n_per_m * unit, q = load.tangential_n_per_m * unit;
    Multiples angle{angle_rad}, width{Wide(load.width_rad) / 2}, gauge{Wide(gauge_rad) / 2};
    std::array<Wide, kRowCount> sums;
    for (std::size_t n = 0; n < responses_.size(); ++n) {
      const Wide weight = width.mean() * gauge.mean() / (n == 0 ? 2 : 1);
      for (std::size_t row = 0; row < sums.size(); ++row) {
        const Wide normal = responses_[n](static_cast<int>(row), kNormal) * p * weight;
        const Wide tangential = responses_[n](static_cast<int>(row), kTangential) * q * weight;
        const bool isShear = row == kTrt || row == kUt || row == kErt;
        sums[row] += isShear ? Wide(tangential * angle.c - normal * angle.s)
                             : Wide(normal * angle.c + tangential * angle.s);
      }
      for (Multiples* each : {&angle, &width, &gauge}) each->advance();
    }
    return sums;
  }

 private:
  /// cos and sin of 0, x, 2 x, ... by rotation: 100 digits have room for its errors.
  struct Multiples {
    explicit Multiples(const Wide& angle) : x(angle), cosine(cos(angle)), sine(sin(angle)) {}
    void advance() {
      const Wide next = c * cosine - s * sine;
      s = s * cosine + c * sine;
      c = next;
      phase += x;
    }
    /// Of cos over the phases from -phase to phase.
    Wide mean() const { return phase == 0 ? Wide(1) : Wide(s / phase); }

    Wide x, cosine, sine;
    Wide c = 1, s = 0, phase = 0;
  };

  WideAnnulus finger_;
  std::vector<model::HarmonicResponse<Wide>> responses_;
};

}  // namespace strainfinger::testing
