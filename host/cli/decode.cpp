#include "host/cli/commands.hpp"

namespace strainfinger::cli {

void addDecode(CLI::App&) {}

}  // namespace strainfinger::cli
