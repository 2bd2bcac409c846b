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
  addDesign(app);
  addFingerCommands(app);
  addMonitor(app);
  addServe(app);
  addDiscover(app);
  addInfo(app);
  addDoctor(app);
  addFigures(app);
}

}  // namespace strainfinger::cli
