// What the program `strainfinger` can do, in the order of its help: fingers first, then the elastic model.

#include "host/cli/commands.hpp"

namespace strainfinger::cli {

void addCommands(CLI::App& app) {
  addFingerCommands(app);
  addMonitor(app);
  addServe(app);
  addDiscover(app);
  addInfo(app);
  addDoctor(app);
  addCalibrate(app);
  addShape(app);
  addDesign(app);
  addStrain(app);
  addField(app);
  addContact(app);
  addResponse(app);
  addSvd(app);
  addFigures(app);
}

}  // namespace strainfinger::cli
