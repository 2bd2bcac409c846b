#pragma once
// One sample set through conditioning, detection and location.

#include <optional>

#include "firmware/core/condition.hpp"
#include "firmware/core/detect.hpp"
#include "firmware/core/locate.hpp"

namespace strainfinger::firmware {

/// What one sample set shows.
struct Observation {
  std::optional<Fit> fit;       ///< nothing when nothing touches the finger
  std::uint32_t saturated = 0;  ///< bit i: gauge i at a rail
};

class Pipeline {
 public:
  Pipeline(const TableImage& tables, FitMode mode)
      : tables_(&tables), calibration_(nominalCalibration(tables.constants)), mode_(mode) {}

  /// Costs conditioning and the gate when nothing touches; else a fit (see locate()).
  const Observation& process(Codes codes);

  /// What the last sample set showed.
  const Observation& observation() const { return observation_; }

  const TableConstants& constants() const { return tables_->constants; }
  Calibration& calibration() { return calibration_; }

 private:
  const TableImage* tables_;
  Calibration calibration_;
  Readings readings_;
  Observation observation_;
  ContactGate gate_;
  FitMode mode_;
};

}  // namespace strainfinger::firmware
