#pragma once
// Times as people and files read them.

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>
#include <cstdint>
#include <string>

namespace strainfinger {

/// Now, since 1970.
inline std::int64_t now_ns() {
  using namespace std::chrono;
  return duration_cast<nanoseconds>(system_clock::now().time_since_epoch()).count();
}

/// "2026-11-28T14:04:01Z"; `time_ns`: since 1970.
inline std::string utcText(std::int64_t time_ns) {
  using namespace std::chrono;
  const auto time = sys_time<nanoseconds>(nanoseconds(time_ns));
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(system_clock::to_time_t(floor<seconds>(time))));
}

/// "20261128-140401", of now: for names of files.
inline std::string utcStamp() {
  const auto now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  return fmt::format("{:%Y%m%d-%H%M%S}", fmt::gmtime(now));
}

}  // namespace strainfinger
