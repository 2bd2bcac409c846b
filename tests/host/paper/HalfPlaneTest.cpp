#include "host/paper/half_plane.hpp"

#include <cmath>
#include <numbers>

#include "host/model/harmonic.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::paper;
using model::kNormal;
using model::kTangential;

namespace {

constexpr int kRadialRow = static_cast<int>(StrainComponent::kRadial);
constexpr int kShearRow = static_cast<int>(StrainComponent::kShear);
constexpr double kMu_pa = 8.3e4;
constexpr double kDepth_m = 3.3e-3;  // of the default finger's gauges

}  // namespace

TEST_GROUP(HalfPlane) {
  const HalfPlane rubber{kMu_pa, 0.5, kDepth_m};
  const HalfPlane cork{kMu_pa, 0.1, kDepth_m};

  /// Of a line load at 0, from its spectrum: trapezoidal rule over k, which converges exponentially here.
  static Strains fromSpectrum(const HalfPlane& plane, double x_m) {
    constexpr double kStep = 0.01;
    Strains sum = Strains::Zero();
    for (int i = -8000; i <= 8000; ++i) {
      const double k = std::abs(i * kStep / plane.depth_m), c = std::cos(k * x_m), s = std::sin(k * x_m);
      const Strains wave = plane.atWaveNumber(k);
      Strains phases;  // p^c makes cosines of e_rr and minus sines of e_rt, q^c sines and cosines
      phases << -c, s, -c, s, s, c;
      sum += wave.cwiseProduct(phases) * (kStep / plane.depth_m / (2 * std::numbers::pi));
    }
    return sum;
  }
};

// Computed for this project; printed to the digits given.
TEST(HalfPlane, HasTheKnownPeaks) {
  DOUBLES_EQUAL(-5.810695e-4, rubber.atArc(0)(kRadialRow, kNormal), 5e-11);
  DOUBLES_EQUAL(-1.452674e-4, rubber.atArc(0.414213562 * kDepth_m)(kRadialRow, kTangential), 5e-11);
  DOUBLES_EQUAL(+1.452674e-4, rubber.atArc(2.414213562 * kDepth_m)(kRadialRow, kTangential), 5e-11);
}

TEST(HalfPlane, NormalStrainChangesItsSignAtADepthFromTheLoad) {
  DOUBLES_EQUAL(0, rubber.atArc(kDepth_m)(kRadialRow, kNormal), 1e-18);
  DOUBLES_EQUAL(0, rubber.atArc(-kDepth_m)(kRadialRow, kTangential), 1e-18);
}

TEST(HalfPlane, IncompressibleResponsesAreTheKnownOnes) {
  for (const double depth : {0.0, 0.3, 1.0, 4.0}) {
    const Strains wave = rubber.atWaveNumber(depth / kDepth_m);
    const double unit = std::exp(-depth) / (2 * kMu_pa);
    DOUBLES_EQUAL(depth * unit, wave(kRadialRow, kNormal), 1e-20);
    DOUBLES_EQUAL((1 - depth) * unit, wave(kRadialRow, kTangential), 1e-20);
    DOUBLES_EQUAL(depth * unit, wave(kShearRow, kNormal), 1e-20);
    DOUBLES_EQUAL((1 - depth) * unit, wave(kShearRow, kTangential), 1e-20);
  }
}

TEST(HalfPlane, ItsImpulseResponseIsItsSpectrum) {
  for (const HalfPlane& plane : {rubber, cork})
    for (const double x_m : {0.0, 1e-3, -2e-3, 7e-3}) {
      // the kink of the spectrum at k = 0 costs the rule its step squared
      const Strains error = plane.atArc(x_m) - fromSpectrum(plane, x_m);
      DOUBLES_EQUAL(0, error.cwiseAbs().maxCoeff(), 1e-4 * 5.8e-4);
    }
}

// A thick finger's surface looks flat to short waves; lengths are those of the paper's pairing.
TEST(HalfPlane, IsTheLimitOfALargeFinger) {
  const model::Annulus<double> large{10, 100, kMu_pa, 0.3};
  constexpr int kHarmonic = 100'000;
  const HalfPlane plane{kMu_pa, 0.3, 1e-3};
  const auto wave = plane.atWaveNumber(kHarmonic / large.outer_radius_m);
  const auto finger = model::HarmonicModel<double>(large, large.outer_radius_m - plane.depth_m)(kHarmonic);
  for (const auto load : {kNormal, kTangential})
    for (int row = 0; row < 3; ++row) DOUBLES_EQUAL(finger(model::kErr + row, load), wave(row, load), 1e-10);
}
