// Readings that the firmware predicts for gauges at depths of their own, from tables, against sums of the
// elastic model's harmonics at each gauge's own radius.
#include "host/tables/gauge_depths.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "firmware/core/fit.hpp"
#include "host/base/failure.hpp"
#include "host/model/impulse_response.hpp"
#include "host/model/pressure_profile.hpp"
#include "host/tables/gauge_gains.hpp"
#include "host/tables/table_builder.hpp"
#include "host/tables/table_text.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::tables;

namespace {

/// As deep as gauges glued by hand are, and twice that.
const std::vector<double> kDepths_m{5e-5, -5e-5, 0,     2e-5,  -3e-5, 8e-5,  -8e-5, 1e-5,
                                    0,    3e-5,  -1e-5, -2e-5, 6e-5,  -4e-5, 1e-4,  -1e-4};

config::FingerConfig fingerOf(StrainComponent component, const std::vector<double>& depths_m) {
  config::FingerConfig config;
  config.gauges.component = component;
  config.gauges.model_error = 0;
  config.calibration.depth_offset_m = depths_m;
  return config;
}

/// To a load of 1 N/m of this second moment, normal or tangential.
double strainOf(const model::ImpulseResponse& response, bool normal, double moment_rad2, double angle_rad) {
  const bool even = response.isEvenInNormal() == normal;
  double sum = 0;
  for (int n = 0; n <= response.harmonics(); ++n)
    sum +=
        (even ? response.even()[n] * std::cos(n * angle_rad) : response.odd()[n] * std::sin(n * angle_rad)) *
        model::spreadFactor(model::Profile::kEllipse, n, moment_rad2).value;
  return sum;
}

/// Tables of a finger, asked for its readings.
class Asked {
 public:
  explicit Asked(const config::FingerConfig& config)
      : config_(config), image_(std::make_unique<TableImage>(buildTableImage(config))) {
    const ResponseTable responses = responseTable(config, depthFit(config).growth);
    unit_ = std::ldexp(responses.strainPerUnit, -15);
    largest_rad2_ = responses.largestMoment_m2 / std::pow(config.finger.outer_radius_m, 2);
    const auto factors = correctionFactors(image_->gains, config.gauges.count);
    for (int i = 0; i < config.gauges.count; ++i) {
      factor_.push_back(factors[static_cast<std::size_t>(i)]);
      gauge_.emplace_back(config.finger.annulus(), config.calibrated(i).radius_m, config.gauges.component);
    }
  }

  /// Root of the mean over the gauges of the square of the largest difference for contacts of this width
  /// anywhere, over the largest reading of a line. A contact that only pulls slips.
  double difference(double width_m, bool normal) {
    std::vector<double> largest(gauge_.size(), 0);
    const double moment_rad2 = model::momentOfWidth(width_m / config_.finger.outer_radius_m);
    firmware::ContactStates contacts{};
    contacts[0].moment_q20 = static_cast<std::int32_t>(std::ldexp(moment_rad2 / largest_rad2_, kMomentBits));
    (normal ? contacts[0].normal : contacts[0].tangential) = 1 << 16;
    for (int i = 0; i < kPlaces; ++i) {
      contacts[0].angle_q32 = static_cast<std::uint32_t>(i) << (32 - 8);
      firmware::linearise(*image_, {1, true, 0xFFFF}, contacts, linearisation_);
      for (std::size_t gauge = 0; gauge < gauge_.size(); ++gauge)
        largest[gauge] =
            std::max(largest[gauge], std::abs(differenceOf(gauge, contacts[0], normal, moment_rad2)));
    }
    double squares = 0;
    for (const double each : largest) squares += each * each;
    return std::sqrt(squares / static_cast<double>(largest.size())) / (32768 * unit_);
  }

  const TableImage& image() const { return *image_; }

 private:
  static constexpr int kPlaces = 256;

  double differenceOf(std::size_t gauge, const firmware::ContactState& contact, bool normal,
                      double moment_rad2) const {
    const double angle_rad =
        2 * std::numbers::pi * std::ldexp(image_->gauge_angle_q32[gauge] - contact.angle_q32, -32);
    return factor_[gauge] * strainOf(gauge_[gauge], normal, moment_rad2, angle_rad) -
           unit_ * linearisation_.predicted[gauge];
  }

  config::FingerConfig config_;
  std::unique_ptr<TableImage> image_;
  firmware::Linearisation linearisation_{};
  double unit_, largest_rad2_;
  std::vector<double> factor_;
  std::vector<model::ImpulseResponse> gauge_;
};

/// Largest differences over widths and loads, and what the tables say of them, for what patches alone are
/// off.
void checkDifferences(const config::FingerConfig& config, double most) {
  config::FingerConfig drawnConfig = config;
  drawnConfig.calibration.depth_offset_m.clear();
  Asked deep(config), drawn(drawnConfig);
  double largest = 0;
  for (const double width_m : {0.0, 1e-3, 2e-3, 4e-3})
    for (const bool normal : {true, false}) {
      const double difference = deep.difference(width_m, normal);
      CHECK_COMPARE(difference, <, drawn.difference(width_m, normal) + most);
      largest = std::max(largest, difference);
    }
  const double told = std::ldexp(deep.image().constants.model_error_q16, -16);
  CHECK_COMPARE(largest, <, 1.5 * told + 2e-4);
  CHECK_COMPARE(told, <, 1.2 * most);
}

}  // namespace

TEST_GROUP(GaugeDepths) {};

// As factors only, depths leave 0.6 %.
TEST(GaugeDepths, ReadingsFollowThemOfWhateverWidth) {
  checkDifferences(fingerOf(StrainComponent::kRadial, kDepths_m), 1e-3);
  checkDifferences(fingerOf(StrainComponent::kHoop, kDepths_m), 1e-3);
  checkDifferences(fingerOf(StrainComponent::kShear, kDepths_m), 4e-3);
}

TEST(GaugeDepths, ReadingsFollowThemInRubberThatCanBeCompressed) {
  config::FingerConfig config = fingerOf(StrainComponent::kRadial, kDepths_m);
  config.finger.poisson_ratio = 0.47;
  checkDifferences(config, 1e-3);
}

TEST(GaugeDepths, AreRightToSecondOrderForSmallOnes) {
  std::vector<double> half_m = kDepths_m;
  for (double& each_m : half_m) each_m /= 2;
  const auto told = [](const config::FingerConfig& config) {
    return std::ldexp(buildTableImage(config).constants.model_error_q16, -16);
  };
  CHECK_COMPARE(told(fingerOf(StrainComponent::kRadial, half_m)), <,
                0.6 * told(fingerOf(StrainComponent::kRadial, kDepths_m)));
}

TEST(GaugeDepths, OfAKnownWidthAreThoseOfThatWidth) {
  for (const double width_m : {0.0, 2e-3}) {
    config::FingerConfig config = fingerOf(StrainComponent::kRadial, kDepths_m);
    config.contact.width_m = width_m;
    CHECK_COMPARE(std::ldexp(buildTableImage(config).constants.model_error_q16, -16), <, 1e-3);
    CHECK_TRUE(checkTableImage(buildTableImage(config)) == TableFault::kNone);
  }
}

// One gauge of 16: its share of the ring's RMS is a quarter. The factor alone would leave 0.2 to 0.5 %.
TEST(GaugeDepths, OfOneGaugeAreTheOthersOnlyAsAnErrorOfTheModel) {
  std::vector<double> depths_m(16, 0);
  depths_m[3] = 1e-4;
  const TableImage image = buildTableImage(fingerOf(StrainComponent::kRadial, depths_m));
  for (std::size_t i = 0; i < 16; ++i) LONGS_EQUAL(i == 3 ? 127 : 0, image.depths.steps[i]);
  DOUBLES_EQUAL(1e-4, 127e-9 * image.depths.step_nm, 1e-5);
  CHECK_COMPARE(std::ldexp(image.constants.model_error_q16, -16), <, 1e-3);
}

TEST(GaugeDepths, AreNoneWithoutACalibration) {
  CHECK_TRUE(buildTableImage(fingerOf(StrainComponent::kRadial, {})).depths == GaugeDepths{});
  CHECK_TRUE(buildTableImage(fingerOf(StrainComponent::kRadial, std::vector<double>(16, 0))).depths ==
             GaugeDepths{});
}

TEST(GaugeDepths, OfOtherDepthsTablesAreAnotherFingers) {
  const config::FingerConfig config = fingerOf(StrainComponent::kRadial, kDepths_m);
  const TableImage image = buildTableImage(config);
  requireTablesOf(image, config, "f.bin");
  config::FingerConfig other = config;
  other.calibration.depth_offset_m[0] = -5e-5;
  try {
    requireTablesOf(image, other, "f.bin");
    FAIL("accepted");
  } catch (const Failure& failure) {
    LONGS_EQUAL(static_cast<int>(ExitCode::kMismatch), static_cast<int>(failure.code()));
    STRCMP_CONTAINS("calibration.depth_offset_m is [", failure.what());
    STRCMP_CONTAINS("gain_with_depth is [", failure.what());  // not the config's gains, which are the same
  }
}
