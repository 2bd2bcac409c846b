#include "firmware/core/estimate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>

#include "common/fixed_real.hpp"
#include "tests/firmware/core/model_ring.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::firmware;

namespace {

/// An answer to the readings of presses, and its estimates.
struct Estimated : Utest {
  Locator locator{FitMode::kRefined};

  std::vector<Contact> found(const ModelRing& ring, std::span<const Press> presses) {
    locateOnce(ring.tables(), ring.raw(ring.strains(presses)), ring.allGauges(), locator);
    std::vector<Contact> contacts;
    for (int k = 0; k < locator.answer().solution.hypothesis.contacts; ++k)
      contacts.push_back(
          estimate(ring.constants(), locator.answer(), unitErrors(locator.linearisation()), k));
    return contacts;
  }
  Contact found(const ModelRing& ring, const Press& press) { return found(ring, {&press, 1}).front(); }
  static double sigmaAngle_pitch(const ModelRing& ring, const Contact& contact) {
    return toReal(contact.sigmaAngle) * ring.gauges();
  }
  /// Place and loads, over the Cramer-Rao bound.
  static void checkSigmas(const ModelRing& ring, const Contact& contact, const Eigen::Vector4d& bound,
                          double tolerance) {
    DOUBLES_EQUAL(1, sigmaAngle_pitch(ring, contact) / bound[0], tolerance);
    DOUBLES_EQUAL(1, toReal(contact.sigmaNormal) / bound[1], tolerance);
    DOUBLES_EQUAL(1, toReal(contact.sigmaTangential) / bound[2], tolerance);
  }
};

}  // namespace

TEST_GROUP_BASE(EstimatedErrors, Estimated) { const ModelRing ring{ModelRing::asDrawn()}; };

TEST(EstimatedErrors, AContactOfFewStandardDeviationsOfNoiseIsUncertain) {
  config::FingerConfig lines = ModelRing::asDrawn();
  lines.contact.width_m = 0;
  const ModelRing known{lines};
  double strainPerLoad = 0;
  for (double position = 5; position <= 5.5; position += 0.01)
    for (const double strain : known.strains({position, 1, 0, 0}))
      strainPerLoad = std::max(strainPerLoad, std::abs(strain));
  int unambiguous = 0;
  for (const double sigmas : {30.0, 60.0, 92.0, 102.0, 130.0})
    for (double position = 5; position < 6; position += 0.05) {
      const Press press{position, sigmas * known.noise_strain() / strainPerLoad, 0, 0};
      const Contact contact = found(known, press);
      if (contact.ambiguous) continue;
      ++unambiguous;
      CHECK_EQUAL(sigmas < 95, contact.uncertain);
    }
  CHECK(unambiguous > 20);
}

// The model is linearised where the tables have the contact.
TEST(EstimatedErrors, AreTheCramerRaoBoundWithTheWidthUnknown) {
  for (const double width_mm : {0.5, 1.0, 2.0, 3.0, 4.0})
    for (double position = 5; position < 6; position += 0.1) {
      const Press press{position, 20, 6, width_mm};
      const Contact contact = found(ring, press);
      checkSigmas(ring, contact, ring.bound(press), 0.16);
    }
}

TEST(EstimatedErrors, OfTheWidthAreTheBoundToo) {
  for (const double width_mm : {1.0, 2.0, 3.0})
    for (double position = 5; position < 6; position += 0.1) {
      const Press press{position, 20, 6, width_mm};
      const double bound_mm = 6 * ring.bound(press)[3] / width_mm;
      DOUBLES_EQUAL(1, found(ring, press).sigmaWidth_um / (1e3 * bound_mm), 0.1);
    }
}

TEST(EstimatedErrors, AreTheCramerRaoBoundOfAKnownWidth) {
  for (const double width_mm : {0.0, 2.0}) {
    const ModelRing known(ModelRing::ofKnownWidth(width_mm));
    for (double position = 5; position < 6; position += 0.1) {
      const Press press{position, 20, -6, width_mm};
      checkSigmas(known, found(known, press), known.bound(press, false), 0.1);
    }
  }
}

TEST(EstimatedErrors, AreTheBoundOnOtherRings) {
  for (const auto& config : {ModelRing::asDrawn(24), ModelRing::asDrawn(16, StrainComponent::kHoop),
                             ModelRing::asDrawn(16, StrainComponent::kShear)}) {
    const ModelRing other(config);
    for (double position = 5; position < 6; position += 0.2) {
      const Press press{position, 20, 6, 1};
      checkSigmas(other, found(other, press), other.bound(press), 0.25);
    }
  }
}

TEST(EstimatedErrors, OfTwoContactsAreTheBoundOfBothTogether) {
  for (double position = 3; position < 4; position += 0.2) {
    const std::array presses{Press{position, 20, 4, 1}, Press{position + 4.5, 15, 0, 1}};
    const auto contacts = found(ring, presses);
    LONGS_EQUAL(2, contacts.size());
    const auto bounds = ring.bounds(presses);
    const bool swapped = std::abs(toReal(contacts[0].angle) * 16 - position) > 1;
    for (const std::size_t k : {0u, 1u}) checkSigmas(ring, contacts[k], bounds[swapped ? 1 - k : k], 0.15);
  }
}

TEST(EstimatedErrors, GrowWithTheModelsError) {
  config::FingerConfig config = ModelRing::asDrawn();
  config.gauges.model_error = 0.02;
  const ModelRing glued(config);
  const double load = std::ldexp(glued.constants().load_scale_error_q16, -16),
               place_pitch = std::ldexp(glued.constants().place_error_q32, -32) * 16;
  for (double position = 5; position < 6; position += 0.1) {
    const Press press{position, 20, 4, 1};
    Eigen::Vector4d bound = glued.bound(press, glued.deviations(glued.strains(press)));
    CHECK_COMPARE(bound[0], >, 2 * glued.bound(press)[0]);
    const Eigen::Vector3d unseen(place_pitch, load * press.normal, load * press.tangential);
    for (Eigen::Index i = 0; i < 3; ++i) bound[i] = std::hypot(bound[i], unseen[i]);
    checkSigmas(glued, found(glued, press), bound, 0.1);
  }
}

TEST_GROUP_BASE(Estimate, Estimated) {
  const ModelRing ring{ModelRing::asDrawn()};
  TableConstants constants = ring.constants();
  Answer answer;
  Linearisation linearisation;

  void setup() override {
    const Press press{5.3, 20, 4, 1.5};
    locateOnce(ring.tables(), ring.raw(press), ring.allGauges(), locator);
    answer = locator.answer();
    linearisation = locator.linearisation();
    answer.solution.residualEnergy = 0;
  }
  Contact estimated() { return estimate(constants, answer, unitErrors(linearisation), 0); }
  /// Of the width's square, which does not depend on where the answer is: its slope times the width's error.
  double sigmaOfSquare_mm2() {
    const double width_mm = 1.5;
    answer.solution.contact[0].moment_q20 = ring.stateOf({5.3, 20, 4, width_mm}, answer.shift).moment_q20;
    return 2 * width_mm * 1e-3 * estimated().sigmaWidth_um;
  }
  /// Leaves so many variances for each degree of freedom.
  void leave(double times) {
    const int left = freedoms(answer.solution.hypothesis);
    answer.solution.residualEnergy = static_cast<Wide>(times * left * answer.variances.reading_q4 / 16);
  }
  /// Nearly as likely.
  void setRival(double pitches) {
    answer.rival.contact[0].angle_q32 =
        answer.solution.contact[0].angle_q32 +
        static_cast<std::uint32_t>(static_cast<std::int64_t>(std::ldexp(pitches, 28)));
    answer.rival.any = answer.rival.isAsLikely = true;
  }
};

TEST(Estimate, PlacesLoadsAndWidthsAreTheAnswers) {
  Presses presses(16, 25, 701, 0.2, 6);
  for (int i = 0; i < 1000; ++i) {
    const Press press = presses.next();
    answer.solution.contact[0] = ring.stateOf(press, answer.shift);
    const Contact contact = estimated();
    DOUBLES_EQUAL(0, ring.between(press.position_pitch, toReal(contact.angle) * 16), 1e-6);
    // Half a unit of an amplitude.
    DOUBLES_EQUAL(press.normal, toReal(contact.normal), 1e-3);
    DOUBLES_EQUAL(press.tangential, toReal(contact.tangential), 1e-3);
    const double square_mm2 = press.width_mm * press.width_mm;
    const double told_mm2 = (square_mm2 + std::hypot(square_mm2, sigmaOfSquare_mm2())) / 2;
    DOUBLES_EQUAL(std::sqrt(told_mm2) * 1e3, contact.width_um, 2 + 10 / press.width_mm);
  }
}

// Moments that noise scatters by up to a half of themselves. Their roots are up to 5 % too narrow in the
// mean.
TEST(Estimate, AWidthIsWhatTouchesHaveInTheMean) {
  std::mt19937 random(703);
  const double sigma_mm2 = sigmaOfSquare_mm2();
  for (const double share : {0.1, 0.2, 0.3, 0.4, 0.5}) {
    const double square_mm2 = sigma_mm2 / share, width_mm = std::sqrt(square_mm2);
    std::normal_distribution scatter(square_mm2, sigma_mm2);
    double sum_mm = 0, error_mm2 = 0;
    constexpr int kTouches = 20'000;
    for (int i = 0; i < kTouches; ++i) {
      const Press press{5.3, 20, 4, std::sqrt(std::max(scatter(random), 0.0))};
      answer.solution.contact[0].moment_q20 = ring.stateOf(press, answer.shift).moment_q20;
      const double told_mm = 1e-3 * estimated().width_um;
      sum_mm += told_mm;
      error_mm2 += (told_mm - width_mm) * (told_mm - width_mm);
    }
    DOUBLES_EQUAL(width_mm, sum_mm / kTouches, 0.015 * width_mm);
    CHECK_COMPARE(std::sqrt(error_mm2 / kTouches), <, 1.03 * sigma_mm2 / (2 * width_mm));
  }
}

// Cut off, they would be half a micrometre too small.
TEST(Estimate, StandardErrorsOfWidthsAreRoundedToTheNearest) {
  const auto told = [this](double width_mm) {
    answer.solution.contact[0].moment_q20 = ring.stateOf({5.3, 20, 4, width_mm}, answer.shift).moment_q20;
    return estimated();
  };
  const Contact narrow = told(0.3);
  const double product_um2 = 1.0 * narrow.width_um * narrow.sigmaWidth_um;
  double off_um = 0;
  constexpr int kWidths = 400;
  for (int i = 0; i < kWidths; ++i) {
    const Contact contact = told(2 + 0.01 * i);
    off_um += contact.sigmaWidth_um - product_um2 / contact.width_um;
  }
  DOUBLES_EQUAL(0, off_um / kWidths, 0.15);
}

TEST(Estimate, AKnownWidthIsNotFitted) {
  const ModelRing known(ModelRing::ofKnownWidth(2));
  const Contact contact = found(known, Press{5.3, 20, 4, 2});
  LONGS_EQUAL(kWidthNotFitted, contact.width_um);
  LONGS_EQUAL(kWidthNotFitted, contact.sigmaWidth_um);
}

TEST(Estimate, ALinesWidthIsItsError) {
  answer.solution.contact[0].moment_q20 = 0;
  const Contact contact = estimated();
  DOUBLES_EQUAL(1e3 * std::sqrt(sigmaOfSquare_mm2() / 2), contact.width_um, 2);
  DOUBLES_EQUAL(contact.width_um, contact.sigmaWidth_um, 2);
}

TEST(Estimate, HugeLoadsSaturateWithTheirSign) {
  constants.load_exponent = static_cast<std::int16_t>(-answer.shift - 2);
  constants.load_scale = std::numeric_limits<std::int32_t>::max();
  answer.solution.contact[0].normal = kMostLoad;
  answer.solution.contact[0].tangential = -kMostLoad;
  CHECK(estimated().normal == LineLoadQ12::max());
  CHECK(estimated().tangential == LineLoadQ12::min());
}

TEST(Estimate, ALoadBeyondWhatAFitHoldsIsUncertain) {
  CHECK_FALSE(estimated().uncertain);
  answer.solution.contact[0].tangential = -kMostLoad;
  CHECK_TRUE(estimated().uncertain);
  answer.solution.contact[0].tangential = 0;
  answer.solution.contact[0].normal = kMostLoad;
  CHECK_TRUE(estimated().uncertain);
}

TEST(Estimate, ChiIsTheRootOfChiSquaredAFreedom) {
  for (const double times : {0.0, 0.25, 1.0, 4.0, 100.0}) {
    leave(times);
    DOUBLES_EQUAL(16 * std::sqrt(times), estimated().chi_q4, 1);
  }
}

TEST(Estimate, ChiSaturatesShortOfNone) {
  leave(1e9);
  CHECK(estimated().chi_q4 < kNoChi);
  answer.variances.reading_q4 = 4;
  answer.solution.residualEnergy = Wide{1} << 36;
  LONGS_EQUAL(kNoChi - 1, estimated().chi_q4);
}

TEST(Estimate, WithoutAFreedomThereIsNoChi) {
  answer.solution.hypothesis.gauges = 0b1111;
  LONGS_EQUAL(kNoChi, estimated().chi_q4);
}

TEST(Estimate, QualityIs100UpToTheGateAndAbove20Accepted) {
  leave(1);
  LONGS_EQUAL(100, estimated().quality);
  leave(8);  // 96 of 52
  DOUBLES_EQUAL(100 * 52 / 96, estimated().quality, 1);
  leave(1000);
  LONGS_EQUAL(21, estimated().quality);
  CHECK_FALSE(estimated().uncertain);
}

TEST(Estimate, WhatIsNotAcceptedIsUncertain) {
  answer.accepted = false;
  LONGS_EQUAL(20, estimated().quality);
  CHECK_TRUE(estimated().uncertain);
}

TEST(Estimate, WhatIsStillSearchedIsUncertain) {
  answer.searching = true;
  LONGS_EQUAL(20, estimated().quality);
  CHECK_TRUE(estimated().uncertain);
}

TEST(Estimate, WhatCalibrationLeavesIsPartOfTheErrors) {
  const Contact alone = estimated();
  constants.place_error_q32 = 3 * alone.sigmaAngle.raw();
  constants.load_error_q16 = 1311;  // 2 % of 20 N/m: 0.4 N/m of both loads
  const Contact calibrated = estimated();
  DOUBLES_EQUAL(std::sqrt(10.0), toReal(calibrated.sigmaAngle) / toReal(alone.sigmaAngle), 1e-3);
  DOUBLES_EQUAL(std::hypot(0.4, toReal(alone.sigmaNormal)), toReal(calibrated.sigmaNormal), 1e-3);
  DOUBLES_EQUAL(std::hypot(0.4, toReal(alone.sigmaTangential)), toReal(calibrated.sigmaTangential), 1e-3);
  LONGS_EQUAL(alone.sigmaWidth_um, calibrated.sigmaWidth_um);
}

TEST(Estimate, ARivalIsAsAmbiguousWhateverErrorAllPlacesShare) {
  setRival(0.9);
  constants.place_error_q32 = kMostPlaceError_q32;
  CHECK_TRUE(estimated().ambiguous);
}

// The second moment is w^2 / 12: 1.5 mm +- d is 0.1875 mm^2 +- 0.25 mm d.
TEST(Estimate, AnErrorOfSecondMomentsIsOneOfWidths) {
  const double alone_um = estimated().sigmaWidth_um, more_um = 40;
  constants.moment_error_q16 =
      static_cast<std::uint16_t>(std::ldexp(250 * more_um / constants.largest_moment_um2, 16));
  DOUBLES_EQUAL(std::hypot(alone_um, more_um), estimated().sigmaWidth_um, 2);
}

// A fifth of 20 and of 4 N/m.
TEST(Estimate, TheScaleOfLoadsIsAnErrorOfEachLoad) {
  const Contact alone = estimated();
  constants.load_scale_error_q16 = 13107;
  const Contact scaled = estimated();
  DOUBLES_EQUAL(std::hypot(4, toReal(alone.sigmaNormal)), toReal(scaled.sigmaNormal), 0.01);
  DOUBLES_EQUAL(std::hypot(0.8, toReal(alone.sigmaTangential)), toReal(scaled.sigmaTangential), 0.01);
}

TEST(Estimate, TheLargestErrorsOfTablesSaturate) {
  answer.solution.contact[0].normal = kMostLoad;
  constants.load_exponent = static_cast<std::int16_t>(-answer.shift - 2);
  constants.load_scale = std::numeric_limits<std::int32_t>::max();
  constants.place_error_q32 = kMostPlaceError_q32;
  constants.load_scale_error_q16 = constants.load_error_q16 = constants.moment_error_q16 = 0xFFFF;
  const Contact contact = estimated();
  DOUBLES_EQUAL(0.25, toReal(contact.sigmaAngle), 1e-4);
  CHECK(contact.sigmaNormal == LineLoadQ12::max());
  CHECK(contact.sigmaTangential == LineLoadQ12::max());
}

TEST(Estimate, ErrorsCoverARivalThatIsNearlyAsLikely) {
  const double alone = sigmaAngle_pitch(ring, estimated());
  for (const double pitches : {0.9, -0.9}) {
    setRival(pitches);
    const Contact contact = estimated();
    CHECK_TRUE(contact.ambiguous && contact.uncertain);
    DOUBLES_EQUAL(0.3, sigmaAngle_pitch(ring, contact), 1e-4);
    CHECK(sigmaAngle_pitch(ring, contact) > alone);
    const double rival = toReal(contact.angle) * 16 + pitches;
    DOUBLES_EQUAL(0, ring.between(rival, toReal(contact.alternative) * 16), 1e-4);
  }
}

TEST(Estimate, ErrorsOfLoadsAndWidthReachTheRivalToo) {
  const Contact alone = estimated();
  ContactState& told = answer.solution.contact[0];
  const ContactState rival{told.angle_q32, told.normal / 2, -told.tangential - told.normal / 4,
                           told.moment_q20 + (1 << (kMomentBits - 2))};
  const ContactState kept = std::exchange(told, rival);
  const Contact other = estimated();
  told = kept;
  answer.rival.contact[0] = rival;
  setRival(0.9);
  const Contact contact = estimated();
  const auto isThird = [](double sigma, double own, double apart, double step) {
    CHECK_COMPARE(sigma, >, own);
    DOUBLES_EQUAL(std::abs(apart) / 3, sigma, step);
  };
  isThird(toReal(contact.sigmaNormal), toReal(alone.sigmaNormal), toReal(other.normal) - toReal(alone.normal),
          1e-3);
  isThird(toReal(contact.sigmaTangential), toReal(alone.sigmaTangential),
          toReal(other.tangential) - toReal(alone.tangential), 1e-3);
  isThird(contact.sigmaWidth_um, alone.sigmaWidth_um, 1.0 * other.width_um - alone.width_um, 1);
}

TEST(Estimate, ARivalThatIsFarLessLikelyIsNone) {
  setRival(0.9);
  answer.rival.isAsLikely = false;
  CHECK_FALSE(estimated().ambiguous);
  CHECK_FALSE(estimated().uncertain);
}

TEST(Estimate, ARivalWithinTheAnswersOwnErrorsDoesNotWidenThem) {
  const double alone = sigmaAngle_pitch(ring, estimated());
  setRival(2 * alone);
  CHECK_FALSE(estimated().ambiguous);
  DOUBLES_EQUAL(alone, sigmaAngle_pitch(ring, estimated()), 1e-9);
}

TEST(Estimate, ARivalNearByIsCoveredAndNotNamed) {
  for (const double pitches : {0.37, -0.37}) {
    setRival(pitches);
    CHECK_FALSE(estimated().ambiguous);
    CHECK_FALSE(estimated().uncertain);
    DOUBLES_EQUAL(0.37 / 3, sigmaAngle_pitch(ring, estimated()), 1e-4);
  }
  for (const double pitches : {0.38, -0.38}) {
    setRival(pitches);
    CHECK_TRUE(estimated().ambiguous);
  }
}

TEST(Estimate, ARivalNearByThatNoiseMayHaveHiddenIsNamed) {
  const double alone = sigmaAngle_pitch(ring, estimated());
  answer.rival.isWithinNoise = true;
  setRival(0.2);
  CHECK_TRUE(estimated().ambiguous);
  setRival(2 * alone);
  CHECK_FALSE(estimated().ambiguous);
}

TEST(Estimate, ARivalFarAwayIsNamedHoweverLargeTheAnswersOwnErrorsAre) {
  answer.variances.reading_q4 *= 1 << 16;
  const double alone = sigmaAngle_pitch(ring, estimated());
  CHECK_COMPARE(alone, >, 0.2);
  setRival(0.5);
  CHECK_TRUE(estimated().ambiguous);
  DOUBLES_EQUAL(alone, sigmaAngle_pitch(ring, estimated()), 1e-9);
}

TEST(Estimate, ErrorsReachARivalOfAnotherWidthAtTheSamePlace) {
  const Contact alone = estimated();
  answer.rival.contact[0] = answer.solution.contact[0];
  answer.rival.contact[0].moment_q20 += 1 << (kMomentBits - 2);
  answer.rival.contact[0].normal *= 2;
  setRival(0);
  const Contact contact = estimated();
  CHECK_FALSE(contact.ambiguous);
  CHECK_COMPARE(contact.sigmaWidth_um, >, 10 * alone.sigmaWidth_um);
  DOUBLES_EQUAL(toReal(alone.normal) / 3, toReal(contact.sigmaNormal), 1e-3);
}

TEST(Estimate, WhatTheReadingsDoNotDetermineMayBeAnywhere) {
  for (auto& reciprocal : linearisation.decomposition.reciprocal) reciprocal = {};
  const Contact contact = estimated();
  UNSIGNED_LONGS_EQUAL(0x8000'0000u, contact.sigmaAngle.raw());
  CHECK(toReal(contact.sigmaNormal) > 100);
  CHECK(toReal(contact.sigmaTangential) > 100);
}

// Where the readings don't tell the width, errors of place and loads are those of a known one.
TEST(EstimatedErrors, OfATouchWhoseWidthTheReadingsDoNotTellAreUncertain) {
  const ModelRing shear{ModelRing::asDrawn(14, StrainComponent::kShear)};
  const Contact contact = found(shear, Press{1.6 / 360 * 14, 30, 15});
  CHECK(contact.sigmaWidth_um > 4000);
  CHECK_TRUE(contact.uncertain);
  CHECK_COMPARE(contact.quality, <=, kMostUncertainQuality);
  CHECK_FALSE(found(ring, Press{1.6 / 360 * 16, 30, 15}).uncertain);
}
