#pragma once
// The firmware from the converter's codes on, without boards, buses and clocks.

#include <array>
#include <functional>

#include "firmware/core/pipeline.hpp"
#include "tests/closed_loop/stateless_locator.hpp"

namespace strainfinger {

inline constexpr int kSetsPerSecond = 1000;

/// A finger that is told, set by set, what its gauges feel.
class SampledFinger {
 public:
  using Codes = std::vector<std::uint16_t>;

  /// `tables`: what the firmware was given; they outlive this object. The gauges' noise is that of the ring.
  SampledFinger(const TableImage& tables, const evidence::TouchedRing& ring, std::uint64_t firstNumber = 0)
      : tables_(tables), ring_(ring), number_(firstNumber), pipeline_(tables, firmware::FitMode::kRefined) {}

  /// Sets of readings of these strains. `change`, if any, has the last word about each set's codes.
  const firmware::Observation& hold(const Eigen::VectorXd& strains, int sets,
                                    const std::function<void(Codes&)>& change = {}) {
    for (int i = 0; i < sets; ++i) {
      Codes codes = ring_.codes(strains, number_++);
      if (change) change(codes);
      pipeline_.process(codes);
    }
    return pipeline_.observation();
  }
  const firmware::Observation& rest(int sets, const std::function<void(Codes&)>& change = {}) {
    return hold(Eigen::VectorXd::Zero(tables_.constants.gauge_count), sets, change);
  }

  /// What would be said now, flags of the finger included; nothing where it is untouched.
  std::vector<evidence::Answer> answers() const {
    const firmware::Observation& seen = pipeline_.observation();
    std::vector<evidence::Answer> answers;
    if (!seen.touched) return answers;
    for (int i = 0; i < pipeline_.answer().solution.hypothesis.contacts; ++i) {
      answers.push_back(answerOf(estimate(tables_.constants, pipeline_.answer(),
                                          firmware::unitErrors(pipeline_.linearisation()), i)));
      answers.back().isFlagged |= seen.tooFewGauges || seen.staleZero;
    }
    return answers;
  }

  const firmware::Observation& observation() const { return pipeline_.observation(); }
  firmware::Pipeline& pipeline() { return pipeline_; }
  /// Addresses the next set's noise.
  std::uint64_t number() const { return number_; }

 private:
  const TableImage& tables_;
  const evidence::TouchedRing& ring_;
  std::uint64_t number_;
  firmware::Pipeline pipeline_;
};

}  // namespace strainfinger
