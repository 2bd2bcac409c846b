#include "host/cli/run_summary.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <iterator>
#include <utility>

#include "host/base/text_output.hpp"

namespace strainfinger::cli {
namespace {

/// Bits by number: 5, 5+7; nothing for none.
std::string gaugesOf(firmware::GaugeSet gauges) {
  std::string text;
  for (int gauge = 0; gauge < kMaxGauges; ++gauge)
    if (firmware::contains(gauges, gauge)) text += fmt::format("{}{}", text.empty() ? "" : "+", gauge);
  return text;
}

std::string plainText(double duration_s, const simulation::RunCounts& counts,
                      const simulation::TouchErrors& errors) {
  std::string text;
  const auto add = [&text]<typename... Values>(fmt::format_string<Values...> line, Values&&... values) {
    fmt::format_to(std::back_inserter(text), line, std::forward<Values>(values)...);
  };
  const auto& finger = counts.finger;
  add("run: {:.3f} s: {} sample sets, {} lost to a late machine; {} fits\n", duration_s, finger.sampleSets,
      counts.overruns, finger.fits);
  add("run: {} frames: {} touches, {} HEARTBEAT; {} touches deferred, {} incomplete\n", counts.frames,
      finger.touchesSent, counts.heartbeats, finger.touchesBusy, finger.touchesIncomplete);
  if (errors.arc_m.count() > 0)
    add("run: off the truth (RMS, worst of {}): {:.4f}, {:.4f} mm of arc; normal {:.3f}, {:.3f} N/m; "
        "tangential {:.3f}, {:.3f} N/m\n",
        errors.arc_m.count(), errors.arc_m.rms() * 1e3, errors.arc_m.worst() * 1e3,
        errors.normal_n_per_m.rms(), errors.normal_n_per_m.worst(), errors.tangential_n_per_m.rms(),
        errors.tangential_n_per_m.worst());
  add("run: not counted there: {} flagged uncertain, {} of another number of contacts, {} of none, {} "
      "missed\n",
      errors.uncertain, errors.otherNumber, errors.phantom, errors.missed);
  add("run: touched for {:.3f} s without a contact told\n", errors.untold_s);
  if (counts.outOfUse != 0) add("run: gauges out of use at the end: {}\n", gaugesOf(counts.outOfUse));
  return text;
}

void writeObject(std::FILE* stream, double duration_s, const simulation::RunCounts& counts,
                 const simulation::TouchErrors& errors) {
  const auto& finger = counts.finger;
  const auto number = [](auto count) { return static_cast<std::int64_t>(count); };
  TableWriter table(stream, TableFormat::kJson,
                    {"duration_s",
                     "sample_sets",
                     "overruns",
                     "fits",
                     "frames",
                     "touches",
                     "heartbeats",
                     "touches_busy",
                     "touches_incomplete",
                     "compared",
                     "arc_rms_m",
                     "arc_worst_m",
                     "normal_rms_n_per_m",
                     "normal_worst_n_per_m",
                     "tangential_rms_n_per_m",
                     "tangential_worst_n_per_m",
                     "uncertain",
                     "other_number",
                     "phantom",
                     "missed",
                     "untold_s",
                     "gauges_out_of_use"});
  table.row({duration_s,
             number(finger.sampleSets),
             number(counts.overruns),
             number(finger.fits),
             number(counts.frames),
             number(finger.touchesSent),
             number(counts.heartbeats),
             number(finger.touchesBusy),
             number(finger.touchesIncomplete),
             number(errors.arc_m.count()),
             errors.arc_m.rms(),
             errors.arc_m.worst(),
             errors.normal_n_per_m.rms(),
             errors.normal_n_per_m.worst(),
             errors.tangential_n_per_m.rms(),
             errors.tangential_n_per_m.worst(),
             number(errors.uncertain),
             number(errors.otherNumber),
             number(errors.phantom),
             number(errors.missed),
             errors.untold_s,
             gaugesOf(counts.outOfUse)});
}

}  // namespace

std::string summaryText(TableFormat format, double duration_s, const simulation::RunCounts& counts,
                        const simulation::TouchErrors& errors) {
  if (format == TableFormat::kCsv) return plainText(duration_s, counts, errors);
  return textWritten([&](std::FILE* stream) { writeObject(stream, duration_s, counts, errors); });
}

}  // namespace strainfinger::cli
