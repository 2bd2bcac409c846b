#include "host/cli/commands.hpp"

namespace strainfinger::cli {

void addLocate(CLI::App&) {}

}  // namespace strainfinger::cli
