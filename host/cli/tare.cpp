#include "firmware/core/condition.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/request.hpp"

namespace strainfinger::cli {
namespace {

constexpr const char* kTareHelp =
    "Lets a finger take the zero of its gauges now. Do not touch it: that takes 64 sample sets, a "
    "fifteenth of a second by default.\n"
    "A finger that feels a touch refuses; --force takes the zero anyway, for one whose old zero is off.\n"
    "Prints interface,node,command,status. Exit status: 1 refused, 3 no interface, 4 no such node.";

static_assert(firmware::ZeroAverage::kSamples == 64);  // as the help says

struct TareOptions {
  explicit TareOptions(CLI::App& command) : request(command) {
    command.add_flag("--force", force, "Even while something touches the finger");
  }
  RequestOptions request;
  bool force = false;
};

void runTare(const TareOptions& options) { request(options.request, {tareRequest(options.force)}); }

}  // namespace

void addTare(CLI::App& app) { addCommand<TareOptions>(app, "tare", kTareHelp, runTare); }

}  // namespace strainfinger::cli
