#include "host/bench/locator_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "host/base/table_writer.hpp"
#include "host/bench/cells.hpp"

namespace strainfinger::bench {
namespace {

/// Cortex-M4 without and with an FPU: where noise is large doubts are dear.
constexpr std::array<std::size_t, 2> kCoresInNoise{kM4, kM4WithFpu};

/// Three digits of a ratio to the bound; what is far from it says so.
std::string ratio(double value) { return value >= 100 ? "> 100" : number(value, value < 10 ? 2 : 0); }

std::string ratios(const Score& score) {
  return fmt::format("{} / {} / {}", ratio(score.overBound[0]), ratio(score.overBound[1]),
                     ratio(score.overBound[2]));
}

std::string thousands(double value) {
  if (std::isnan(value)) return "-";
  const long long whole = std::llround(value);
  if (whole < 1000) return fmt::format("{}", whole);
  return fmt::format("{},{:03}", thousands(static_cast<double>(whole / 1000)), whole % 1000);
}

std::string countCell(const Count& count) {
  return std::isnan(count.median) ? "-"
                                  : fmt::format("{} ({})", thousands(count.median), thousands(count.most95));
}

std::string markdownRow(const MethodResult& result, const Counts& counts) {
  const auto& [clean, little, much, wide] = result.score;
  std::string row =
      fmt::format("| {} | {} | {} | {} ({}) | {} | {} | {} | {} | {} |", result.name, ratios(little),
                  share(little.gross, little.readings), number(clean.arc_um, 2),
                  share(clean.gross, clean.readings), ratios(much), share(much.gross, much.readings),
                  ratios(wide), share(wide.gross, wide.readings), thousands(result.time_ns));
  for (std::size_t core = 0; core < kCores.size(); ++core)
    row.append(" ").append(countCell(counts.of(core, result.name, kTimedLevel))).append(" |");
  for (const std::size_t core : kCoresInNoise)
    row.append(" ").append(countCell(counts.of(core, result.name, kNoisyLevel))).append(" |");
  row.append(" ").append(countCell(counts.of(result.usesFloat ? kM4WithFpu : kM4, result.name, kWideLevel)));
  row += " |";
  return row;
}

/// Is `other` at least as good as `ours` at this level? Two percent are the readings' luck.
bool isAsGood(const Score& other, const Score& ours) {
  constexpr double kLuck = 1.02;
  return other.gross <= ours.gross && other.arcOfAll_um <= kLuck * ours.arcOfAll_um &&
         other.overBound[1] <= kLuck * ours.overBound[1] && other.overBound[2] <= kLuck * ours.overBound[2];
}

/// The first of ours that has the least error.
const MethodResult& bestOfOurs(const std::vector<MethodResult>& results, std::size_t level) {
  return *std::min_element(results.begin(), results.end(), [&](const MethodResult& a, const MethodResult& b) {
    if (a.usesFloat != b.usesFloat) return b.usesFloat;
    return a.score[level].arcOfAll_um < b.score[level].arcOfAll_um;
  });
}

std::string verdictAt(std::size_t level, const std::vector<MethodResult>& results, const Counts& counts) {
  const MethodResult& ours = bestOfOurs(results, level);
  const MethodResult* best = nullptr;
  const auto cost = [&](const MethodResult& result) { return countOnM4(result, counts, level); };
  for (const MethodResult& other : results) {
    if (!other.usesFloat || std::isnan(cost(other)) || !isAsGood(other.score[level], ours.score[level]))
      continue;
    if (best == nullptr || cost(other) < cost(*best)) best = &other;
  }
  if (best == nullptr) return "";
  const double ratio = cost(*best) / cost(ours);
  return fmt::format(
      "The cheapest other method with no larger error and no more gross errors at {}, {}, takes {:.{}f} "
      "times the instructions of {} on a Cortex-M4 with an FPU, which ours doesn't use.\n",
      kLevelSettings[level].name, best->name, ratio, ratio < 1 ? 3 : 1, ours.name);
}

}  // namespace

std::string locatorVerdict(const std::vector<MethodResult>& results, const Counts& counts) {
  return verdictAt(kTimedLevel, results, counts) + verdictAt(kWideLevel, results, counts);
}

std::string locatorMarkdown(const std::vector<MethodResult>& results, const Counts& counts) {
  std::string text =
      "# Locators compared\n\n"
      "For readers of [README.md](README.md), which explains readings, methods and errors. \"Error / "
      "bound\": "
      "RMS error over the Cramer-Rao bound. \"Gross\": answers more than\nhalf a pitch off. \"ns here\": "
      "nanoseconds of a fit on the machine that made this page, at 0.1 % of noise. Processors: instructions "
      "of a fit, median (95 % quantile), at\n0.1 % of noise where the column does not say otherwise. `-`: "
      "not "
      "available.\n\n"
      "| method | error / bound at 0.1 % (angle / P / Q) | gross | clean: um of arc (gross) | error / bound "
      "at 1 % | gross | error / bound at 0.1 %, 0.5 to 4 mm wide | gross | ns here |";
  for (const char* core : kCores) text.append(" ").append(core).append(" |");
  for (const std::size_t core : kCoresInNoise) text.append(" ").append(kCores[core]).append(", 1 % |");
  text += " Cortex-M4, with FPU for float, 0.5 to 4 mm wide |";
  text += "\n|--|--|--|--|--|--|--|--|--|--|--|--|--|--|--|\n";
  for (const MethodResult& result : results) text.append(markdownRow(result, counts)).append("\n");
  return text;
}

void writeLocatorCsv(std::FILE* stream, const std::vector<MethodResult>& results, const Counts& counts) {
  std::vector<std::string> columns{
      "method",     "noise",        "least_width_mm",    "most_width_mm",      "seed",
      "contacts",   "gross",        "angle_over_bound",  "normal_over_bound",  "tangential_over_bound",
      "arc_rms_um", "arc_worst_um", "arc_rms_of_all_um", "normal_rms_n_per_m", "tangential_rms_n_per_m",
      "time_ns"};
  for (const char* core : {"m4", "m4_fpu", "m0plus"})
    for (const char* what : {"median", "95", "most"})
      columns.push_back(fmt::format("{}_{}_counted", core, what));
  TableWriter table(stream, TableFormat::kCsv, columns);
  for (const MethodResult& result : results) {
    for (std::size_t level = 0; level < kLevels; ++level) {
      const Score& score = result.score[level];
      const LevelSettings& settings = kLevelSettings[level];
      std::vector<Cell> row{result.name,
                            settings.relativeNoise,
                            1e3 * settings.width_m.least,
                            1e3 * settings.width_m.most,
                            static_cast<std::int64_t>(settings.seed),
                            std::int64_t{score.readings},
                            std::int64_t{score.gross},
                            score.overBound[0],
                            score.overBound[1],
                            score.overBound[2],
                            score.arc_um,
                            score.arcWorst_um,
                            score.arcOfAll_um,
                            score.normal_n_per_m,
                            score.tangential_n_per_m,
                            result.time_ns};
      for (std::size_t core = 0; core < kCores.size(); ++core) {
        const Count count = counts.of(core, result.name, level);
        row.insert(row.end(), {count.median, count.most95, count.most});
      }
      table.row(row);
    }
  }
}

}  // namespace strainfinger::bench
