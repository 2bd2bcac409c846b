#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "host/bench/cells.hpp"
#include "host/bench/error_pages.hpp"

namespace strainfinger::bench {
namespace {

constexpr std::string_view kIntroduction = R"(# What the finger can and cannot do

The default finger: 25.4 mm in diameter, 3.8 mm of rubber, 16 gauges of negligible length, 6 microstrain of noise (12-bit
converter included). One sample set, no averaging; a search takes more of them. "Place" is arc of the surface. Errors are
against the truth, of loads RMS, of the answers that the finger itself calls certain; the others are counted. Unless said otherwise:
touched along a line, a finger exactly as drawn and tables without model error, the width not known and fitted with each
touch, any place, load directions within 45 degrees of the normal, "load" is the length of (normal, tangential). Contacts
that have a width press as something round does; the width is that of the uniform pressure with the same second moment.

| column | meaning |
|--|--|
| unnoticed | share of the touches of which the finger reports nothing |
| uncertain | share whose answer is flagged `uncertain` or `several_contacts` |
| certain | all others: the errors are theirs |
| over half a pitch off, no flag | certain answers more than half the gap between two gauges from the true place |
| tables made for it | yes: the tables were made for what the row varies (noise, bits, width, length of a gauge); no: for the default finger, its width unknown |

A line load in N/m times the length of the contact is a force: 30 N/m on 20 mm are 0.6 N.

What disturbs it, and what it says then: [disturbances.md](disturbances.md).

)";

constexpr std::string_view kColumns =
    " place, mm: RMS / 95 % / worst | normal, N/m | tangential, N/m | unnoticed | uncertain | "
    "over half a pitch off, no flag |\n";

std::string columnsOf(const ErrorStatistics& s) {
  return fmt::format(" {} / {} / {} | {} | {} | {} | {} | {} |\n", number(s.arc_mm.rms(), 4),
                     number(s.arc_mm.quantile(0.95), 4), number(s.arc_mm.worst(), 3),
                     number(s.normal_n_per_m.rms(), 3), number(s.tangential_n_per_m.rms(), 3),
                     share(s.unnoticed, s.contacts), share(s.uncertain, s.contacts),
                     share(s.wrong, s.contacts));
}

std::string table(const std::string& firstColumns, int columns) {
  std::string text = "| " + firstColumns;
  text.append(" |").append(kColumns).append("|");
  for (int column = 0; column < columns + 6; ++column) text += "--|";
  return text + "\n";
}

std::string sweepTable(const std::vector<ErrorCell>& cells, const char* sweep, const std::string& heading,
                       const std::string& firstColumn, bool withLoad, bool withTold) {
  std::string text = fmt::format("\n## {}\n\n", heading);
  text += table(firstColumn + (withLoad ? " | load, N/m" : "") + (withTold ? " | tables made for it" : ""),
                1 + withLoad + withTold);
  for (const ErrorCell& c : cellsOf(cells, sweep)) {
    text += fmt::format("| {:g} |", c.setting);
    if (withLoad) text += fmt::format(" {:g} |", c.load_n_per_m);
    if (withTold) text += c.told ? " yes |" : " no |";
    text += columnsOf(c.statistics);
  }
  return text;
}

/// The worst first, by the place that 95 % of the answers keep to; of settings that leave answers.
std::vector<ErrorCell> worstOf(std::vector<ErrorCell> cells, std::size_t count) {
  const auto worse = [](const ErrorCell& a, const ErrorCell& b) {
    return a.statistics.arc_mm.quantile(0.95) > b.statistics.arc_mm.quantile(0.95);
  };
  std::erase_if(cells, [](const ErrorCell& c) { return !isMostlyCertain(c.statistics); });
  std::sort(cells.begin(), cells.end(), worse);
  cells.resize(std::min(count, cells.size()));
  return cells;
}

std::string settingOf(const ErrorCell& c) {
  return fmt::format("| {} {:g} {} | {:g} | {} |", c.sweep, c.setting, c.unit, c.load_n_per_m,
                     c.told ? "yes" : "no");
}

/// Where there is hardly an answer, the most silent first.
std::string silentSettings(std::vector<ErrorCell> cells) {
  std::erase_if(cells, [](const ErrorCell& c) { return isMostlyCertain(c.statistics); });
  std::sort(cells.begin(), cells.end(), [](const ErrorCell& a, const ErrorCell& b) {
    return a.statistics.certain() < b.statistics.certain();
  });
  std::string text =
      "\nFewer than half of the contacts get a certain answer:\n\n"
      "| setting | load, N/m | tables made for it | certain | unnoticed | uncertain |\n|--|--|--|--|--|--|\n";
  for (const ErrorCell& c : cells) {
    const ErrorStatistics& s = c.statistics;
    text += fmt::format("{} {} | {} | {} |\n", settingOf(c), share(s.certain(), s.contacts),
                        share(s.unnoticed, s.contacts), share(s.uncertain, s.contacts));
  }
  return text;
}

std::string worstSettings(const std::vector<ErrorCell>& cells) {
  std::vector<ErrorCell> others(cells);
  std::erase_if(others, [](const ErrorCell& c) { return c.sweep == kMapSweep; });
  std::string text = "\n## The worst settings\n" + silentSettings(others) +
                     "\nThe largest errors of the others:\n\n" +
                     table("setting | load, N/m | tables made for it", 3);
  for (const ErrorCell& c : worstOf(others, 8)) text += settingOf(c) + columnsOf(c.statistics);
  return text;
}

/// The statistics of one row of a sweep.
const ErrorStatistics& rowOf(const std::vector<ErrorCell>& cells, const char* sweep, double setting,
                             bool told) {
  const auto found = std::find_if(cells.begin(), cells.end(), [&](const ErrorCell& c) {
    return c.sweep == sweep && c.setting == setting && c.told == told;
  });
  return found->statistics;
}

/// How many touches from this load on are not noticed, in words.
std::string unnoticedFrom(const std::vector<ErrorCell>& cells, double least_n_per_m) {
  int unnoticed = 0, contacts = 0;
  for (const ErrorCell& c : cellsOf(cells, kLoadSweep)) {
    if (c.setting < least_n_per_m) continue;
    unnoticed += c.statistics.unnoticed;
    contacts += c.statistics.contacts;
  }
  return fmt::format("{} of {}", unnoticed, contacts);
}

std::string builtFingers(const ErrorStatistics& built) {
  return fmt::format("{} fingers, in each row the same, touched {} times with 30 N/m each", kBuiltFingers,
                     built.contacts / kBuiltFingers);
}

std::string inShort(const std::vector<ErrorCell>& cells) {
  const auto &firm = rowOf(cells, kLoadSweep, 30, true), &light = rowOf(cells, kLoadSweep, 5, true),
             &faint = rowOf(cells, kLoadSweep, 0.5, true);
  const auto &wide = rowOf(cells, kWidthSweep, 2, false), &wideTold = rowOf(cells, kWidthSweep, 2, true);
  const auto& built = rowOf(cells, kBuiltSweep, 2, false);
  const ErrorCell worst = worstOf(cellsOf(cells, kMapSweep), 1).front();
  return fmt::format(
      "## In short\n\n"
      "* **Place**: {:.3f} mm RMS at 30 N/m, {:.3f} mm at 5 N/m: it is proportional to noise divided by "
      "load.\n"
      "* **Loads**: {:.2f} N/m RMS of normal and {:.2f} N/m of tangential load, at 5 N/m as at 30 N/m "
      "({:.2f} and {:.2f}).\n"
      "* **Weak touches**: {} of the touches of 0.5 N/m are not noticed, and {} of those of 1 N/m and more; "
      "the weaker, the more answers are flagged uncertain.\n"
      "* **Weakest spot**: {:+.3f} pitches from a gauge, the load {:.0f} deg from the normal: 95 % of places "
      "are within {:.3f} mm at 30 N/m, against {:.3f} mm over all places and directions. Over a gauge a "
      "small "
      "shift and a small tangential load look alike.\n"
      "* **Place of wide contacts**: the place of a contact 2 mm wide at 30 N/m is off by {:.3f} mm RMS, by "
      "{:.3f} mm where the tables are made for the width; at 4 mm by {:.3f} mm, of the answers that are not "
      "flagged. The error of the width itself is not in this report.\n"
      "* **As built**: gauges glued 0.5 degrees and 0.05 mm off, gains off by 3 %, the core 0.1 mm thicker, "
      "Poisson's ratio 0.49, nothing calibrated: {:.2f} mm RMS at 2 mm of width, {} of the answers flagged "
      "uncertain ({}). Of touches of 2 to 40 N/m more are flagged "
      "([disturbances.csv](disturbances.csv)). `strainfinger calibrate` is for that.\n"
      "* **What it cannot do**: tell contacts apart that are nearer than 2.5 pitches, or where along the "
      "finger a contact is.\n",
      firm.arc_mm.rms(), light.arc_mm.rms(), light.normal_n_per_m.rms(), light.tangential_n_per_m.rms(),
      firm.normal_n_per_m.rms(), firm.tangential_n_per_m.rms(), share(faint.unnoticed, faint.contacts),
      unnoticedFrom(cells, 1), worst.setting, worst.direction_deg, worst.statistics.arc_mm.quantile(0.95),
      firm.arc_mm.quantile(0.95), wide.arc_mm.rms(), wideTold.arc_mm.rms(),
      rowOf(cells, kWidthSweep, 4, false).arc_mm.rms(), built.arc_mm.rms(),
      share(built.uncertain, built.contacts), builtFingers(built));
}

std::string madeBy(const SweepSettings& settings) {
  return fmt::format(
      "\n{} contacts a row, {} a cell of the map, seed {}. Made by `cmake --workflow --preset bench`; all "
      "figures: build/bench/results/errors.csv.\n",
      settings.contacts, settings.repeats, settings.seed);
}

}  // namespace

std::string errorPage(const std::vector<ErrorCell>& cells, const SweepSettings& settings) {
  std::string text(kIntroduction);
  text += inShort(cells);
  text += worstSettings(cells);
  text += "\n![Errors over position and load direction](error_map.png)\n";
  text += "![Error of place over the other quantities](error_curves.png)\n";
  text += "\nLines end where fewer than half of the contacts get a certain answer.\n";
  return text + madeBy(settings);
}

std::string errorTables(const std::vector<ErrorCell>& cells, const SweepSettings& settings) {
  std::string text =
      "# Errors by load, noise, converter, width and gauge\n\n"
      "For whoever chooses a part or a load. What the words mean, and the worst of it in short:\n"
      "[what_the_finger_can_do.md](what_the_finger_can_do.md).\n";
  text += sweepTable(cells, kLoadSweep, "How hard must it be touched?", "load, N/m", false, false);
  text += sweepTable(cells, kNoiseSweep, "Noise of a gauge (16-bit converter)", "microstrain", true, false);
  text += sweepTable(cells, kBitsSweep, "Bits of the converter", "bits", true, false);
  text += sweepTable(cells, kWidthSweep, "Width of the contact", "mm", false, true);
  text += sweepTable(cells, kBuiltSweep,
                     "Width of the contact on fingers as built, not calibrated\n\n" +
                         builtFingers(rowOf(cells, kBuiltSweep, 2, false)) + ".",
                     "mm", false, false);
  text += sweepTable(cells, kLengthSweep, "Length of a gauge", "mm", false, true);
  return text + madeBy(settings);
}

}  // namespace strainfinger::bench
