#include "host/simulation/gauge_fault.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <optional>
#include <ranges>
#include <string_view>

#include "host/base/excerpt.hpp"
#include "host/base/failure.hpp"
#include "host/base/parse_number.hpp"

namespace strainfinger::simulation {
namespace {

struct KindName {
  GaugeFault::Kind kind;
  std::string_view name;
};
constexpr std::array kKindNames{
    KindName{GaugeFault::Kind::kDead, "dead"}, KindName{GaugeFault::Kind::kOpen, "open"},
    KindName{GaugeFault::Kind::kShort, "short"}, KindName{GaugeFault::Kind::kStuck, "stuck"},
    KindName{GaugeFault::Kind::kNoisy, "noisy"}};

std::optional<GaugeFault::Kind> kindOf(std::string_view name) {
  for (const KindName& each : kKindNames)
    if (each.name == name) return each.kind;
  return std::nullopt;
}

constexpr double kLatest_s = 1e6;

}  // namespace

std::string gaugeFaultKinds() {
  return fmt::format("{}", fmt::join(kKindNames | std::views::transform(&KindName::name), ", "));
}

GaugeFault readGaugeFault(const std::string& text) {
  const std::string_view all = text;
  const auto colon = all.find(':'), at = all.find('@');
  const auto kind = kindOf(all.substr(0, colon));
  const auto gauge =
      parseNumber<std::uint32_t>(colon == all.npos ? "" : all.substr(colon + 1, at - colon - 1));
  const auto start_s = parseNumber<double>(at == all.npos ? "0" : all.substr(at + 1));
  const bool whole = kind && gauge && start_s && *start_s >= 0 && *start_s <= kLatest_s;
  if (!whole)
    throw Failure(ExitCode::kUsage,
                  fmt::format("--fault {}: must be KIND:GAUGE or KIND:GAUGE@SECOND, KIND one of {}; for "
                              "example stuck:5@2.5",
                              excerpt(text), gaugeFaultKinds()));
  return {*kind, *gauge, *start_s};
}

void requireGauges(const std::vector<GaugeFault>& faults, int count) {
  for (const GaugeFault& fault : faults)
    if (fault.gauge >= static_cast<std::uint32_t>(count))
      throw Failure(ExitCode::kUsage,
                    fmt::format("--fault: there is no gauge {}; they are 0 to {}", fault.gauge, count - 1));
}

}  // namespace strainfinger::simulation
