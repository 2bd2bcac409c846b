#include <fcntl.h>
#include <unistd.h>

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <exception>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>

#include "host/base/edit_distance.hpp"
#include "host/base/excerpt.hpp"
#include "host/base/failure.hpp"
#include "host/base/notice.hpp"
#include "host/base/parse_number.hpp"
#include "host/cli/commands.hpp"

namespace {

using strainfinger::ExitCode;

int finish(ExitCode code) { return static_cast<int>(code); }

/// Where one of the three standard streams is closed, the next file that is opened would get its number, and
/// what is meant for people or for a pipe would go into that file. What takes its place refuses all.
void keepStandardNumbers() {
  for (const auto& [number, mode] :
       {std::pair{STDIN_FILENO, O_WRONLY}, {STDOUT_FILENO, O_RDONLY}, {STDERR_FILENO, O_RDONLY}})
    if (::fcntl(number, F_GETFD) < 0) ::open("/dev/null", mode);
}

int complain(ExitCode code, std::string_view message) {
  strainfinger::tell("strainfinger: {}\n", message);
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

/// The option of a command that a word was meant to be, if one is near it.
std::string meantBy(const std::string& word, const CLI::App& command) {
  constexpr std::size_t kMostOff = 3;
  std::string nearest;
  std::size_t least = kMostOff + 1;
  for (const CLI::Option* option : command.get_options()) {
    const std::string name = option->get_name();
    const std::size_t off = name.starts_with(word) ? 0 : strainfinger::editDistance(word, name);
    if (off < least) least = off, nearest = name;
  }
  return nearest;
}

/// Where a command was given an option that it doesn't have, as which CLI11 may tell that another is missing.
std::optional<std::string> unknownOption(const CLI::App& app) {
  for (const CLI::App* command : app.get_subcommands())
    for (const std::string& word : command->remaining()) {
      if (word == "--") break;  // what is behind it is no option
      if (word.size() < 2 || word[0] != '-' || strainfinger::parseNumber<double>(word)) continue;
      const std::string meant = meantBy(word, *command);
      return fmt::format("{}: {} is no option{}; strainfinger {} --help lists them", command->get_name(),
                         strainfinger::excerpt(word), meant.empty() ? "" : ", " + meant + " is",
                         command->get_name());
    }
  return {};
}

}  // namespace

int main(int argc, char** argv) {
  keepStandardNumbers();
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
    if (const auto unknown = unknownOption(app); unknown && !isHelp)
      return complain(ExitCode::kUsage, *unknown);
    strainfinger::tell(isHelp ? complaint.str() : strainfinger::excerptWords(complaint.str()));
    return isHelp ? finishOutput() : finish(ExitCode::kUsage);
  } catch (const strainfinger::Failure& failure) {
    return complain(failure.code(), failure.what());
  } catch (const std::exception& error) {
    return complain(ExitCode::kFailure, error.what());
  }
}
