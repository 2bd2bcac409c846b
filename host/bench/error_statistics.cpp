#include "host/bench/error_statistics.hpp"

#include <cmath>
#include <numbers>

#include "common/fixed_real.hpp"
#include "firmware/core/estimate.hpp"
#include "firmware/core/pipeline.hpp"
#include "host/base/angles.hpp"
#include "host/evidence/touches.hpp"
#include "host/tables/table_builder.hpp"

namespace strainfinger::bench {
namespace {

/// An answer counts as soon as there is one that no search goes on for, or after so many sample sets: a weak
/// touch is one only once contacts explain some sets in a row. Sets of one touch are numbered one after the
/// other.
constexpr std::uint64_t kMostSets = 128;

/// Width of the semi-ellipse, as something round presses, with the second moment of a uniform pressure.
double roundWidth_m(double uniformWidth_m) { return uniformWidth_m * std::sqrt(16.0 / 12); }

}  // namespace

Trial::Trial(const config::FingerConfig& actual, const config::FingerConfig& told, std::uint64_t seed)
    : actual_(actual), tables_(tables::buildTableImage(told)), ring_(actual, seed), seed_(seed) {}

void Trial::touch(const simulation::Touch& touch, int repeats, ErrorStatistics& statistics) {
  const Eigen::VectorXd exact = ring_.exact(touch);
  for (int repeat = 0; repeat < repeats; ++repeat, ++touch_) judge(exact, touch, statistics);
}

void Trial::touchAnywhere(double load_n_per_m, int contacts, ErrorStatistics& statistics) {
  evidence::TouchRanges ranges;
  ranges.load_n_per_m = {load_n_per_m, load_n_per_m};
  const evidence::TouchDraws draws(actual_.gauges, ranges, seed_);
  for (int contact = 0; contact < contacts; ++contact) {
    simulation::Touch touched = draws.at(touch_);
    touched.width_m = roundWidth_m(actual_.contact.width_m.value_or(0));
    touch(touched, 1, statistics);
  }
}

void Trial::judge(const Eigen::VectorXd& exact, const simulation::Touch& touch,
                  ErrorStatistics& statistics) const {
  ++statistics.contacts;
  firmware::Pipeline pipeline(tables_, firmware::FitMode::kRefined);
  for (std::uint64_t set = 0; set < kMostSets; ++set)
    if (pipeline.process(ring_.codes(exact, touch_ * kMostSets + set)).touched &&
        !pipeline.answer().searching)
      break;
  if (!pipeline.observation().touched) {
    ++statistics.unnoticed;
    return;
  }
  const Contact contact = firmware::estimate(tables_.constants, pipeline.answer(),
                                             firmware::unitErrors(pipeline.linearisation()), 0);
  if (contact.uncertain || pipeline.observation().several) {
    ++statistics.uncertain;
    return;
  }
  const double apart_rad = shortWay_rad(toReal(contact.angle) * 2 * std::numbers::pi, touch.angle_rad);
  statistics.wrong += std::abs(apart_rad) > std::numbers::pi / actual_.gauges.count ? 1 : 0;
  statistics.arc_mm.add(apart_rad * actual_.finger.outer_radius_m * 1e3);
  statistics.normal_n_per_m.add(toReal(contact.normal) - touch.normal_n_per_m);
  statistics.tangential_n_per_m.add(toReal(contact.tangential) - touch.tangential_n_per_m);
}

}  // namespace strainfinger::bench
