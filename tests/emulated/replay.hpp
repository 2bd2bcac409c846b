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

inline void add(Hash& hash, firmware::Wide number) {
  hash.add(static_cast<std::uint32_t>(number));
  hash.add(static_cast<std::uint32_t>(number >> 32));
}

inline void add(Hash& hash, const firmware::ContactState& contact) {
  hash.add(contact.angle_q32);
  hash.add(contact.normal);
  hash.add(contact.tangential);
  hash.add(contact.moment_q20);
}

inline void add(Hash& hash, const firmware::TouchFrames& frames) {
  hash.add(encode(frames.contact, kFirstNode));
  hash.add(encode(frames.force, kFirstNode));
  hash.add(encode(frames.patch, kFirstNode));
  if (!frames.second) return;
  hash.add(encode(frames.second->contact, kFirstNode));
  hash.add(encode(frames.second->force, kFirstNode));
}

/// Every number of an answer, and what becomes of it on the bus.
inline void add(Hash& hash, const firmware::Pipeline& pipeline, std::uint32_t sample) {
  const firmware::Answer& answer = pipeline.answer();
  const firmware::Hypothesis& hypothesis = answer.solution.hypothesis;
  for (const firmware::ContactState& contact : answer.solution.contacts()) add(hash, contact);
  for (const firmware::ContactState& contact : answer.rival.contact) add(hash, contact);
  add(hash, answer.solution.residualEnergy);
  hash.add(hypothesis.gauges);
  hash.add(hypothesis.exact);
  hash.add(answer.suspect);
  hash.add(answer.variances.reading_q4);
  hash.add(answer.variances.noise_q4);
  hash.add(answer.variances.largest_q4);
  add(hash, answer.rival.more);
  hash.add(std::int32_t{answer.solution.converged} + 2 * std::int32_t{answer.accepted} +
           4 * std::int32_t{answer.searching} + 8 * std::int32_t{answer.several} +
           16 * std::int32_t{answer.doubtful} + 128 * std::int32_t{answer.weak} +
           32 * std::int32_t{answer.rival.any} + 64 * std::int32_t{answer.rival.isAsLikely} +
           512 * std::int32_t{answer.rival.isWithinNoise} + 1024 * answer.shift);
  const auto contact = [&](int i) {
    return firmware::estimate(pipeline.constants(), answer, firmware::unitErrors(pipeline.linearisation()),
                              i);
  };
  std::optional<Contact> second;
  if (hypothesis.contacts > 1) second = contact(1);
  add(hash, firmware::touchFrames(pipeline.constants(), contact(0), second, {FingerFlag::kContact},
                                  static_cast<std::uint8_t>(sample)));
}

/// What would be told of it, one sample set a millisecond, and when: every seventh time the port is busy.
inline void add(Hash& hash, const firmware::Pipeline& pipeline, firmware::TouchReporter& reporter,
                std::uint32_t sample) {
  const std::uint32_t now_us = sample * 1000;
  const auto frames = reporter.frames(pipeline.constants(), pipeline.observation(), pipeline.answer(),
                                      pipeline.linearisation(), now_us);
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
    const auto look = [&](firmware::Pipeline& pipeline) {
      const firmware::Observation& observation = pipeline.process(codes);
      hash.add(observation.saturated);
      hash.add(observation.outOfUse);
      hash.add(std::int32_t{observation.noisy} + 2 * std::int32_t{observation.tooFewGauges});
      if (observation.touched) add(hash, pipeline, sample);
    };
    look(refined);
    add(hash, refined, reporter, sample);
    if (sample % 4 == 0) look(threePoint);
    tell(sample, hash.value());
  }
  return hash.value();
}

}  // namespace strainfinger::emulated
