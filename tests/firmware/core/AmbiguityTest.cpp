#include <array>

#include "common/fixed_real.hpp"
#include "firmware/core/detect.hpp"
#include "firmware/core/estimate.hpp"
#include "firmware/core/locate.hpp"
#include "tests/firmware/core/global_search.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::firmware;

namespace {

/// An ambiguous answer's errors are a third of the way to the other answer; the twins lie a little beside
/// both.
constexpr double kCovered = 4;

/// Two contacts whose strains the noise hides the difference of.
struct Twins {
  Press one, other;
  double apart;  ///< norm of the difference of their strains, in standard deviations of a reading
};

}  // namespace

TEST_GROUP(Ambiguity) {
  const ModelRing ring;
  const GlobalSearch search{ring};

  /// The contact a distance from `press` or more that comes closest to its strains, and closer than its
  /// neighbours: the end of a flat valley is not another answer.
  Twins twinOf(const Press& press, double distance_pitch) {
    constexpr int kSteps = 16 * 16;
    const auto strains = ring.strains(press);
    std::vector<GlobalSearch::Answer> answers;
    for (int step = 0; step < kSteps; ++step) answers.push_back(search.at(step / 16.0, strains));
    Twins twins{press, press, 1e300};
    for (std::size_t step = 0; step < kSteps; ++step) {
      const auto& [other, unexplained] = answers[step];
      const double before = answers[(step + kSteps - 1) % kSteps].unexplained;
      const double after = answers[(step + 1) % kSteps].unexplained;
      const double apart = std::sqrt(unexplained) / ring.noise_strain();
      if (std::abs(ring.between(press.position_pitch, other.position_pitch)) >= distance_pitch &&
          unexplained < std::min(before, after) && std::abs(other.tangential) <= other.normal &&
          apart < twins.apart)
        twins = {press, other, apart};
    }
    return twins;
  }

  Contact contactOf(const std::vector<double>& strains) {
    const auto raw = ring.raw(strains);
    return estimate(ring.constants(),
                    locate(ring.tables(), FitMode::kRefined, raw, gateEnergy(ring.constants(), raw)));
  }
  /// Strains halfway between the twins: neither explains them better.
  std::vector<double> between(const Twins& twins) {
    auto strains = ring.strains(twins.one);
    const auto others = ring.strains(twins.other);
    for (std::size_t i = 0; i < strains.size(); ++i) strains[i] = (strains[i] + others[i]) / 2;
    return strains;
  }

  /// 1 or 2: which of the twins an angle is nearer to.
  int nearestOf(const Twins& twins, TurnQ32 angle) {
    const auto distance = [&](const Press& press) {
      return std::abs(ring.between(press.position_pitch, toReal(angle) * ring.gauges()));
    };
    return distance(twins.one) < distance(twins.other) ? 1 : 2;
  }
  void checkBothCovered(const Contact& contact, const Twins& twins) {
    CHECK_TRUE(contact.uncertain);
    CHECK(nearestOf(twins, contact.angle) != nearestOf(twins, contact.alternative));
    checkCovers(contact, twins.one);
    checkCovers(contact, twins.other);
  }
  void checkCovers(const Contact& contact, const Press& press) {
    const double position = toReal(contact.angle) * ring.gauges();
    const double sigma = toReal(contact.sigmaAngle) * ring.gauges();
    CHECK(std::abs(ring.between(position, press.position_pitch)) < kCovered * sigma);
    CHECK(std::abs(press.normal - toReal(contact.normal)) < kCovered * toReal(contact.sigmaNormal));
    CHECK(std::abs(press.tangential - toReal(contact.tangential)) <
          kCovered * toReal(contact.sigmaTangential));
  }
};

TEST(Ambiguity, OfTwoContactsThatNoiseHidesBothAreReportedAndCovered) {
  // 0.8 N/m, just above the gate: stronger contacts have next to no twins.
  Presses presses(16, 0.8, 21);
  int readings = 0, missed = 0;
  for (int i = 0; i < 250; ++i) {
    const Twins twins = twinOf(presses.next(), 0.3);
    if (twins.apart > 3) continue;  // 9 variances; answers are told apart from 12 on
    for (const auto& strains : {between(twins), ring.strains(twins.one), ring.strains(twins.other)}) {
      const Contact contact = contactOf(strains);
      ++readings;
      if (contact.ambiguous) checkBothCovered(contact, twins);
      if (!contact.ambiguous) ++missed;
    }
  }
  CHECK(readings > 60);
  // Where one twin is no peak of its own but the far end of a flat valley, it is missed.
  CHECK(missed * 20 < readings);
}

TEST(Ambiguity, ContactsWithoutATwinAreNotAmbiguous) {
  Presses presses(16, 3, 22);
  for (int i = 0; i < 60; ++i) {
    const Press press = presses.next();
    if (twinOf(press, 0.1).apart < 5) continue;
    CHECK_FALSE(contactOf(ring.strains(press)).ambiguous);
  }
}

// 0.6 N/m 1.347 pitches from gauge 0, in noise of 6 microstrain: the search finds a worse place first, then
// the contact, and a place that explains these readings best last.
TEST(Ambiguity, TheBetterRunnerUpIsNamedInWhateverOrderTheyAreFound) {
  const std::array<std::int32_t, 16> strains{-39337, -25046, 178644, 156272, 18790,  11392, 34166,  -12900,
                                             -11713, 8677,   10746,  600,    -11294, 16205, -53348, -65363};
  const Contact contact = estimate(ring.constants(), locate(ring.tables(), FitMode::kRefined, strains,
                                                            gateEnergy(ring.constants(), strains)));
  CHECK_TRUE(contact.ambiguous);
  DOUBLES_EQUAL(1.347, toReal(contact.alternative) * ring.gauges(), 0.1);
}
