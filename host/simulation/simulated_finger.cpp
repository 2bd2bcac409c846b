#include "host/simulation/simulated_finger.hpp"

#include <fmt/format.h>

#include "host/base/failure.hpp"

namespace strainfinger::simulation {

void requireUntouchedStart(const Scenario& scenario, std::string_view name) {
  constexpr double kPeriod_s = SimulatedGauges::kSamplePeriod_us * 1e-6;
  for (double time_s = 0; time_s < kUntouched_s; time_s += kPeriod_s)
    if (!scenario.at(time_s).empty())
      throw Failure(
          ExitCode::kUsage,
          fmt::format("{} touches the finger at {:.3f} s, while it takes the zero of its gauges: let "
                      "the first touch start_s be {} or later",
                      name, time_s, kUntouched_s));
}

InfoFrame simulatedInfo(ResetCause cause) {
  constexpr firmware::Version kVersion{STRAINFINGER_VERSION_MAJOR, STRAINFINGER_VERSION_MINOR};
  return firmware::infoFrame(cause, {}, kVersion, 0);
}

}  // namespace strainfinger::simulation
