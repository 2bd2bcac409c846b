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
  add("run: {}: {} flagged uncertain, {} of another number of contacts, {} of none, {} missed\n",
      errors.arc_m.count() > 0 ? "not counted there" : "no answer was compared with the truth",
      errors.uncertain, errors.otherNumber, errors.phantom, errors.missed);
  add("run: touched for {:.3f} s without a reported contact\n", errors.untold_s);
  if (counts.outOfUse != 0) add("run: gauges out of use at the end: {}\n", gaugesOf(counts.outOfUse));
  return text;
}

void writeObject(std::FILE* stream, double duration_s, const simulation::RunCounts& counts,
                 const simulation::TouchErrors& errors) {
  const auto& finger = counts.finger;
  const auto number = [](auto count) { return static_cast<std::int64_t>(count); };
  const NamedRow row{{"duration_s", duration_s},
                     {"sample_sets", number(finger.sampleSets)},
                     {"overruns", number(counts.overruns)},
                     {"fits", number(finger.fits)},
                     {"frames", number(counts.frames)},
                     {"touches", number(finger.touchesSent)},
                     {"heartbeats", number(counts.heartbeats)},
                     {"touches_busy", number(finger.touchesBusy)},
                     {"touches_incomplete", number(finger.touchesIncomplete)},
                     {"compared", number(errors.arc_m.count())},
                     {"arc_rms_m", errors.arc_m.rms()},
                     {"arc_worst_m", errors.arc_m.worst()},
                     {"normal_rms_n_per_m", errors.normal_n_per_m.rms()},
                     {"normal_worst_n_per_m", errors.normal_n_per_m.worst()},
                     {"tangential_rms_n_per_m", errors.tangential_n_per_m.rms()},
                     {"tangential_worst_n_per_m", errors.tangential_n_per_m.worst()},
                     {"uncertain", number(errors.uncertain)},
                     {"other_number", number(errors.otherNumber)},
                     {"phantom", number(errors.phantom)},
                     {"missed", number(errors.missed)},
                     {"untold_s", errors.untold_s},
                     {"gauges_out_of_use", gaugesOf(counts.outOfUse)}};
  TableWriter(stream, TableFormat::kJson, columnsOf(row)).row(valuesOf(row));
}

}  // namespace

std::string summaryText(TableFormat format, double duration_s, const simulation::RunCounts& counts,
                        const simulation::TouchErrors& errors) {
  if (format == TableFormat::kCsv) return plainText(duration_s, counts, errors);
  return textWritten([&](std::FILE* stream) { writeObject(stream, duration_s, counts, errors); });
}

}  // namespace strainfinger::cli
