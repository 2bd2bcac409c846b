#pragma once
// A fuzzer's bytes as sample sets for the pipeline: what the sanitizers watch runs, and what holds for any
// codes is checked.

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "common/table_image.hpp"
#include "firmware/core/pipeline.hpp"
#include "firmware/core/report.hpp"
#include "tests/fuzz/input.hpp"

namespace strainfinger::fuzz {

/// Ends the program, as a sanitizer would, where something that holds for any input does not.
void require(bool holds);

/// Zeros a pipeline by the first sample set of an input and feeds it with the others, each as often as the
/// input says. A set is any codes, the last codes and a little more, or what the tables say that a contact of
/// any place, loads and width makes of the zero.
class DrivenPipeline {
 public:
  /// `tables` passed checkTableImage().
  DrivenPipeline(const TableImage& tables, Input& input);
  /// All of the input, and then the last set until the search for a hypothesis ends, or should have.
  void run();
  bool isSearching() const { return searching_; }

 private:
  std::span<const std::uint16_t> codes() const;
  void takeZero();
  void nextCodes();
  void anyCodes();
  void moveCodes();
  void touchCodes();
  void process();
  void report(const firmware::Observation& observation);

  const TableImage& tables_;
  Input& input_;
  firmware::Pipeline pipeline_;
  firmware::TouchReporter reporter_{0, {}};
  std::array<std::uint16_t, kMaxGauges> codes_{};
  std::uint32_t now_us_ = 0;
  bool searching_ = false;
};

}  // namespace strainfinger::fuzz
