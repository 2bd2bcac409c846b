// Every method that ours is compared with gives the truth where it should, within what it can: a broken rival
// would flatter.
#include <cmath>
#include <cstdio>
#include <memory>

#include "host/bench/make_knowledge.hpp"
#include "host/bench/methods/levenberg_marquardt.hpp"
#include "host/bench/methods/scan_and_step.hpp"
#include "host/bench/training.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::bench;

namespace {

/// Clean strains of a contact.
template <typename Real>
Ring<Real> strainsOf(const BenchFinger& finger, const Place<double>& place) {
  Ring<Real> strains;
  for (int gauge = 0; gauge < kGauges; ++gauge) {
    const auto value = finger.response(gauge - place.position_pitch);
    strains[gaugeOf(gauge)] =
        static_cast<Real>(place.normal * value.normal + place.tangential * value.tangential);
  }
  return strains;
}

Knowledge knowledgeFor(const BenchFinger& finger) {
  return makeKnowledge(finger, {.steps = 1, .contacts = 64});
}

}  // namespace

TEST_GROUP(Methods) {
  const BenchFinger finger;
  const std::unique_ptr<const Knowledge> known = std::make_unique<const Knowledge>(knowledgeFor(finger));

  static double apart(double a, double b) { return std::abs(std::remainder(a - b, double{kGauges})); }

  template <typename Real>
  static void checkPlace(const Place<double>& truth, const Place<Real>& found, double pitches,
                         double load_n_per_m) {
    CHECK(apart(double{found.position_pitch}, truth.position_pitch) <= pitches);
    DOUBLES_EQUAL(truth.normal, double{found.normal}, load_n_per_m);
    DOUBLES_EQUAL(truth.tangential, double{found.tangential}, load_n_per_m);
  }

  static simulation::Touch wideTouch(const Place<double>& place, double width_m) {
    return {.angle_rad = place.position_pitch * BenchFinger::pitch_rad(),
            .normal_n_per_m = place.normal,
            .tangential_n_per_m = place.tangential,
            .width_m = width_m};
  }
  /// Of a semi-ellipse, as a fraction of that of a uniform pressure 8 mm wide, the config's largest.
  static double momentOf(double width_m) { return width_m * width_m / 16 / (8e-3 * 8e-3 / 12); }
  Sample wideSample(const Place<double>& place, double width_m) const {
    const Eigen::VectorXd strains = finger.readings(wideTouch(place, width_m));
    Sample sample{};
    for (int gauge = 0; gauge < kGauges; ++gauge)
      sample.strain[gaugeOf(gauge)] = static_cast<float>(strains[gauge]);
    return sample;
  }

  /// The benchmark's clean readings, all of them right.
  template <typename Fit>
  void checkEveryReading(Fit fit, double pitches) const {
    constexpr std::uint64_t kSeed = 77;
    std::printf("seed %llu ", static_cast<unsigned long long>(kSeed));
    for (std::uint64_t i = 0; i < 500; ++i) {
      const Reading reading = readingOf(finger, kSeed, i, 0);
      CHECK(apart(double{fit(reading.sample).position_pitch}, reading.truth.position_pitch) <= pitches);
    }
  }
};

// The tables' claim: 1e-5 of the peak.
TEST(Methods, TheTableOfResponsesIsAsGoodAsTheModel) {
  const auto table = makeResponse<double>(finger);
  for (double pitches = -20; pitches < 20; pitches += 0.0137) {
    const auto model = finger.response(pitches);
    const auto here = table.at(pitches);
    DOUBLES_EQUAL(model.normal, here.normal, 1e-5 * finger.peakPerLoad());
    DOUBLES_EQUAL(model.tangential, here.tangential, 1e-5 * finger.peakPerLoad());
    DOUBLES_EQUAL(model.normalSlope, here.normalSlope, 1e-3 * finger.peakPerLoad());
  }
}

TEST(Methods, CentroidAndParabolaFindAContactRightOverAGauge) {
  for (const int gauge : {0, 5, 15}) {
    const auto strains = strainsOf<float>(finger, {double(gauge), 30, 0});
    CHECK(apart(double{centroid(strains).position_pitch}, gauge) < 1e-4);
    CHECK(apart(double{parabola(strains).position_pitch}, gauge) < 1e-4);
  }
}

// The response is narrower than the pitch: the neighbours are pulled, and tell these two nothing of the 0.3
// pitches.
TEST(Methods, CentroidAndParabolaStayAboutTheGaugeBesideAContact) {
  const auto strains = strainsOf<float>(finger, {5.3, 30, 0});
  CHECK(apart(double{centroid(strains).position_pitch}, 5) < 0.2);
  CHECK(apart(double{parabola(strains).position_pitch}, 5) < 0.2);
  CHECK(std::isnan(centroid(strains).normal));
}

// A template between two of its 64 a pitch: 1/100 of a pitch, 2 % of the load.
TEST(Methods, TemplatesFindAStraightLoad) {
  for (const double position : {0.013, 4.31, 15.83}) {
    const auto found = correlateTemplates(known->templates, strainsOf<float>(finger, {position, 30, 0}));
    CHECK(apart(double{found.position_pitch}, position) < 0.01);
    DOUBLES_EQUAL(30, double{found.normal}, 0.6);
  }
}

TEST(Methods, GaussNewtonFindsTheTruthFromNearby) {
  for (const double position : {0.02, 7.37, 15.9}) {
    const Place<double> truth{position, 25, -8};
    const auto strains = strainsOf<double>(finger, truth);
    const auto found =
        gaussNewton<kGauges, double>(makeResponse<double>(finger), strains, {position + 0.04, 22, -5}, 20);
    checkPlace(truth, found.place, 1e-3, 0.05);
  }
}

TEST(Methods, LevenbergMarquardtFindsTheTruthFromNearby) {
  for (const double position : {0.02, 7.37, 15.9}) {
    const Place<double> truth{position, 25, -8};
    const Place<float> start{static_cast<float>(position + 0.1), 20, 0};
    checkPlace(truth, levenbergMarquardt(known->response, strainsOf<float>(finger, truth), start), 1e-3,
               0.05);
  }
}

TEST(Methods, TheStartAtTheCentroidHasTheStrongestGaugesStrain) {
  const auto start = startAtCentroid(known->response, strainsOf<float>(finger, {6, 30, 0}));
  checkPlace<float>({6, 30, 0}, start, 1e-4, 1e-3);
}

TEST(Methods, OneOfTheScansStartsLeadsToTheTruth) {
  const Place<double> truth{9.28, 28, 11};
  checkPlace(truth, scanAndStep(known->response, known->scan, strainsOf<float>(finger, truth)).place, 1e-3,
             0.02);
}

TEST(Methods, ScanOrSearchIsRightForEveryReading) {
  checkEveryReading(
      [&](const Sample& s) { return scanOrSearch(known->response, known->scan, known->global, s.strain); },
      2e-3);
}

TEST(Methods, TheGlobalSearchIsRightForEveryReading) {
  GlobalSearch<float> search(known->response, known->global);
  checkEveryReading([&](const Sample& s) { return search(s.strain); }, 2e-3);
}

TEST(Methods, TheReferenceIsRightToATenThousandthOfAPitch) {
  const auto response = makeResponse<double>(finger);
  const auto bank = makeGlobalBank<double>(finger);
  GlobalSearch<double> search(response, bank);
  const Place<double> truth{12.61, 21, 21};
  checkPlace(truth, search(strainsOf<double>(finger, truth)), 1e-4, 2e-3);
}

// The firmware's tables are within 6e-4 of the largest response.
TEST(Methods, ThePatchesAreAsGoodAsTheModelForEveryWidth) {
  const auto patches = makePatches<double>(finger);
  const evidence::FitModel fit(finger.config());
  for (const double width_m : {0.0, 1e-3, 3.3e-3, 7.5e-3}) {
    const evidence::FittedContact contact = fit.describe(wideTouch({5.37, 25, -11}, width_m));
    const Eigen::VectorXd model = fit.readings({&contact, 1});
    for (int gauge = 0; gauge < kGauges; ++gauge) {
      const auto at = patches.at(gauge - 5.37, {{5.37, 25, -11}, momentOf(width_m)});
      DOUBLES_EQUAL(model[gauge], 25 * at.normal.value - 11 * at.tangential.value,
                    1e-3 * 36 * finger.peakPerLoad());
    }
  }
}

TEST(Methods, ThePatchesSlopesAreTheirDerivatives) {
  const auto patches = makePatches<double>(finger);
  const Place<double> place{0, 25, -11};
  for (const double pitches : {-2.31, -0.41, 0.17, 1.71}) {
    const auto before = patches.at(pitches - 1e-5, {place, 0.2 - 1e-5});
    const auto at = patches.at(pitches, {place, 0.2});
    const auto after = patches.at(pitches + 1e-5, {place, 0.2 + 1e-5});
    const auto check = [&](const auto& low, const auto& middle, const auto& high) {
      DOUBLES_EQUAL((high.value - low.value) / 2e-5, middle.slope + middle.widening,
                    1e-4 * finger.peakPerLoad());
    };
    check(before.normal, at.normal, after.normal);
    check(before.tangential, at.tangential, after.tangential);
  }
}

TEST(Methods, FitsOfTheWidthFindTheTruthFromNearby) {
  for (const double width_m : {1e-3, 2.5e-3, 4e-3}) {
    const Place<double> truth{7.37, 28, -8};
    const Sample sample = wideSample(truth, width_m);
    const Place<float> start{7.45f, 25, 0};
    const auto end = fitWidth<9, float>(known->patches, sample.strain, {start, 0.1f}, 20);
    checkPlace(truth, end.contact.place, 0.01, 0.3);
    checkPlace(truth, levenbergMarquardtOfWidth(known->patches, sample.strain, start), 0.01, 0.3);
  }
}

TEST(Methods, SearchesOfTheWidthFindTheTruth) {
  const Place<double> truth{12.61, 24, 17};
  for (const double width_m : {1e-3, 2.5e-3}) {
    const Sample sample = wideSample(truth, width_m);
    checkPlace(truth, scanAndFitWidth(known->patches, known->scan, sample.strain), 0.01, 0.3);
    checkPlace(truth, GlobalWidthSearch(known->patches, known->widths)(sample.strain), 0.01, 0.3);
  }
}

TEST(Methods, AWidthStaysWithinTheTableAndTheOthersAreSolvedForIt) {
  const Place<double> truth{3.2, 30, 5};
  const Sample line = wideSample(truth, 0);
  const auto end = fitWidth<9, float>(known->patches, line.strain, {{3.25f, 30, 0}, 0.01f}, 20);
  CHECK(end.contact.moment >= 0 && end.contact.moment < 0.01f);
  checkPlace(truth, end.contact.place, 0.01, 0.3);
}

TEST(Methods, NoStrainIsNoPlace) {
  const Ring<float> none{};
  CHECK(!isPossible(GlobalSearch(known->response, known->global)(none)));
  CHECK(!isPossible(
      gaussNewton<kWindow>(known->response, none, startAtCentroid(known->response, none), 5).place));
}
