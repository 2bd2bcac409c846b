#include "firmware/core/window_fit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>
#include <vector>

#include "firmware/core/triple_fit.hpp"
#include "tests/firmware/core/model_ring.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::firmware;

namespace {

using Vector7 = Eigen::Matrix<double, 7, 1>;
using Matrix72 = Eigen::Matrix<double, 7, 2>;

constexpr double kSignalNorm = 16'384;  // within 3 dB of what the firmware scales to
constexpr double kSignalEnergy = kSignalNorm * kSignalNorm / 4;
constexpr double kStepError_um = 10;        // of up to 624 um, over a gauge, where a step is least determined
constexpr double kInformationError = 0.01;  // over a gauge, where 16 of its 26 bits are left
constexpr int kDirections = 9;
double directionOf(int step) { return (step - 4) * std::numbers::pi / 4 / 4; }  // +-45 degrees

}  // namespace

TEST_GROUP(WindowFit) {
  const ModelRing ring;
  const double peak = ring.peakPerLoad();
  const FitTable& rows = ring.tables().rows;

  /// Variable projection at an offset by the textbook, from the model and least squares alone.
  struct Projection {
    Eigen::Vector2d loads;  ///< N/m per unit of the readings
    double energy;          ///< explained
    double step_pitch;      ///< Gauss-Newton (Kaufman) towards the best offset
    double information;     ///< squared norm of the gradient, per pitch
  };
  Projection projected(const Vector7& readings, double offset_pitch) {
    Matrix72 response, slope;
    for (int k = -3; k <= 3; ++k) {
      const auto value = ring.response(k - offset_pitch);
      response.row(k + 3) << value.normal, value.tangential;
      slope.row(k + 3) << -value.normalSlope * ring.pitch_rad(), -value.tangentialSlope * ring.pitch_rad();
    }
    const auto leastSquares = [&](const Vector7& vector) -> Eigen::Vector2d {
      return (response.transpose() * response).inverse() * (response.transpose() * vector);
    };
    const Eigen::Vector2d loads = leastSquares(readings);
    const Vector7 moved = slope * loads;
    const Vector7 gradient = moved - response * leastSquares(moved);
    const Vector7 residual = readings - response * loads;
    return {loads, (response * loads).squaredNorm(), gradient.dot(residual) / gradient.squaredNorm(),
            gradient.squaredNorm()};
  }

  /// Readings of a contact at an offset from the middle gauge, scaled to kSignalNorm; unscaled: N/m.
  struct Case {
    Vector7 readings;
    Signal signal;
    double perLoad;  ///< scale of the readings
    Eigen::Vector2d loads;
  };
  Case contact(double offset_pitch, double direction) {
    Case result;
    result.loads << std::cos(direction), std::sin(direction);
    for (int k = -3; k <= 3; ++k) {
      const auto value = ring.response(k - offset_pitch);
      result.readings[k + 3] = value.normal * result.loads[0] + value.tangential * result.loads[1];
    }
    result.perLoad = kSignalNorm / result.readings.norm();
    std::vector<std::int32_t> strains;
    for (int k = 0; k < 7; ++k) {
      strains.push_back(static_cast<std::int32_t>(std::lround(result.readings[k] * result.perLoad)));
      result.readings[k] = strains.back();
    }
    result.signal = windowSignal(strains, 3, 16);
    return result;
  }

  /// An eighth of a pitch, or less from rows where a step is long in units of their gradients.
  static double longestStep(const FitRow& row) {
    return std::min(0.125, std::ldexp(1.0, -row.gradient_exponent));
  }

  /// A fit as locate() starts it: at a row, negative on the - side.
  WindowFit startOf(const Case& c, int row) {
    WindowFit fit;
    fit.start(c.signal, 0, row, 1);
    return fit;
  }
  static double pitches(PitchQ20 position) { return std::ldexp(position, -kPitchBits); }

  /// Loads [N/m] of amplitudes for readings scaled by perLoad.
  Eigen::Vector2d loadsOf(const WindowFit& fit, double perLoad) {
    const Amplitudes a = amplitudesOf(rows[static_cast<std::size_t>(fit.row)], fit.step);
    const double unit = std::ldexp(1 / (peak * perLoad), 1 - ring.constants().amplitude_exponent);
    return Eigen::Vector2d(a.normal, fit.side * a.tangential) * unit;
  }

  /// Visits contacts at every row and beside it, of every load direction.
  template <typename Visit>
  void forEachRowAndContact(Visit visit) {
    for (int row = 0; row < kFitRows; ++row)
      for (const double beside : {-0.12, -1.0 / 128, 0.0, 1.0 / 128, 0.12})
        for (int step = 0; step < kDirections; ++step)
          visit(row, rows[static_cast<std::size_t>(row)], contact(row / 64.0 + beside, directionOf(step)));
  }

  struct Refined {
    bool settled;
    double error_um;
    double loadError;  ///< larger of the two, N/m at a load of 1 N/m
  };
  Refined judged(const WindowFit& fit, bool settled, const Case& c, double offset_pitch) {
    return {settled, std::abs(ring.arc_um(pitches(fit.position()) - offset_pitch)),
            (loadsOf(fit, c.perLoad) - c.loads).cwiseAbs().maxCoeff()};
  }
  Refined refinedFrom(const Case& c, double offset_pitch, int start) {
    WindowFit fit = startOf(c, start);
    const bool settled = refine(rows, 1, fit);
    return judged(fit, settled, c, offset_pitch);
  }
  /// What three readings say once all seven have settled.
  Refined threeFrom(const Case& c, double offset_pitch, int start) {
    WindowFit fit = startOf(c, start);
    refine(rows, 1, fit);
    const bool settled = solveTriple(rows, 1, fit).has_value();
    return judged(fit, settled, c, offset_pitch);
  }
  /// Visits contacts all over the window, and every row within an eighth of a pitch of them.
  template <typename Visit>
  void forEachStart(Visit visit) {
    for (int position = -35; position <= 35; ++position)
      for (int step = 0; step < kDirections; ++step) {
        const double offset = position / 64.0 + 0.003;
        const Case c = contact(offset, directionOf(step));
        for (int start = std::max(position - 7, -36); start <= std::min(position + 8, 36); ++start)
          visit(c, offset, start);
      }
  }
};

TEST(WindowFit, ProjectionHasTheEnergyThatLeastSquaresExplains) {
  forEachRowAndContact([&](int row, const FitRow& entry, const Case& c) {
    const FitStep step = fitStep(entry, c.signal);
    const double expected = projected(c.readings, row / 64.0).energy / 4;
    // Weights are rounded to 2^-16: 1.5e-5 a weight and reading.
    DOUBLES_EQUAL(expected, energyOf(step.projection[0], step.projection[1]), 1e-4 * kSignalEnergy);
  });
}

TEST(WindowFit, StepIsThatOfTheTextbook) {
  forEachRowAndContact([&](int row, const FitRow& entry, const Case& c) {
    const double longest = longestStep(entry);
    const double length = std::clamp(projected(c.readings, row / 64.0).step_pitch, -longest, longest);
    DOUBLES_EQUAL(0, ring.arc_um(pitches(fitStep(entry, c.signal).length) - length), kStepError_um);
  });
}

TEST(WindowFit, InformationIsTheSquareOfTheGradient) {
  forEachRowAndContact([&](int row, const FitRow& entry, const Case& c) {
    const double expected = projected(c.readings, row / 64.0).information;
    const double information =
        std::ldexp(fitStep(entry, c.signal).information, 4 + 2 * entry.gradient_exponent);
    DOUBLES_EQUAL(1, information / expected, kInformationError);
  });
}

TEST(WindowFit, EnergyAfterTheFullStepIsThatOfTheParabola) {
  forEachRowAndContact([&](int row, const FitRow& entry, const Case& c) {
    const Projection row0 = projected(c.readings, row / 64.0);
    if (std::abs(row0.step_pitch) > longestStep(entry)) return;
    const double expected = (row0.energy + row0.step_pitch * row0.step_pitch * row0.information) / 4;
    DOUBLES_EQUAL(expected, fitStep(entry, c.signal).energy(), 2e-4 * kSignalEnergy);
  });
}

TEST(WindowFit, AStepIsAtMostAnEighthOfAPitch) {
  std::printf("seed 5 ");
  std::mt19937 random(5);
  std::uniform_int_distribution<std::int32_t> reading(-6000, 6000);
  for (int i = 0; i < 20'000; ++i) {
    std::vector<std::int32_t> strains(7);
    for (std::int32_t& strain : strains) strain = reading(random);
    const FitStep step = fitStep(rows[random() % kFitRows], windowSignal(strains, 3, 16));
    CHECK(std::abs(step.length) <= kOnePitch / 8);
    CHECK(step.information >= 0);
  }
}

TEST(WindowFit, NothingToGoByIsNoStep) {
  const FitStep step = fitStep(rows[0], Signal{});
  LONGS_EQUAL(0, step.length);
  LONGS_EQUAL(0, step.energy());
  LONGS_EQUAL(0, step.information);
}

TEST(WindowFit, SevenGaugesConvergeFromEveryRowWithinAnEighthOfAPitch) {
  forEachStart([&](const Case& c, double offset, int start) {
    const Refined result = refinedFrom(c, offset, start);
    CHECK_TRUE(result.settled);
    DOUBLES_EQUAL(0, result.error_um, 2);
    DOUBLES_EQUAL(0, result.loadError, 5e-4);
  });
}

TEST(WindowFit, ThreeGaugesFindTheSameContact) {
  forEachStart([&](const Case& c, double offset, int start) {
    const Refined result = threeFrom(c, offset, start);
    CHECK_TRUE(result.settled);
    DOUBLES_EQUAL(0, result.error_um, 4);
    DOUBLES_EQUAL(0, result.loadError, 1e-3);
  });
}

// Of disturbed readings, whose other four say something else.
TEST(WindowFit, TheThreeReadingsThatAreNamedAreExplained) {
  std::printf("seed 6 ");
  std::mt19937 random(6);
  std::uniform_int_distribution<std::int32_t> disturbance(-60, 60);
  double worst = 0, square = 0;
  int answers = 0;
  forEachStart([&](Case c, double, int start) {
    std::vector<std::int32_t> strains;
    for (double& reading : c.readings) {
      reading += disturbance(random);
      strains.push_back(static_cast<std::int32_t>(reading));
    }
    c.signal = windowSignal(strains, 3, 16);
    WindowFit fit = startOf(c, start);
    refine(rows, 1, fit);
    const auto triple = solveTriple(rows, 1, fit);
    if (!triple) return;
    const Eigen::Vector2d loads = loadsOf(fit, c.perLoad) * c.perLoad;
    for (const int gauge : kTripleList[*triple]) {
      const int k = fit.side * gauge;
      const auto value = ring.response(k - pitches(fit.position()));
      const double left = std::abs(c.readings[k + 3] - value.normal * loads[0] - value.tangential * loads[1]);
      worst = std::max(worst, left);
      square += left * left / 3;
    }
    ++answers;
  });
  const double rms = std::sqrt(square / answers);
  std::printf("%d answers, RMS %.2f, worst %.1f of %.0f ", answers, rms, worst, kSignalNorm);
  CHECK(answers > 9000);
  CHECK(rms < 4);
  CHECK(worst < 30);
}

TEST(WindowFit, ThreeGaugesThatSayNothingAreNoAnswer) {
  WindowFit fit = startOf(contact(0.1, 0), 6);
  fit.signal = {};
  fit.step = {};
  CHECK_FALSE(solveTriple(rows, 1, fit).has_value());
}

TEST(WindowFit, NoOffsetSendsNeighbouringRowsToAndFro) {
  for (int position = -560; position <= 560; ++position) {  // a sixteenth of a row apart
    const double offset = position / 1024.0;
    for (int step = 0; step < kDirections; ++step) {
      const Case c = contact(offset, directionOf(step));
      CHECK_TRUE(refinedFrom(c, offset, static_cast<int>(std::floor(offset * 64))).settled);
    }
  }
}

TEST(WindowFit, WalksAcrossTheMiddleGauge) {
  for (const int side : {1, -1}) {
    const Case c = contact(-0.05 * side, side * 0.3);
    WindowFit fit = startOf(c, 3 * side);
    CHECK_TRUE(refine(rows, 1, fit));
    LONGS_EQUAL(-side, fit.side);
    DOUBLES_EQUAL(-0.05 * side, pitches(fit.position()), 1e-3);
    DOUBLES_EQUAL(c.loads[1], loadsOf(fit, c.perLoad)[1], 1e-3);
  }
}

TEST(WindowFit, OverTheMiddleGaugeBothSidesAgree) {
  for (int step = 0; step < kDirections; ++step) {
    const Case c = contact(0, directionOf(step));
    for (const int start : {-4, 4}) {
      const Refined result = refinedFrom(c, 0, start);
      CHECK_TRUE(result.settled);
      DOUBLES_EQUAL(0, result.error_um, 2);
    }
  }
}

TEST(WindowFit, BeyondTheLastRowIsNoAnswer) {
  for (const double offset : {0.75, 0.8, -0.75, -0.8}) {
    WindowFit fit = startOf(contact(offset, 0), offset < 0 ? -40 : 40);
    CHECK_FALSE(refine(rows, 1, fit));
  }
}
