#pragma once
// What the tests of the config share: texts with one thing changed, and the message a bad one gives.

#include <fmt/format.h>

#include <string>

#include "host/base/failure.hpp"
#include "host/config/read_config.hpp"

namespace strainfinger::config {

/// A file that sets one key, its value on line 3.
inline std::string settingOf(const std::string& dotted, const std::string& value) {
  const auto dot = dotted.find('.');
  return fmt::format("schema = 1\n[{}]\n{} = {}\n", dotted.substr(0, dot), dotted.substr(dot + 1), value);
}

/// What reading `text` says; "accepted" if nothing, "status N: ..." if not a usage error.
inline std::string complaintAbout(const std::string& text) {
  try {
    readConfig(text, "f.toml");
  } catch (const Failure& failure) {
    if (failure.code() == ExitCode::kUsage) return failure.what();
    return fmt::format("status {}: {}", static_cast<int>(failure.code()), failure.what());
  }
  return "accepted";
}

}  // namespace strainfinger::config
