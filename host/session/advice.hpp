#pragma once
// What to do next, from what is covered and known.

#include <optional>
#include <string>

#include "host/session/assessment.hpp"
#include "host/session/coverage.hpp"

namespace strainfinger::session {

struct Advice {
  enum class Kind {
    kLeaveAlone,  ///< untouched, for the zeros
    kRoll,        ///< along an edge: `where`
    kPress,       ///< with a known load, over `gauge`
    kMark,        ///< at a known angle
    kWait,        ///< for the first fit, while rolling on
    kMend,        ///< what the newest fit complains of, and end the session
    kDone,        ///< nothing is left to gain
  };
  Kind kind = Kind::kLeaveAlone;
  ArcRun where{};
  int gauge = 0;
  bool operator==(const Advice&) const = default;
};

/// What the user has said that it can't be had.
struct Unavailable {
  bool loads = false, directions = false;
};

/// The most wanted. Without an assessment (there was no fit yet) by coverage alone.
Advice nextAdvice(const config::Gauges& gauges, const Coverage& coverage,
                  const std::optional<Assessment>& assessment, const Unavailable& unavailable = {});

/// In plain words, one sentence or two.
std::string textOf(const Advice& advice, const config::Gauges& gauges);

}  // namespace strainfinger::session
