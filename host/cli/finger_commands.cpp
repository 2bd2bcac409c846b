#include "host/cli/commands.hpp"

namespace strainfinger::cli {

void addFingerCommands(CLI::App& app) {
  addTables(app);
  addLocate(app);
  addRun(app);
  addRecord(app);
  addReplay(app);
  addDecode(app);
  addPlot(app);
  addExplain(app);
  addDbc(app);
  addStrains(app);
  addTare(app);
  addConfig(app);
  addPush(app);
}

}  // namespace strainfinger::cli
