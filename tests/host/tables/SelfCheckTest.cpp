#include "host/tables/self_check.hpp"

#include <cmath>
#include <memory>
#include <string>

#include "host/base/failure.hpp"
#include "host/tables/table_builder.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::tables;
using config::FingerConfig;

TEST_GROUP(SelfCheck) {
  FingerConfig config_;

  SelfCheck check() { return selfCheck(buildTableImage(config_)); }
  /// The message of a refusal; "accepted" if none.
  std::string refusal() {
    try {
      buildCheckedTables(config_);
    } catch (const Failure& failure) {
      LONGS_EQUAL(static_cast<int>(ExitCode::kUsage), static_cast<int>(failure.code()));
      return failure.what();
    }
    return "accepted";
  }
  void checkRefusal(const char* part) { STRCMP_CONTAINS(part, refusal().c_str()); }

  /// What requireLocatable() says of a result for the default finger's tables.
  static std::string verdictOn(const SelfCheck& result, const TableImage& image = buildTableImage({})) {
    try {
      requireLocatable(image, result);
      return "accepted";
    } catch (const Failure& failure) {
      return failure.what();
    }
  }
  static SelfCheck goodResult() {
    SelfCheck result;
    result.contacts = 1000;
    result.halfScale_n_per_m = 30;
    result.detected_n_per_m = 1;
    return result;
  }
};

TEST(SelfCheck, TheDefaultFingerIsLocatedAllOverTheCone) {
  const SelfCheck result = check();
  LONGS_EQUAL(2 * 9 * 5 * 2, result.contacts);
  CHECK_FALSE(result.misplaced.has_value());
  CHECK(result.uncertain < result.contacts / 10);
  STRCMP_EQUAL("accepted", refusal().c_str());
}

TEST(SelfCheck, ContactsOfKnownWidthAreLocatedInBothModes) {
  for (const double width_m : {0.0, 2e-3}) {
    config_.contact.width_m = width_m;
    const SelfCheck result = check();
    LONGS_EQUAL(17 * 9 * 2 * 2, result.contacts);
    CHECK_FALSE(result.misplaced.has_value());
    CHECK(result.uncertain < result.contacts / 10);
  }
}

// Oracle: 0.03 / 2 over the 460.603 microstrain that 1 N/m gives at most.
TEST(SelfCheck, HalfOfFullScaleIsALoadOfTheFinger) {
  DOUBLES_EQUAL(0.015 / 460.603e-6, check().halfScale_n_per_m, 1e-4);
}

// The weakest contact of the cone leaves a norm of about 0.14 of its peak (midway between two gauges); the
// gate opens at sqrt(807) steps of 2^-19.
TEST(SelfCheck, DetectionStartsWhereTheWeakestContactOpensTheGate) {
  const double gate = std::sqrt(807) * std::ldexp(1, 13 - 32);
  const double start = check().detected_n_per_m;
  CHECK(start > gate / (0.2 * 460.6e-6) && start < gate / (0.1 * 460.6e-6));
  config_.gauges.noise_strain *= 10;
  DOUBLES_EQUAL(10 * start, check().detected_n_per_m, 0.3 * start);
}

TEST(SelfCheck, AFingerWithoutFrictionIsLocated) {
  config_.contact.friction_coefficient = 0;
  const SelfCheck result = check();
  CHECK_FALSE(result.misplaced.has_value());
  CHECK(result.uncertain < result.contacts / 10);
}

TEST(SelfCheck, RingsOfAllCountsAndComponentsAtTheDefaultDepthAreLocated) {
  for (const int count : {12, 18, 32}) {
    config_.gauges.count = count;
    STRCMP_EQUAL("accepted", refusal().c_str());
  }
  config_.gauges.count = 16;
  for (const StrainComponent component : {StrainComponent::kHoop, StrainComponent::kShear}) {
    config_.gauges.component = component;
    STRCMP_EQUAL("accepted", refusal().c_str());
  }
}

TEST(SelfCheck, GaugesTooShallowForTheirSpacingAreRefusedWithWhatToChange) {
  config_.gauges.radius_m = 11.9e-3;
  const std::string message = refusal();
  STRCMP_CONTAINS("contacts cannot be located with these gauges: ", message.c_str());
  STRCMP_CONTAINS(" m wide and ", message.c_str());
  STRCMP_CONTAINS(" deg from a gauge, is located ", message.c_str());
  STRCMP_CONTAINS(
      "the gauges lie 0.0008 m below the surface (gauges.radius_m = 0.0119), where they are 0.00499 m apart "
      "(gauges.count = 16): too shallow for their spacing; use more gauges, or deeper ones",
      message.c_str());
}

TEST(SelfCheck, ShallowShearGaugesAreToldOfRadialOnes) {
  SelfCheck result = goodResult();
  result.uncertain = result.contacts;
  TableImage image = buildTableImage({});
  image.parameters.gauge_radius_m = 12e-3;
  CHECK(verdictOn(result, image).find("radial") == std::string::npos);
  image.parameters.component = StrainComponent::kShear;
  STRCMP_CONTAINS("or gauges.component = \"radial\"", verdictOn(result, image).c_str());
}

// The gauges lie 3.3 mm deep; a tenth of that can hardly be told.
TEST(SelfCheck, TablesThatCoverTooLittleWidthAreToldOfIt) {
  config_.contact.largest_width_m = 2e-4;
  checkRefusal(
      "at 0.0033 m below the surface the gauges hardly tell whether a contact is wider than "
      "contact.largest_width_m = 0.0002: make that larger, or say how wide contacts are");
  config_.contact.width_m = 2e-4;
  STRCMP_EQUAL("accepted", refusal().c_str());
}

TEST(SelfCheck, NoiseThatDrownsAContactAtHalfOfFullScaleIsRefused) {
  config_.gauges.noise_strain = 5e-4;
  checkRefusal("noise hides contacts of up to 60.5 N/m, more than half of full scale (32.6 N/m)");
  checkRefusal("gauges.noise_strain = 0.0005 is too large for gauges.full_scale_strain = 0.03");
  CHECK(refusal().find("shallow") == std::string::npos);
}

// As if the model were wrong: the responses of gauges that lie deeper.
TEST(SelfCheck, TablesOfAnotherFingerAreFoundOut) {
  TableImage image = buildTableImage({});
  config_.gauges.radius_m = 11e-3;
  image.patches = buildTableImage(config_).patches;
  const SelfCheck result = selfCheck(image);
  CHECK(result.misplaced.has_value() || result.uncertain > result.contacts / 2);
}

TEST(SelfCheck, AMisplacedContactIsToldWithPlaceLoadDirectionAndMode) {
  SelfCheck result = goodResult();
  result.misplaced = Misplaced{firmware::FitMode::kThreePoint, 7.5, -0.25, 0.002, 0.125, 2};
  STRCMP_CONTAINS(
      "a contact of 7.5 N/m normal load and -0.25 times that tangential load, 0.002 m wide and 2.81 deg from "
      "a gauge, is located 45 deg from its place without a flag (three-point fit)",
      verdictOn(result).c_str());
}

TEST(SelfCheck, AFingerThatIsMostlyUncertainIsRefused) {
  SelfCheck result = goodResult();
  result.uncertain = 500;
  STRCMP_EQUAL("accepted", verdictOn(result).c_str());
  result.uncertain = 501;
  STRCMP_CONTAINS("501 of 1000 contacts have no certain answer", verdictOn(result).c_str());
}

TEST(SelfCheck, AMisplacedContactIsToldOfRatherThanNoise) {
  SelfCheck result = goodResult();
  result.detected_n_per_m = 2 * result.halfScale_n_per_m;
  result.misplaced = Misplaced{firmware::FitMode::kRefined, 7.5, 0, 0, 0.125, 2};
  STRCMP_CONTAINS("is located 45 deg from its place", verdictOn(result).c_str());
}

TEST(SelfCheck, DetectionThatCannotBeToldIsRefused) {
  SelfCheck result = goodResult();
  result.detected_n_per_m = std::nan("");
  STRCMP_CONTAINS("noise hides contacts", verdictOn(result).c_str());
  result.detected_n_per_m = result.halfScale_n_per_m;
  STRCMP_EQUAL("accepted", verdictOn(result).c_str());
}
