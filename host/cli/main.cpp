#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <exception>
#include <iostream>
#include <memory>
#include <sstream>
#include <string>
#include <string_view>

#include "host/base/excerpt.hpp"
#include "host/base/failure.hpp"
#include "host/cli/commands.hpp"

namespace {

using strainfinger::ExitCode;

int finish(ExitCode code) { return static_cast<int>(code); }

/// Control characters that came from a file or an argument, as text: they must not reach a terminal. Those of
/// Latin-1's upper half are C2 80 to C2 9F in UTF-8.
std::string printable(std::string_view message) {
  std::string text;
  bool wasC2 = false;
  for (const char each : message) {
    const auto c = static_cast<unsigned char>(each);
    const bool isControl = (c < 0x20 && c != '\n') || c == 0x7F || (wasC2 && c < 0xA0);
    wasC2 = c == 0xC2;
    text += isControl ? fmt::format("\\x{:02X}", c) : std::string(1, each);
  }
  return text;
}

/// Where stderr takes nothing either, the exit status still tells.
void tell(std::string_view text) { std::fputs(printable(text).c_str(), stderr); }

int complain(ExitCode code, std::string_view message) {
  tell(fmt::format("strainfinger: {}\n", message));
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
  std::signal(SIGXFSZ, SIG_IGN);  // a file beyond the shell's limit is an error like a full disk
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
      return complain(ExitCode::kUsage, strainfinger::excerpt(app.remaining().front()) +
                                            " is no command; strainfinger --help lists them");
    std::ostringstream complaint;
    const bool isHelp = app.exit(error, std::cout, complaint) == 0;
    tell(isHelp ? complaint.str() : strainfinger::excerptWords(complaint.str()));
    return isHelp ? finishOutput() : finish(ExitCode::kUsage);
  } catch (const strainfinger::Failure& failure) {
    return complain(failure.code(), failure.what());
  } catch (const std::exception& error) {
    return complain(ExitCode::kFailure, error.what());
  }
}
