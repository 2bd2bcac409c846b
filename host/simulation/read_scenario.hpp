#pragma once
// Scenario files; scenarios/touches.toml documents the format.

#include <string>
#include <string_view>

#include "host/simulation/scenario.hpp"

namespace strainfinger::simulation {

/// Reads and checks a scenario file. Throws Failure(kUsage) with file:line:column, the key, what is wrong and
/// what would be right, as readConfig() does.
Scenario readScenarioFile(const std::string& path);

/// The same for text; `name` stands for the file in messages.
Scenario readScenario(std::string_view text, const std::string& name);

/// The text of scenarios/touches.toml.
std::string_view builtInScenarioText();

Scenario builtInScenario();

}  // namespace strainfinger::simulation
