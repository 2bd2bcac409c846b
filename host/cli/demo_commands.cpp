// What a demo needs. The commands about the elastic model, which take most of the time to compile, and those
// that show fingers live are left to the whole program.

#include "host/cli/commands.hpp"

namespace strainfinger::cli {

void addCommands(CLI::App& app) { addFingerCommands(app); }

}  // namespace strainfinger::cli
