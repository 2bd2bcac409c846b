#pragma once
// FingerConfig to finger.toml.

#include <string>

#include "host/config/finger_config.hpp"
#include "host/config/keys.hpp"

namespace strainfinger::config {

/// The config as a documented TOML file: every key, its value with enough digits to read back exactly (or
/// that it is left out), what it is and its domain. readConfig() of it gives `config` again.
std::string writeConfig(const FingerConfig& config);

/// A key's value in `config`, as the file has it; "left out" for one that is.
std::string valueText(const Key& key, const FingerConfig& config);

}  // namespace strainfinger::config
