#include "host/cli/commands.hpp"

namespace strainfinger::cli {

void addRun(CLI::App&) {}

}  // namespace strainfinger::cli
