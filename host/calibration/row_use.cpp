#include "host/calibration/row_use.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace strainfinger::calibration {
namespace {

/// [rows] Over range at one gauge: fewer are so by chance, of touches that are one after the other.
constexpr std::size_t kLeastAlike = 3;

const RowUseWords& wordsOf(RowUse use) { return kRowUses.at(static_cast<std::size_t>(use)); }

}  // namespace

const char* nameOf(RowUse use) { return wordsOf(use).name; }

std::string columnOf(RowUse use) {
  std::string name = nameOf(use);
  std::ranges::replace(name, '-', '_');
  return name;
}

std::string mendOf(RowUse use, std::span<const RowResult> rows) {
  return use == RowUse::kOverRange ? mendOfOverRange(rows) : wordsOf(use).mend;
}

std::string mendOfOverRange(std::span<const RowResult> rows) {
  std::vector<int> gauges;
  for (const RowResult& row : rows)
    if (row.use == RowUse::kOverRange) gauges.push_back(row.peakGauge);
  const bool isOne = gauges.size() >= kLeastAlike &&
                     std::ranges::all_of(gauges, [&](int gauge) { return gauge == gauges.front(); });
  if (!isOne) return wordsOf(RowUse::kOverRange).mend;
  return fmt::format(
      "it is always gauge {}: look at its zero, its wires and its amplifier; where it was pressed "
      "so hard, press less",
      gauges.front());
}

std::string reasonOf(RowUse use, std::span<const RowResult> rows) {
  const std::string reason = wordsOf(use).reason;
  return use == RowUse::kOverRange ? fmt::format("{}: {}", reason, mendOfOverRange(rows)) : reason;
}

}  // namespace strainfinger::calibration
