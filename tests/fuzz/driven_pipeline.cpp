#include "tests/fuzz/driven_pipeline.hpp"

#include <algorithm>
#include <cstdlib>

#include "common/fixed.hpp"

using namespace strainfinger::firmware;

namespace strainfinger::fuzz {
namespace {

/// More sets than any search takes, whatever it looks at: a ring of 16 takes 600, with each gauge left out
/// and pairs.
constexpr int kMostSearchedSets = 2000;
constexpr std::array<int, 6> kRepetitions{1, 2, 5, 16, 70, ZeroTracker::kUntilFollowed + 2};
/// Sets that one input can have: longer ones teach the fuzzer nothing.
constexpr int kMostSets = ZeroTracker::kInterval + 100;

/// The code whose strain is nearest to that.
std::uint16_t codeOf(const Calibration& calibration, std::size_t gauge, std::int64_t strain_q32) {
  const std::int64_t gain = std::max(calibration.gain[gauge], 1);
  return saturate<std::uint16_t>((calibration.zero_q15[gauge] + (strain_q32 << 32) / gain) >> kCodeBits);
}

}  // namespace

void require(bool holds) {
  if (!holds) std::abort();
}

DrivenPipeline::DrivenPipeline(const TableImage& tables, Input& input)
    : tables_(tables),
      input_(input),
      pipeline_(tables, input.within(0, 1) == 0 ? FitMode::kRefined : FitMode::kThreePoint) {}

std::span<const std::uint16_t> DrivenPipeline::codes() const {
  return std::span(codes_).first(tables_.constants.gauge_count);
}

void DrivenPipeline::takeZero() {
  ZeroAverage zero;
  while (!zero.add(codes())) {}
  pipeline_.takeZero(zero);
}

void DrivenPipeline::anyCodes() {
  for (std::uint16_t& code : codes_) code = input_.any<std::uint16_t>();
}

void DrivenPipeline::moveCodes() {
  constexpr int kStep = 16;
  for (std::uint16_t& code : codes_) code = saturate<std::uint16_t>(code + kStep * input_.any<std::int8_t>());
}

void DrivenPipeline::touchCodes() {
  const auto load = [this] { return Number{input_.any<std::int16_t>()} << 5; };
  const int shift = input_.within(0, tables_.constants.gate_shift);
  Linearisation touch;
  ContactState contact{input_.any<std::uint32_t>(), load(), load(), input_.within(0, 1 << kMomentBits)};
  linearise(tables_, {1, false, allGauges(tables_.constants.gauge_count)}, {contact}, touch);
  for (std::size_t i = 0; i < codes().size(); ++i)
    codes_[i] = codeOf(pipeline_.calibration(), i, std::int64_t{touch.predicted[i]} << shift);
}

void DrivenPipeline::nextCodes() {
  switch (input_.within(0, 2)) {
    case 0:
      return anyCodes();
    case 1:
      return moveCodes();
    default:
      return touchCodes();
  }
}

void DrivenPipeline::report(const Observation& observation) {
  const auto frames = reporter_.frames(tables_.constants, observation, pipeline_.answer(),
                                       pipeline_.linearisation(), now_us_);
  gaugesFrame(observation.outOfUse, pipeline_.zeroTracker(), 1000);
  if (!frames) return;
  if (observation.touched)
    require(frames->contact.angle_cdeg < 36000 && frames->contact.quality_percent <= 100);
  reporter_.sent(*frames, now_us_);
}

void DrivenPipeline::process() {
  const Observation& observation = pipeline_.process(codes());
  report(observation);
  now_us_ += 1000;
  searching_ = observation.touched && pipeline_.answer().searching;
}

void DrivenPipeline::run() {
  nextCodes();
  takeZero();
  for (int sets = 0; sets < kMostSets && !input_.isAtEnd();) {
    const int repetitions =
        kRepetitions[static_cast<std::size_t>(input_.within(0, int{kRepetitions.size()} - 1))];
    nextCodes();
    for (int i = 0; i < repetitions; ++i) process();
    sets += repetitions;
  }
  for (int sets = 0; searching_ && sets < kMostSearchedSets; ++sets) process();
}

}  // namespace strainfinger::fuzz
