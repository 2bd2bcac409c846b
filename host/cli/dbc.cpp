#include "host/can/dbc.hpp"

#include <cstdio>

#include "common/frame_layout.hpp"
#include "host/base/atomic_file.hpp"
#include "host/base/failure.hpp"
#include "host/cli/command.hpp"
#include "host/cli/commands.hpp"

namespace strainfinger::cli {
namespace {

struct DbcOptions {
  explicit DbcOptions(CLI::App& command) : common(command) {
    command.add_option("-n,--node", node, "Node number in place of the config's")->check(isNode());
    command.add_option("-o,--output", path, "File to write; stdout without it")->type_name("FILE");
  }
  CommonOptions common;
  int node = 0;  ///< 0: the config's
  std::string path;
};

void runDbc(const DbcOptions& options) {
  const config::Can can = options.common.config().can;
  const int node = options.node != 0 ? options.node : can.node;
  const std::string text = can::dbcText(static_cast<std::uint8_t>(node), can.contact_rate_hz);
  if (!options.path.empty())
    writeFileAtomically(options.path, text);
  else if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size())
    throw Failure(ExitCode::kFailure, "cannot write the output: disk full or reader gone");
}

}  // namespace

void addDbc(CLI::App& app) {
  addCommand<DbcOptions>(
      app, "dbc", "The DBC file of a finger: what its frames mean, for other people's CAN tools", runDbc);
}

}  // namespace strainfinger::cli
