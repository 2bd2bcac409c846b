#include "host/tables/window_fit.hpp"

#include <bit>
#include <random>
#include <vector>

#include "tests/host/tables/DefaultResponse.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::tables;

// Oracles: the normal equations and finite differences of the model's values.
TEST_GROUP(WindowFit) {
  int gauges_ = 16;
  static constexpr double kPeak = 460.603e-6;  // strain per N/m, brings everything to the size of 1
  const model::ImpulseResponse model_ = responseOf({});
  const std::vector<double> offsets_{0, 0.1, 0.25, 0.4, 0.5, 0.6, 39.0 / 64};
  const std::vector<GaugeMask> masks_{kAllGauges, {false, true, true, false, true, false, false}};

  WindowResponse responseAt(double offset) {
    WindowResponse response = windowResponse(model_, gauges_, offset);
    response.value /= kPeak;
    response.slope /= kPeak;
    return response;
  }
  WindowFit fitAt(double offset, const GaugeMask& mask) { return windowFit(responseAt(offset), mask); }
  OracleMatrix valuesAt(double offset, const GaugeMask& mask) {
    return oracleResponse(model_, gauges_, offset, mask) / kPeak;
  }
  Eigen::Vector2d loadsAt(double offset, const GaugeMask& mask, const WindowVector& signal) {
    const OracleMatrix values = valuesAt(offset, mask);
    return (values.transpose() * values).inverse() * (values.transpose() * signal);
  }

  void checkNear(const Eigen::MatrixXd& expected, const Eigen::MatrixXd& actual, double tolerance) {
    DOUBLES_EQUAL(0, (expected - actual).cwiseAbs().maxCoeff(), tolerance);
  }
  template <typename Check>
  void forEachFit(const Check& check) {
    for (const int gauges : {16, 24}) {
      gauges_ = gauges;
      for (const GaugeMask& mask : masks_)
        for (const double offset : offsets_) check(offset, mask, fitAt(offset, mask));
    }
  }

  std::mt19937_64 random_{20240614};
  WindowVector anySignal(const GaugeMask& mask) {
    WindowVector signal;
    for (int k = 0; k < kWindowReadings; ++k)
      signal[k] = mask[static_cast<std::size_t>(k)] ? std::normal_distribution<>()(random_) : 0;
    return signal;
  }
  Eigen::Vector2d anyLoads() { return {1, std::uniform_real_distribution<>(-1, 1)(random_)}; }

  /// Fisher's matrix of (offset, normal, tangential) inverted: the variances for unit noise.
  Eigen::Vector3d variances(double offset, const GaugeMask& mask, double direction) {
    const auto values = [&](double at) { return valuesAt(at, mask); };
    Eigen::Matrix<double, kWindowReadings, 3> jacobian;
    jacobian << derivative(values, offset) * Eigen::Vector2d(1, direction), values(offset);
    return (jacobian.transpose() * jacobian).inverse().diagonal();
  }
  double worstRatio(double offset, const GaugeMask& mask, DirectionRange directions, int steps) {
    double worst = 0;
    for (int i = 0; i <= steps; ++i) {
      const double direction = directions.least + i * (directions.most - directions.least) / steps;
      const Eigen::Vector3d all = variances(offset, kAllGauges, direction);
      worst = std::max(worst, variances(offset, mask, direction).cwiseQuotient(all).cwiseAbs().maxCoeff());
    }
    return worst;
  }
  GaugeMask bestAt(double offset, DirectionRange directions) {
    return gaugesOfTriple(bestTriple(responseAt(offset), directions).value());
  }
  static std::vector<GaugeMask> triples() {
    std::vector<GaugeMask> result;
    for (unsigned bits = 0; bits < 128; ++bits) {
      GaugeMask mask{};
      for (std::size_t k = 0; k < kWindowGauges; ++k) mask[k] = (bits >> k & 1) != 0;
      if (std::popcount(bits) == 3) result.push_back(mask);
    }
    return result;
  }
};

TEST(WindowFit, ResponsesAreTheModelsAtTheGauges) {
  forEachFit([&](double offset, const GaugeMask&, const WindowFit&) {
    checkNear(valuesAt(offset, kAllGauges), responseAt(offset).value, 1e-14);
  });
}

TEST(WindowFit, SlopesAreDerivativesByTheOffset) {
  const auto values = [&](double at) { return valuesAt(at, kAllGauges); };
  forEachFit([&](double offset, const GaugeMask&, const WindowFit&) {
    checkNear(derivative(values, offset), responseAt(offset).slope, 1e-8);
  });
}

TEST(WindowFit, TheBasisIsOrthonormalAndSpansTheResponses) {
  forEachFit([&](double offset, const GaugeMask& mask, const WindowFit& fit) {
    const OracleMatrix values = valuesAt(offset, mask);
    checkNear(Eigen::Matrix2d::Identity(), fit.basis.transpose() * fit.basis, 1e-13);
    checkNear(values, fit.basis * (fit.basis.transpose() * values), 1e-13);
    checkNear(values.col(0).normalized(), fit.basis.col(0), 1e-13);
  });
}

TEST(WindowFit, AmplitudesAreTheLeastSquaresLoadsOfAnySignal) {
  UT_PRINT("seed 20240614");
  forEachFit([&](double offset, const GaugeMask& mask, const WindowFit& fit) {
    const WindowVector signal = anySignal(mask);
    const Eigen::Vector2d loads = fit.amplitude * (fit.basis.transpose() * signal);
    checkNear(loadsAt(offset, mask, signal), loads, 1e-11 * loads.norm());
  });
}

TEST(WindowFit, TheGradientIsWhatRemainsOfAContactAtAnotherOffset) {
  UT_PRINT("seed 20240614");
  forEachFit([&](double offset, const GaugeMask& mask, const WindowFit& fit) {
    const WindowVector signal = valuesAt(offset, mask) * anyLoads();
    const auto rest = [&](double at) -> WindowVector {
      return signal - valuesAt(at, mask) * loadsAt(at, mask, signal);
    };
    checkNear(derivative(rest, offset), -fit.gradient * (fit.basis.transpose() * signal), 1e-6);
  });
}

TEST(WindowFit, LoadsChangeWithTheOffsetByTheAmplitudesSlope) {
  UT_PRINT("seed 20240614");
  forEachFit([&](double offset, const GaugeMask& mask, const WindowFit& fit) {
    const WindowVector signal = valuesAt(offset, mask) * anyLoads();
    const auto loads = [&](double at) { return loadsAt(at, mask, signal); };
    const Eigen::Vector2d slope = fit.amplitude_slope * (fit.basis.transpose() * signal);
    checkNear(derivative(loads, offset), slope, 1e-6 * (1 + slope.norm()));
  });
}

TEST(WindowFit, GaugesOutsideTheMaskHaveNoWeight) {
  const WindowFit fit = fitAt(0.3, masks_[1]);
  for (const int k : {0, 3, 5, 6}) {
    checkNear(Eigen::RowVector2d::Zero(), fit.basis.row(k), 0);
    checkNear(Eigen::RowVector2d::Zero(), fit.gradient.row(k), 0);
  }
}

TEST(WindowFit, TheListOfTriplesHasEachOnce) {
  std::vector<GaugeMask> listed;
  for (std::size_t triple = 0; triple < kTriples; ++triple) listed.push_back(gaugesOfTriple(triple));
  for (const GaugeMask& mask : triples()) LONGS_EQUAL(1, std::count(listed.begin(), listed.end(), mask));
  LONGS_EQUAL(triples().size(), listed.size());
}

// Other triples may only look better: those that turn blind between the five directions that are compared.
TEST(WindowFit, TheBestTripleLosesLeastOfAllInItsWorstDirection) {
  for (const double offset : offsets_) {
    for (const DirectionRange directions : {DirectionRange{-0.15, 1.25}, {-1.25, 0.15}}) {
      const double best = worstRatio(offset, bestAt(offset, directions), directions, 4);
      for (const GaugeMask& other : triples())
        CHECK(best <= worstRatio(offset, other, directions, 4) * (1 + 1e-5) ||
              worstRatio(offset, other, directions, 100) > worstRatio(offset, other, directions, 4) * 2);
    }
  }
}

// The three nearest are blind for a pure normal load over the middle gauge; no chosen triple is for any load.
TEST(WindowFit, TheBestTripleIsNowhereBlind) {
  const GaugeMask nearest{false, false, true, true, true, false, false};
  CHECK(worstRatio(0, nearest, {0, 1.25}, 10) > 1e6);
  for (const double offset : offsets_)
    for (const DirectionRange directions : {DirectionRange{-0.15, 1.25}, {-1.25, 0.15}})
      CHECK(worstRatio(offset, bestAt(offset, directions), directions, 100) < 100);
}

TEST(WindowFit, ThereIsNoBestTripleWhereNoneSeesTheOffset) {
  WindowResponse still = responseAt(0.2);
  still.slope.setZero();
  CHECK_FALSE(bestTriple(still, {-1, 1}).has_value());
}
