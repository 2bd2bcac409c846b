#pragma once
// finger.toml to FingerConfig.

#include <string>
#include <string_view>

#include "host/config/finger_config.hpp"

namespace strainfinger::config {

/// Reads and checks a config file. Keys that are absent keep their defaults. Throws Failure(kUsage) with
/// file:line:column, the key, what is wrong and what would be right: for a file that cannot be read, a syntax
/// error, an unknown key, a wrong type, a value outside its domain.
FingerConfig readConfigFile(const std::string& path);

/// The same for text; `name` stands for the file in messages.
FingerConfig readConfig(std::string_view text, const std::string& name);

}  // namespace strainfinger::config
