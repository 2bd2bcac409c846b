#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <memory>
#include <sstream>
#include <string>

#include "host/base/failure.hpp"
#include "host/cli/commands.hpp"

namespace {

using strainfinger::ExitCode;

int finish(ExitCode code) { return static_cast<int>(code); }

int complain(ExitCode code, const char* message) {
  std::fprintf(stderr, "strainfinger: %s\n", message);
  return finish(code);
}

/// Of each command the first line of what it says of itself: `strainfinger COMMAND --help` has the rest.
class ShortList : public CLI::Formatter {
 public:
  std::string make_subcommand(const CLI::App* command) const override {
    const std::string whole = command->get_description();
    std::ostringstream line;
    CLI::detail::format_help(line, command->get_display_name(true), whole.substr(0, whole.find('\n')),
                             column_width_);
    return line.str();
  }
};

/// CLI11 says of a command that it doesn't know only that one is missing.
bool isUnknownCommand(const CLI::App& app, const CLI::ParseError& error) {
  return error.get_exit_code() != 0 && app.get_subcommands().empty() && !app.remaining().empty();
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Firmware tables, simulation and tools for strain-gauge tactile fingers", "strainfinger"};
  app.set_version_flag("--version", STRAINFINGER_VERSION);
  app.require_subcommand(1);
  app.formatter(std::make_shared<ShortList>());
  strainfinger::cli::addCommands(app);
  app.footer("strainfinger COMMAND --help says the rest.");  // after the commands, which would take it over
  try {
    app.parse(argc, argv);
    if (std::fflush(stdout) != 0) return complain(ExitCode::kFailure, "cannot write the output");
    return finish(ExitCode::kOk);
  } catch (const CLI::ParseError& error) {
    if (isUnknownCommand(app, error))
      return complain(ExitCode::kUsage,
                      (app.remaining().front() + " is no command; strainfinger --help lists them").c_str());
    return app.exit(error) == 0 ? finish(ExitCode::kOk) : finish(ExitCode::kUsage);
  } catch (const strainfinger::Failure& failure) {
    return complain(failure.code(), failure.what());
  } catch (const std::exception& error) {
    return complain(ExitCode::kFailure, error.what());
  }
}
