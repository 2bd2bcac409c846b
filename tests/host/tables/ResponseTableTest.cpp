#include "host/tables/response_table.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "firmware/core/response.hpp"
#include "host/model/impulse_response.hpp"
#include "host/model/touch_load.hpp"
#include "host/tables/table_builder.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::tables;
using config::FingerConfig;
using std::numbers::pi;

namespace {

/// What a gauge reads of 1 N/m, by the series itself. Moments are fractions of the largest pressure's.
class Oracle {
 public:
  Oracle(const FingerConfig& config, double largestMoment_m2)
      : response_(config.finger.annulus(), config.gauges.radius_m, config.gauges.component,
                  config.gauges.arc_length_m),
        largest_rad2_(largestMoment_m2 / std::pow(config.finger.outer_radius_m, 2)) {}

  double normal(double angle_rad, double moment) const { return at(angle_rad, moment, 1, 0); }
  double tangential(double angle_rad, double moment) const { return at(angle_rad, moment, 0, 1); }

 private:
  double at(double angle_rad, double moment, double normal, double tangential) const {
    const int last = response_.harmonics();
    Eigen::VectorXd spread(last + 1);
    for (int n = 0; n <= last; ++n)
      spread[n] = model::spreadFactor(model::Profile::kEllipse, n, moment * largest_rad2_).value;
    return response_.under({normal * spread, tangential * spread}, angle_rad).strain;
  }

  model::ImpulseResponse response_;
  double largest_rad2_;
};

constexpr double kLoad_n_per_m = 30;
constexpr double kNoise_strain = 6e-6;

/// Sizes of a set of errors, in standard deviations of a reading under 30 N/m.
struct Errors {
  double largest = 0, squares = 0;
  int count = 0;

  void add(double error_strain_per_load) {
    const double error = std::abs(error_strain_per_load) * kLoad_n_per_m / kNoise_strain;
    largest = std::max(largest, error);
    squares += error * error;
    ++count;
  }
  double rms() const { return std::sqrt(squares / count); }
};

}  // namespace

TEST_GROUP(ResponseTable) {
  FingerConfig config_;

  /// Looks unit loads up as the firmware does and calls visit(strain, oracle's strain) for each load, at
  /// angles all around, on nodes' edges and between, and at second moments from `least` of the largest to all
  /// of it.
  void compare(double least, const std::function<void(double, double)>& visit) const {
    const TableImage image = buildTableImage(config_);
    const ResponseTable table = responseTable(config_);
    const Oracle oracle(config_, table.largestMoment_m2);
    const double unit = table.strainPerUnit / 32768;
    const int sign = image.constants.mirror_sign;
    for (int k = 0; k <= 24; ++k) {
      const double moment = least + (1 - least) * std::pow(k / 24.0, 2);
      const auto moment_q20 = static_cast<firmware::Number>(std::lround(std::ldexp(moment, kMomentBits)));
      const firmware::MomentCell cell = firmware::momentCell(image.constants, moment_q20);
      for (int i = -2 * 96; i <= 2 * 96; i += i % 8 == 0 ? 3 : 5) {
        const auto angle_q32 = static_cast<std::uint32_t>(std::llround(std::ldexp(i / (4.0 * 96), 32)));
        const firmware::AngleNode node = firmware::angleNode(image.constants, angle_q32);
        const PatchPair& patch = image.patch(node.node, cell.cell);
        const auto signedValue = [&](const ResponsePatch& weights, int mirror) {
          const int value =
              (firmware::responseOf(weights, cell.s_q15, node.t_q15).value_q30 + (1 << 14)) >> 15;
          return (node.mirrored && mirror < 0 ? -value : value) * unit;
        };
        const double angle_rad = 2 * pi * i / (4.0 * 96);
        const double pressure = config_.contact.width_m ? 1 : moment;
        if (moment == pressure) visit(signedValue(patch.normal, sign), oracle.normal(angle_rad, moment));
        visit(signedValue(patch.tangential, -sign), oracle.tangential(angle_rad, 2 * moment));
      }
    }
  }
  Errors errors(double least) const {
    Errors errors;
    compare(least, [&](double strain, double truth) { errors.add(strain - truth); });
    return errors;
  }
};

// A step of the patches is 0.07 standard deviations.
TEST(ResponseTable, OfUnknownWidthsIsTheModelWithinAReadingsNoise) {
  const Errors all = errors(0);
  CHECK_COMPARE(all.largest, <, 2);
  CHECK_COMPARE(all.rms(), <, 0.25);
}

TEST(ResponseTable, OfALineLoadIsTheModelWithinAFractionOfTheNoise) {
  config_.contact.width_m = 0;
  const Errors all = errors(1);
  CHECK_COMPARE(all.largest, <, 0.25);
  CHECK_COMPARE(all.rms(), <, 0.1);
}

// From full sliding, where the shear has the pressure's moment, half of the largest, to none.
TEST(ResponseTable, OfAKnownWidthIsTheModelForItsPressureAndEveryShear) {
  for (const double width_m : {1e-4, 2e-3, 8e-3}) {
    config_.contact.width_m = width_m;
    CHECK_COMPARE(errors(0.5).largest, <, width_m < 5e-3 ? 0.3 : 0.7);
  }
}

TEST(ResponseTable, IsTheModelForEveryComponentAndCount) {
  for (const StrainComponent component : {StrainComponent::kHoop, StrainComponent::kShear}) {
    config_.gauges.component = component;
    CHECK_COMPARE(errors(0).largest, <, 2);
  }
}

TEST(ResponseTable, AGaugeAveragesOverItsArc) {
  const double point = responseTable(config_).strainPerUnit;
  config_.gauges.arc_length_m = 3e-3;
  CHECK_COMPARE(responseTable(config_).strainPerUnit, <, 0.98 * point);
  CHECK_COMPARE(errors(0).largest, <, 2);
}

// Rounding adds up to half a step of each of a patch's six weights.
TEST(ResponseTable, SaysItsLargestErrorItself) {
  for (const double radius_m : {9.4e-3, 11.2e-3}) {
    config_.gauges.radius_m = radius_m;
    config_.gauges.model_error = 0.05;
    double largest = 0;
    compare(0, [&](double strain, double truth) { largest = std::max(largest, std::abs(strain - truth)); });
    const ResponseTable table = responseTable(config_);
    CHECK_COMPARE(largest, <, (1.15 * table.interpolationError + 3.0 / 32768) * table.strainPerUnit);
    CHECK_COMPARE(largest, >, 0.7 * table.interpolationError * table.strainPerUnit);
  }
}

TEST(ResponseTable, CellsOfUnknownWidthsAreEvenStepsOfTheWidth) {
  const ResponseTable table = responseTable(config_);
  LONGS_EQUAL(10, table.cells);
  for (int k = 0; k <= 10; ++k)
    DOUBLES_EQUAL(k * k / 100.0, table.cell_edge_q15[static_cast<std::size_t>(k)] / 32768.0, 1.0 / 32768);
}

// The variance of a uniform distribution.
TEST(ResponseTable, TheLargestMomentIsThatOfAUniformPressure) {
  DOUBLES_EQUAL(8e-3 * 8e-3 / 12, responseTable(config_).largestMoment_m2, 1e-18);
  config_.contact.width_m = 3e-3;
  DOUBLES_EQUAL(3e-3 * 3e-3 / 12, responseTable(config_).largestMoment_m2, 1e-18);
  config_.contact.width_m = 0;
  DOUBLES_EQUAL(0, responseTable(config_).largestMoment_m2, 0);
}

TEST(ResponseTable, ANarrowerResponseHasMoreNodesAsFarAsTheyFit) {
  config_.contact.width_m = 0;
  const int usual = responseTable(config_).nodes;
  config_.gauges.radius_m = 11e-3;
  CHECK_COMPARE(responseTable(config_).nodes, >, usual);
  config_.gauges.radius_m = 12e-3;
  LONGS_EQUAL(kMostPatches, responseTable(config_).nodes);
  config_.contact.width_m.reset();
  LONGS_EQUAL(kMostPatches, 10 * responseTable(config_).nodes);
}

TEST(ResponseTable, UsesAllOfTheWeightsBits) {
  int largest = 0;
  for (const PatchPair& pair : responseTable(config_).patches)
    for (const ResponsePatch& patch : {pair.normal, pair.tangential}) {
      int sum = 0;
      for (const int weight : patch) sum += std::abs(weight);
      largest = std::max(largest, sum);
    }
  CHECK(largest < 32768 && largest > 32750);
}

TEST(ResponseTable, ThePeakOfAPressingLoadHasItsSign) {
  LONGS_EQUAL(-1, responseTable(config_).peakSign);
  config_.gauges.component = StrainComponent::kHoop;
  LONGS_EQUAL(1, responseTable(config_).peakSign);
}
