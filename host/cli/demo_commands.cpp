// What a demo needs: the finger, its tables and its bus. The commands about the elastic model, which take
// most of the time to compile, and those that show fingers live are left to the whole program.

#include "host/cli/commands.hpp"

namespace strainfinger::cli {

void addCommands(CLI::App& app) {
  addTables(app);
  addLocate(app);
  addRun(app);
  addRecord(app);
  addReplay(app);
  addDecode(app);
  addPlot(app);
  addDbc(app);
  addStrains(app);
  addTare(app);
  addConfig(app);
}

}  // namespace strainfinger::cli
