#pragma once
// A fit of what was collected so far, beside the collection.

#include <future>
#include <optional>
#include <string>

#include "host/calibration/calibrate.hpp"
#include "host/session/assessment.hpp"
#include "host/session/rows.hpp"

namespace strainfinger::session {

/// What became of a fit.
struct FitOutcome {
  std::size_t rows = 0;  ///< that it was of
  std::optional<calibration::CalibrationResult> result{};
  std::optional<Assessment> assessment{};
  std::string complaint{};  ///< why there is no result
  bool isOfFaults = false;  ///< that is, as the finger is to be mended, see calibration::FaultyFinger
};

/// Costs what calibrate() costs.
FitOutcome fitRows(const config::FingerConfig& config, const Rows& rows,
                   const calibration::KnownErrors& errors);

/// One fit at a time in a thread of its own. Its destructor waits for it.
class FitBeside {
 public:
  FitBeside(config::FingerConfig config, calibration::KnownErrors errors)
      : config_(std::move(config)), errors_(errors) {}

  bool isRunning() const { return running_.valid(); }
  /// Domain: none is running.
  void start(const Rows& rows);
  /// The outcome, once, when there is one.
  std::optional<FitOutcome> poll();
  /// The outcome of the one that is running, if any, when it is there.
  std::optional<FitOutcome> wait();

 private:
  config::FingerConfig config_;
  calibration::KnownErrors errors_;
  std::future<FitOutcome> running_;
};

}  // namespace strainfinger::session
