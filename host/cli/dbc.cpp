#include "host/can/dbc.hpp"

#include <cstdio>
#include <set>
#include <vector>

#include "common/frame_layout.hpp"
#include "host/base/atomic_file.hpp"
#include "host/base/failure.hpp"
#include "host/base/text_output.hpp"
#include "host/cli/command.hpp"
#include "host/cli/commands.hpp"

namespace strainfinger::cli {
namespace {

struct DbcOptions {
  explicit DbcOptions(CLI::App& command) : common(command) {
    addList(command, "-n,--node", nodes, "Node numbers in place of the config's, as in 1,2", isNode())
        .type_name("N,N");
    command.add_option("-o,--output", path, "File to write; stdout without it")->type_name("FILE");
  }
  CommonOptions common;
  std::vector<int> nodes;  ///< empty: the config's
  std::string path;
};

void runDbc(const DbcOptions& options) {
  if (options.common.format() == TableFormat::kJson)
    throw Failure(ExitCode::kUsage, "dbc: --json: a DBC file is all that it prints");
  const config::Can can = options.common.config().can;
  requireFolderOf("--output", options.path);
  std::set<int> nodes(options.nodes.begin(), options.nodes.end());
  if (nodes.empty()) nodes.insert(can.node);
  const std::string text = can::dbcText({nodes.begin(), nodes.end()}, can.contact_rate_hz);
  if (!options.path.empty())
    writeFileAtomically(options.path, text);
  else
    writeText(stdout, text);
}

}  // namespace

void addDbc(CLI::App& app) {
  addCommand<DbcOptions>(
      app, "dbc",
      "The DBC file of a finger, or of several: what their frames mean, for other people's CAN tools. Of "
      "several, messages have the node in their names, as in CONTACT_2.",
      runDbc);
}

}  // namespace strainfinger::cli
