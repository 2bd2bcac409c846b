#include "host/cli/commands.hpp"

namespace strainfinger::cli {

void addStrain(CLI::App&) {}

}  // namespace strainfinger::cli
