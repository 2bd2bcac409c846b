#include "host/cli/recompute.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <set>
#include <string>

#include "common/raw_share.hpp"
#include "host/base/failure.hpp"

namespace strainfinger::cli {
namespace {

Cell countCell(std::uint64_t count) { return static_cast<std::int64_t>(count); }

/// Why nothing could be compared, and what to do.
std::string whyNothing(const recompute::RecomputeTally& tally, const std::set<int>& heard, int node,
                       std::uint32_t gauges, std::uint32_t bitrate) {
  if (!heard.contains(node))
    return fmt::format(
        "the recording has no readings (RAW) of node {}{}", node,
        heard.empty() ? ": `strainfinger strains` asks a finger for them"
                      : fmt::format(", but of {}: give that finger's config (-c)", fmt::join(heard, ", ")));
  if (const int fastest_hz = fastestRaw_hz(gauges, bitrate); fastest_hz < kFastestRaw_hz)
    return fmt::format(
        "with {} gauges a bus of {} bit/s carries {} sample sets a second, not all {}: a recording of this "
        "finger cannot be computed again",
        gauges, bitrate, fastest_hz, kFastestRaw_hz);
  return fmt::format(
      "nothing to compare: the recording needs RAW of every sample set of node {} ({} gaps here), from "
      "before a tare until after a touch: while `record` runs, start `strainfinger strains --rate {} > "
      "/dev/null`, then `strainfinger tare`, then touch the finger",
      node, tally.gaps, kFastestRaw_hz);
}

void requireNoneDifferent(const recompute::RecomputeTally& tally, int node) {
  if (tally.different + tally.absent > 0)
    throw Failure(
        ExitCode::kVerificationFailed,
        fmt::format(
            "recompute: {} of {} frames of node {} differ from what its readings give, {} are absent{}",
            tally.different, tally.compared, node, tally.absent,
            tally.first ? "; the first " + *tally.first : ""));
}

}  // namespace

void recompute(const std::function<std::optional<can::TimedFrame>()>& next, const TableImage& tables,
               const recompute::RecordedFinger& finger, std::uint32_t bitrate, TableFormat format) {
  recompute::Recomputer recomputer(tables, finger);
  std::set<int> heard;  // nodes with RAW
  while (const auto recorded = next()) {
    if (const auto node = nodeOf(recorded->frame.id, FunctionCode::kRaw)) heard.insert(*node);
    recomputer.take(recorded->time_ns, recorded->frame);
  }
  const recompute::RecomputeTally tally = recomputer.finish();
  TableWriter(stdout, format, {"node", "sets", "left_out", "gaps", "compared", "different", "absent"})
      .row({std::int64_t{finger.node}, countCell(tally.sets), countCell(tally.leftOut), countCell(tally.gaps),
            countCell(tally.compared), countCell(tally.different), countCell(tally.absent)});
  requireNoneDifferent(tally, finger.node);
  if (tally.compared == 0)
    throw Failure(ExitCode::kFailure, "recompute: " + whyNothing(tally, heard, finger.node,
                                                                 tables.constants.gauge_count, bitrate));
}

}  // namespace strainfinger::cli
