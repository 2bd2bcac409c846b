#include "host/cli/command.hpp"

#include <fmt/format.h>

#include "host/config/read_config.hpp"

namespace strainfinger::cli {

CommonOptions::CommonOptions(CLI::App& command) {
  command.add_option("-c,--config", path_, "The finger (finger.toml); the default finger without it")
      ->type_name("FILE");
  command.add_flag("--json", json_, "One JSON object a line in place of CSV");
}

config::FingerConfig CommonOptions::config() const {
  return path_.empty() ? config::FingerConfig{} : config::readConfigFile(path_);
}

CLI::Validator isFrom(double least, double most) {
  const auto complaint = [least, most](const std::string& text) {
    double value = 0;
    const bool isWithin = CLI::detail::lexical_cast(text, value) && value >= least && value <= most;
    return isWithin ? std::string{} : fmt::format("{} is not a number from {} to {}", text, least, most);
  };
  return CLI::Validator(complaint, "");
}

}  // namespace strainfinger::cli
