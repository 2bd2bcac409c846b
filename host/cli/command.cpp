#include "host/cli/command.hpp"

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

}  // namespace strainfinger::cli
