#include "host/cli/commands.hpp"

namespace strainfinger::cli {

void addDbc(CLI::App&) {}

}  // namespace strainfinger::cli
