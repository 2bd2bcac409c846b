#include "host/cli/bus_option.hpp"

namespace strainfinger::cli {

CLI::Option* addBusOption(CLI::App& command, std::string& name) {
  return command
      .add_option("--can", name,
                  "The bus: a CAN interface (can0, vcan0, slcan0), or udp: between the programs of this "
                  "machine, without CAN (udp:PORT: another such bus)")
      ->type_name("BUS")
      ->check([](const std::string& text) { return text.empty() ? "give the name of a bus" : ""; });
}

CLI::Option* addInterfaceOption(CLI::App& command, std::string& name) {
  return command
      .add_option("--interface", name, "Only what the log has of this interface, where it has several")
      ->type_name("NAME");
}

}  // namespace strainfinger::cli
