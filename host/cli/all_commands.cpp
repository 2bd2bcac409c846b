// What the program `strainfinger` can do, in the order of its help.

#include "host/cli/commands.hpp"

namespace strainfinger::cli {

void addCommands(CLI::App& app) {
  addResponse(app);
  addStrain(app);
  addContact(app);
  addSvd(app);
  addField(app);
  addShape(app);
  addCalibrate(app);
  addTables(app);
  addLocate(app);
  addRun(app);
  addRecord(app);
  addReplay(app);
  addDecode(app);
  addPlot(app);
  addMonitor(app);
  addServe(app);
  addDbc(app);
  addStrains(app);
  addTare(app);
  addConfig(app);
  addFigures(app);
}

}  // namespace strainfinger::cli
