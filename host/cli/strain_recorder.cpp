#include "host/cli/strain_recorder.hpp"

#include <fmt/format.h>

#include <iterator>

#include "common/fixed_real.hpp"
#include "common/quantities.hpp"
#include "host/base/angles.hpp"
#include "host/base/strain_rows.hpp"

namespace strainfinger::cli {
namespace {

/// Without loads where nothing touches; nothing of several, which a row of touches can't say.
std::optional<simulation::Touch> onlyTouch(const std::vector<simulation::Touch>& touches) {
  if (touches.empty()) return simulation::Touch{};
  return touches.size() == 1 ? std::optional(touches.front()) : std::nullopt;
}

std::string touchRow(const std::optional<simulation::Touch>& touch) {
  if (!touch) return ",,";
  return fmt::format("{},{},{}", degreesOf(touch->angle_rad), touch->normal_n_per_m,
                     touch->tangential_n_per_m);
}

}  // namespace

void StrainRecorder::add(const simulation::Moment& moment, std::span<const std::int32_t> strains_q32) {
  constexpr double kRounding_period = 1e-6;  // times and periods are decimal fractions
  const double periods = moment.time_s / period_s_ + kRounding_period;
  if (periods < static_cast<double>(taken_)) return;
  taken_ = static_cast<std::uint64_t>(periods) + 1;
  Row row{moment.time_s, {}, onlyTouch(moment.truth)};
  for (std::size_t i = 0; i < factors_.size(); ++i)
    row.strains.push_back(toReal(StrainQ32::fromRaw(strains_q32[i])) / factors_[i]);
  rows_.push_back(std::move(row));
}

std::string StrainRecorder::strains() const {
  std::string text =
      fmt::format("time_s,{}\n", fmt::join(strainColumns(static_cast<int>(factors_.size())), ","));
  for (const Row& row : rows_)
    fmt::format_to(std::back_inserter(text), "{:.6f},{}\n", row.time_s, fmt::join(row.strains, ","));
  return text;
}

std::string StrainRecorder::touches() const {
  std::string text = fmt::format("{}\n", kTouchHeader);
  for (const Row& row : rows_) text.append(touchRow(row.touch)).append("\n");
  return text;
}

}  // namespace strainfinger::cli
