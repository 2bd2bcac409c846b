#include "host/cli/commands.hpp"
#include "host/cli/request.hpp"

namespace strainfinger::cli {
namespace {

constexpr const char* kHelp =
    "Changes a setting of a finger on the bus, until its next start: nothing is stored in the finger.\n"
    "Prints interface,node,command,status. Exit status: 1 refused, 3 no interface, 4 no such node.";

struct ConfigOptions {
  explicit ConfigOptions(CLI::App& command) : request(command) {
    command.add_option("--contact-rate-hz", contactRate_hz, "Send at most so many CONTACT a second")
        ->type_name("HZ")
        ->check(CLI::Range(int{kSlowestContactRate_hz}, int{kFastestContactRate_hz}))
        ->required();
  }
  RequestOptions request;
  int contactRate_hz = 0;
};

void runConfig(const ConfigOptions& options) {
  request(options.request, contactRateRequest(static_cast<std::uint16_t>(options.contactRate_hz)));
}

}  // namespace

void addConfig(CLI::App& app) { addCommand<ConfigOptions>(app, "config", kHelp, runConfig); }

}  // namespace strainfinger::cli
