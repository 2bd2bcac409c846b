#pragma once
// Fingers, radii and harmonics to test the model with.

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>

#include "host/model/annulus.hpp"

namespace strainfinger::testing {

inline constexpr model::Annulus<double> kDefaultFinger{8.9e-3, 12.7e-3, 8.3e4, 0.5};
inline constexpr double kGaugeRadius_m = 9.4e-3;

struct Sample {
  model::Annulus<double> finger;
  double radius_m;
  int n;

  std::string text() const {
    return std::string("n ")
        .append(std::to_string(n))
        .append(", core radius ")
        .append(std::to_string(finger.core_radius_m))
        .append(", radius ")
        .append(std::to_string(radius_m))
        .append(", Poisson's ratio ")
        .append(std::to_string(finger.poisson_ratio));
  }
};

struct Range {
  double least, most;
};

/// Draws fingers whose outer radius is 12.7 mm; the edges of each range, both ends of the rubber and their
/// surroundings come up often.
class Sampler {
 public:
  Sampler(unsigned seed, Range alpha, Range poissonRatio, int lastHarmonic)
      : random_(seed), alpha_(alpha), poissonRatio_(poissonRatio), lastHarmonic_(lastHarmonic) {}

  Sample next() {
    Sample sample{kDefaultFinger, 0, harmonic()};
    sample.finger.core_radius_m = alpha() * sample.finger.outer_radius_m;
    sample.finger.poisson_ratio = poissonRatio();
    sample.radius_m = radius(sample.finger);
    return sample;
  }

 private:
  double uniform(double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(random_);
  }
  unsigned roll(unsigned sides) { return static_cast<unsigned>(random_() % sides); }

  double alpha() {
    const std::array thin{alpha_.least, alpha_.most, 1 - (1 - alpha_.most) * std::pow(10, uniform(0, 1))};
    return roll(8) == 0 ? std::max(thin[roll(3)], alpha_.least) : uniform(alpha_.least, alpha_.most);
  }

  double poissonRatio() {
    const std::array special{0.5, 0.5 - 1e-9, 0.49, poissonRatio_.least};
    return roll(2) == 0 ? special[roll(4)] : uniform(poissonRatio_.least, poissonRatio_.most);
  }

  int harmonic() {
    if (roll(8) == 0) return lastHarmonic_;
    return static_cast<int>(std::exp(uniform(0, std::log(lastHarmonic_ + 1.0)))) - (roll(20) == 0 ? 1 : 0);
  }

  double radius(const model::Annulus<double>& finger) {
    const double ra = finger.core_radius_m, rb = finger.outer_radius_m, near = std::pow(10, uniform(-9, 0));
    const std::array special{ra, rb, ra + (rb - ra) * near, rb - (rb - ra) * near};
    const double radius = roll(2) == 0 ? special[roll(4)] : uniform(ra, rb);
    return std::clamp(radius, ra, rb);
  }

  std::mt19937_64 random_;
  Range alpha_, poissonRatio_;
  int lastHarmonic_;
};

}  // namespace strainfinger::testing
