#pragma once
// What became of rows of readings, in words.

#include <array>
#include <span>
#include <string>

#include "host/calibration/calibrate.hpp"

namespace strainfinger::calibration {

struct RowUseWords {
  RowUse use;
  const char* name;
  const char* mend;         ///< what to do where most rows are so
  const char* reason = "";  ///< why such rows were left out; empty for those that weren't
};
/// Each at its use's own number.
inline constexpr std::array kRowUses{
    RowUseWords{RowUse::kFitted, "fitted", ""},
    RowUseWords{RowUse::kUntouched, "untouched", "touch the finger in more of them"},
    RowUseWords{RowUse::kWeak, "weak", "press harder, all with about the same load",
                "so weak that they tell less than a sixtieth of what strong ones tell, or little beside the "
                "noise"},
    RowUseWords{RowUse::kAmbiguous, "ambiguous", "press over the gauges, too, and with an edge",
                "explained by touches at two places or of two widths"},
    RowUseWords{RowUse::kWide, "wide", "press with an edge, in one place at a time",
                "as wide as a slip or two contacts look: press with an edge"},
    RowUseWords{RowUse::kOverRange, "over-range", "press less", "over range"},
    RowUseWords{RowUse::kContradicted, "contradicted", "look at the angles and loads of touches.csv",
                "not as touches.csv has them: look at their angles and loads"},
    RowUseWords{RowUse::kUnexplained, "unexplained", "touch it in one place at a time, without slips",
                "explained by no single touch (two contacts, a slip, a zero that moved)"}};
static_assert(kRowUses.back().use == RowUse{kRowUses.size() - 1});

/// "fitted", "untouched", "weak" ..
const char* nameOf(RowUse use);
/// The same where it names a column: "over_range".
std::string columnOf(RowUse use);

/// What to do where most rows are of no use for this reason.
std::string mendOf(RowUse use, std::span<const RowResult> rows);
/// The same of rows that are over range: where it is always the same gauge, that one is named.
std::string mendOfOverRange(std::span<const RowResult> rows);
/// Why rows of this use were left out, with the mend of those that are over range; empty where they weren't.
std::string reasonOf(RowUse use, std::span<const RowResult> rows);

}  // namespace strainfinger::calibration
