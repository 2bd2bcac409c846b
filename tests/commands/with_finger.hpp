#pragma once
// A command beside a finger, or frames of one, on a bus between programs.

#include <string>

#include "tests/commands/program.hpp"

namespace strainfinger {

/// Runs a shell script in which $BUS is a bus of this test run's own, with a finger on it (`run` with these
/// options) until the script ends.
Run withFinger(const std::string& options, const std::string& script);

/// With a second finger of the same node number; `endTwin` in the script ends it.
Run withFingerAndTwin(const std::string& options, const std::string& script);

/// Runs `strainfinger <arguments> --can BUS`, which hears these lines of a log, and nobody who answers.
Run whileHearing(const std::string& lines, const std::string& arguments);

/// In a script: `ip` prints this JSON in place of this machine's interfaces.
std::string interfacesAre(const std::string& json);

}  // namespace strainfinger
