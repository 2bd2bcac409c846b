#include "host/cli/commands.hpp"

namespace strainfinger::cli {

void addFingerCommands(CLI::App& app) {
  addRun(app);
  addTare(app);
  addConfig(app);
  addPush(app);
  addStrains(app);
  addRecord(app);
  addDecode(app);
  addPlot(app);
  addReplay(app);
  addExplain(app);
  addDbc(app);
  addTables(app);
  addLocate(app);
}

}  // namespace strainfinger::cli
