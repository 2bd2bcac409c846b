#include "host/cli/commands.hpp"

namespace strainfinger::cli {

void addTables(CLI::App&) {}

}  // namespace strainfinger::cli
