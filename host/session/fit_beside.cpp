#include "host/session/fit_beside.hpp"

#include <chrono>
#include <utility>

#include "host/base/failure.hpp"

namespace strainfinger::session {

FitOutcome fitRows(const config::FingerConfig& config, const Rows& rows,
                   const calibration::KnownErrors& errors) {
  FitOutcome outcome{.rows = rows.size()};
  try {
    auto result = calibration::calibrate(config, rows.known, rows.matrix(), errors);
    outcome.assessment = assess(result, errors);
    outcome.result = std::move(result);
  } catch (const calibration::FaultyFinger& faulty) {
    outcome.complaint = faulty.what();
    outcome.isOfFaults = true;
  } catch (const Failure& failure) {
    outcome.complaint = failure.what();
  }
  return outcome;
}

void FitBeside::start(const Rows& rows) {
  running_ = std::async(std::launch::async,
                        [config = config_, errors = errors_, rows] { return fitRows(config, rows, errors); });
}

std::optional<FitOutcome> FitBeside::poll() {
  if (!isRunning() || running_.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
    return std::nullopt;
  return wait();
}

std::optional<FitOutcome> FitBeside::wait() {
  if (!isRunning()) return std::nullopt;
  return std::exchange(running_, {}).get();
}

}  // namespace strainfinger::session
