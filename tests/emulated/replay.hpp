#pragma once
// The firmware's logic over generated sample sets, boiled down to a number a block.

#include "common/frames.hpp"
#include "firmware/core/estimate.hpp"
#include "firmware/core/pipeline.hpp"
#include "firmware/core/report.hpp"
#include "tests/emulated/sample_generator.hpp"

namespace strainfinger::emulated {

/// FNV-1a over 32-bit words.
class Hash {
 public:
  constexpr void add(std::uint32_t word) { value_ = (value_ ^ word) * 16777619u; }
  constexpr void add(std::int32_t word) { add(static_cast<std::uint32_t>(word)); }
  constexpr void add(const CanFrame& frame) {
    add(std::uint32_t{frame.id});
    add(static_cast<std::uint32_t>(toWord(frame)));
    add(static_cast<std::uint32_t>(toWord(frame) >> 32));
  }
  constexpr std::uint32_t value() const { return value_; }

 private:
  std::uint32_t value_ = 2166136261u;
};

inline void add(Hash& hash, const firmware::Placement& placement) {
  hash.add(placement.position);
  hash.add(placement.normal);
  hash.add(placement.tangential);
}

inline void add(Hash& hash, const firmware::TouchFrames& frames) {
  hash.add(encode(frames.contact, kFirstNode));
  hash.add(encode(frames.force, kFirstNode));
  hash.add(encode(frames.patch, kFirstNode));
  if (!frames.second) return;
  hash.add(encode(frames.second->contact, kFirstNode));
  hash.add(encode(frames.second->force, kFirstNode));
}

/// Every number of a fit, and what becomes of it on the bus.
inline void add(Hash& hash, const TableImage& tables, const firmware::Fit& fit, std::uint32_t sample) {
  add(hash, fit.best);
  add(hash, fit.alternative);
  hash.add(fit.deficit);
  hash.add(std::int32_t{fit.ambiguous} + 2 * std::int32_t{fit.settled} + 256 * fit.centre);
  for (const std::int32_t projection : fit.projection) hash.add(projection);
  hash.add(static_cast<std::int32_t>(fit.row - tables.rows.data()) * 256 + fit.up);
  hash.add(fit.information);
  hash.add(static_cast<std::int32_t>(fit.readings));
  hash.add(fit.unexplained);
  hash.add(fit.windowEnergy);
  const TableConstants& constants = tables.constants;
  add(hash, firmware::touchFrames(constants, firmware::estimate(constants, fit), std::nullopt,
                                  {FingerFlag::kContact}, static_cast<std::uint8_t>(sample)));
}

/// What would be told of it, one sample set a millisecond, and when: every seventh time the port is busy.
inline void add(Hash& hash, const TableConstants& constants, firmware::TouchReporter& reporter,
                const firmware::Observation& observation, std::uint32_t sample) {
  const std::uint32_t now_us = sample * 1000;
  const auto frames = reporter.frames(constants, observation, now_us);
  if (!frames || sample % 7 == 0) return;
  reporter.sent(*frames, now_us);
  hash.add(sample);
  add(hash, *frames);
}

/// One block from a fresh start, both modes of the locator (every fourth sample set in three-point mode too).
/// `tell(sample, hash so far)` is called after each sample set.
template <typename Tell>
std::uint32_t replayBlock(const TableImage& tables, std::uint32_t first, std::uint32_t count, Tell tell) {
  firmware::Pipeline refined(tables, firmware::FitMode::kRefined);
  firmware::Pipeline threePoint(tables, firmware::FitMode::kThreePoint);
  firmware::TouchReporter reporter(2000, {});
  Hash hash;
  for (std::uint32_t sample = first; sample < first + count; ++sample) {
    const hal::SampleSet set = generatedSamples(sample);
    const auto codes = firmware::Codes(set).first(kGauges);
    const auto look = [&](const firmware::Observation& observation) {
      hash.add(observation.saturated);
      if (observation.fit) add(hash, tables, *observation.fit, sample);
    };
    look(refined.process(codes));
    add(hash, tables.constants, reporter, refined.observation(), sample);
    if (sample % 4 == 0) look(threePoint.process(codes));
    tell(sample, hash.value());
  }
  return hash.value();
}

}  // namespace strainfinger::emulated
