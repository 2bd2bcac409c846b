#include "host/cli/commands.hpp"

namespace strainfinger::cli {

void addResponse(CLI::App&) {}

}  // namespace strainfinger::cli
