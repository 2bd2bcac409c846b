#pragma once
// The subcommands, one file each.

#include <CLI/CLI.hpp>

namespace strainfinger::cli {

/// Adds those of the program that is linked: all_commands.cpp or demo_commands.cpp.
void addCommands(CLI::App& app);

/// Those of the finger, its tables and its bus.
void addFingerCommands(CLI::App& app);

void addResponse(CLI::App& app);
void addStrain(CLI::App& app);
void addContact(CLI::App& app);
void addSvd(CLI::App& app);
void addField(CLI::App& app);
void addShape(CLI::App& app);
void addCalibrate(CLI::App& app);
void addDesign(CLI::App& app);
void addTables(CLI::App& app);
void addLocate(CLI::App& app);
void addRun(CLI::App& app);
void addRecord(CLI::App& app);
void addReplay(CLI::App& app);
void addDecode(CLI::App& app);
void addPlot(CLI::App& app);
void addMonitor(CLI::App& app);
void addServe(CLI::App& app);
void addExplain(CLI::App& app);
void addDiscover(CLI::App& app);
void addInfo(CLI::App& app);
void addDoctor(CLI::App& app);
void addDbc(CLI::App& app);
void addStrains(CLI::App& app);
void addTare(CLI::App& app);
void addConfig(CLI::App& app);
void addPush(CLI::App& app);
void addFigures(CLI::App& app);

}  // namespace strainfinger::cli
