#include "host/session/recorded.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <system_error>
#include <variant>

#include "host/base/failure.hpp"
#include "host/can/log_reader.hpp"
#include "host/can/one_finger.hpp"
#include "host/can/strain_receiver.hpp"
#include "host/session/thinning.hpp"

namespace strainfinger::session {

bool isRecording(const std::string& path) {
  std::error_code unknown;
  if (!std::filesystem::is_regular_file(path, unknown))
    return false;  // a pipe's lines can be read once alone
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    if (line.find_first_not_of(" \t\r") == line.npos || line.front() == '#') continue;
    return std::holds_alternative<can::LogLine>(can::parseLogLine(line));
  }
  return false;
}

Recorded readRecording(const std::string& path, const config::FingerConfig& config, std::uint8_t node,
                       const std::string& interface) {
  can::LogReader log(path, {.interface = interface, .window = {}});
  can::OneFinger one(node);
  can::StrainReceiver receiver(node, config.gauges.count, config.gauges.full_scale_strain);
  Thinner thinner(config);
  Recorded found;
  while (const auto frame = log.next()) {
    one.watch(path, *frame);
    const auto set = receiver.take(frame->frame);
    if (!set || set->zeroing) continue;
    ++found.sets;
    const Sample sample{1e-9 * static_cast<double>(*frame->time_ns),
                        Eigen::Map<const Eigen::VectorXd>(set->strains.data(), config.gauges.count)};
    if (thinner.take(sample) == Verdict::kKept) found.rows.add(sample.strains, {});
  }
  found.warnings = log.warnings();
  log.requireInterface();
  receiver.requireAllGauges();
  if (found.sets == 0) receiver.requireEnoughGauges();
  if (found.rows.size() > 0) return found;
  if (found.sets > 0)
    throw Failure(ExitCode::kFailure,
                  fmt::format("{}: none of its {} sample sets is a touch that can be used: record while the "
                              "finger is rolled along an edge, slowly and within its range",
                              path, found.sets));
  throw Failure(ExitCode::kFailure, fmt::format("{}: no readings (RAW) of node {} with {} gauges: record "
                                                "while `strainfinger strains --can ..` runs, "
                                                "or give -n and the finger's config",
                                                path, node, config.gauges.count));
}

}  // namespace strainfinger::session
