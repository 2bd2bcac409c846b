#pragma once
// What can be wrong with touches and readings, in words. Rows are counted from 1, gauges from 0. All throw
// Failure(kFailure), those of gauges and wires FaultyFinger.

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "host/calibration/calibrate.hpp"
#include "host/calibration/failed_gauges.hpp"
#include "host/calibration/moved_zero.hpp"
#include "host/calibration/wiring.hpp"

namespace strainfinger::calibration {

/// What is said here of "touches.csv", of the file that it is.
std::string ofFile(std::string message, const std::string& touchesPath);

/// Its numbers are finite and those of a touch, or of none; `place` is what a complaint begins with.
void requireTouch(const KnownTouch& touch, const std::string& place);

/// There are rows; a known touch a row or none at all; a column a gauge; finite readings; touches that can
/// be.
void requireRows(const config::Gauges& gauges, std::span<const KnownTouch> known,
                 const Eigen::MatrixXd& readings);

/// All gauges read the finger; names those that don't.
void requireWorking(const std::vector<FailedGauge>& failed);

/// Enough rows are fitted; else says what the others are, and the mend of what most of them are.
void requireTouches(const config::Gauges& gauges, std::span<const RowResult> rows);

/// There are touches near every gauge; names the `untouched` ones and the touches that are missing.
void requireAllAround(const config::Gauges& gauges, const std::vector<int>& untouched);

/// The gauges are wired as drawn; names every fault and its mend.
void requireWiring(const std::vector<WiringFault>& faults);

/// The drawing, give or take its tolerances, explains what was read but for a small part of it, and most
/// rows.
void requireExplained(double modelError, double shareOfRowsUnexplained);

/// Most rows are of one zero of each gauge, so that it is known which of them moved.
void requireStill(const std::vector<MovedZero>& moved, double shareOfRowsUnexplained);

/// Of these rows (counted from 1) the readings contradict `what` touches.csv says, and bear out so many
/// others; what to look at.
[[noreturn]] void refuseContradicted(const std::vector<std::size_t>& rows, std::size_t borneOut,
                                     const char* what, const char* lookAt);

/// Of every gauge the touches tell where it is, better than its tolerance does; names those of which they
/// don't and the touches that would.
void requireTold(const CalibrationResult& result);

/// The finger that was found can be written as a config that is read again; else names the gauge, its value
/// and what to look at.
void requireReadable(const CalibrationResult& result);

/// The gauges of which the touches tell `unknown` no better than `most` of its tolerance.
std::vector<int> untoldGauges(const CalibrationResult& result, GaugeUnknown unknown, double most);

/// "3 (at 67.5 deg), 5 (at 112.5 deg)".
std::string placesOf(const config::Gauges& gauges, const std::vector<int>& which);

}  // namespace strainfinger::calibration
