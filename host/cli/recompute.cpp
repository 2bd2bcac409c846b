#include "host/cli/recompute.hpp"

#include <fmt/format.h>

#include "host/base/failure.hpp"

namespace strainfinger::cli {
namespace {

Cell countCell(std::uint64_t count) { return static_cast<std::int64_t>(count); }

void judgeRecomputed(const recompute::RecomputeTally& tally, int node) {
  if (tally.different + tally.absent > 0)
    throw Failure(
        ExitCode::kVerificationFailed,
        fmt::format(
            "recompute: {} of {} frames of node {} differ from what its readings give, {} are absent{}",
            tally.different, tally.compared, node, tally.absent,
            tally.first ? "; the first " + *tally.first : ""));
  if (tally.compared == 0)
    throw Failure(
        ExitCode::kFailure,
        fmt::format(
            "recompute: nothing to compare: the recording needs RAW of every sample set of node {} "
            "({} gaps) from before a tare on, and a touch behind it: `strainfinger strains --rate 1000 "
            "> /dev/null`, then `strainfinger tare` while it records",
            node, tally.gaps));
}

}  // namespace

void recompute(const std::function<std::optional<can::TimedFrame>()>& next, const TableImage& tables,
               const recompute::RecordedFinger& finger, TableFormat format) {
  recompute::Recomputer recomputer(tables, finger);
  while (const auto recorded = next()) recomputer.take(recorded->time_ns, recorded->frame);
  const recompute::RecomputeTally tally = recomputer.finish();
  TableWriter(stdout, format, {"node", "sets", "left_out", "gaps", "compared", "different", "absent"})
      .row({std::int64_t{finger.node}, countCell(tally.sets), countCell(tally.leftOut), countCell(tally.gaps),
            countCell(tally.compared), countCell(tally.different), countCell(tally.absent)});
  judgeRecomputed(tally, finger.node);
}

}  // namespace strainfinger::cli
