#pragma once
// What was looked at, and what is wrong with it.

#include <string>
#include <vector>

#include "host/base/failure.hpp"

namespace strainfinger::health {

enum class Severity {
  kGood,
  kWarning,  ///< it works; somebody should know
  kError,    ///< it does not work, or its numbers can't be trusted
};

struct Finding {
  Severity severity;
  std::string where;                     ///< "can0", "can0 node 1"
  std::string what;                      ///< one line
  std::string remedy{};                  ///< what to do; empty: nothing
  ExitCode status = ExitCode::kFailure;  ///< of an error: how a program ends that found it
};
using Findings = std::vector<Finding>;

/// "ok", "warning", "error".
const char* nameOf(Severity severity);

}  // namespace strainfinger::health
