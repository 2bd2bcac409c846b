#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <memory>
#include <sstream>
#include <string>
#include <string_view>

#include "host/base/failure.hpp"
#include "host/cli/commands.hpp"

namespace {

using strainfinger::ExitCode;

int finish(ExitCode code) { return static_cast<int>(code); }

/// Control characters that came from a file or an argument, as text: they must not reach a terminal.
std::string printable(std::string_view message) {
  std::string text;
  for (const char c : message)
    text += (static_cast<unsigned char>(c) >= 0x20 && c != 0x7F) || c == '\n' ? std::string(1, c)
                                                                              : fmt::format("\\x{:02X}", c);
  return text;
}

int complain(ExitCode code, std::string_view message) {
  fmt::print(stderr, "strainfinger: {}\n", printable(message));
  return finish(code);
}

int finishOutput() {
  const bool isWritten = std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
  if (!isWritten) return complain(ExitCode::kFailure, "cannot write the output");
  return finish(ExitCode::kOk);
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

/// CLI11 says of a command that it doesn't know only that one is missing, or gives the general help for it.
bool isUnknownCommand(const CLI::App& app) {
  return app.get_subcommands().empty() && !app.remaining().empty();
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
    return finishOutput();
  } catch (const CLI::ParseError& error) {
    if (isUnknownCommand(app))
      return complain(ExitCode::kUsage,
                      app.remaining().front() + " is no command; strainfinger --help lists them");
    return app.exit(error) == 0 ? finishOutput() : finish(ExitCode::kUsage);
  } catch (const strainfinger::Failure& failure) {
    return complain(failure.code(), failure.what());
  } catch (const std::exception& error) {
    return complain(ExitCode::kFailure, error.what());
  }
}
