#include "host/can/dbc.hpp"

#include <cstdio>

#include "common/frame_layout.hpp"
#include "host/base/atomic_file.hpp"
#include "host/base/failure.hpp"
#include "host/base/text_output.hpp"
#include "host/cli/command.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/request.hpp"

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
  if (options.common.format() == TableFormat::kJson)
    throw Failure(ExitCode::kUsage, "dbc: --json: a DBC file is all that it prints");
  const config::Can can = options.common.config().can;
  requireFolderOf("--output", options.path);
  const std::string text = can::dbcText(nodeOf(options.node, can), can.contact_rate_hz);
  if (!options.path.empty())
    writeFileAtomically(options.path, text);
  else
    writeText(stdout, text);
}

}  // namespace

void addDbc(CLI::App& app) {
  addCommand<DbcOptions>(
      app, "dbc", "The DBC file of a finger: what its frames mean, for other people's CAN tools", runDbc);
}

}  // namespace strainfinger::cli
