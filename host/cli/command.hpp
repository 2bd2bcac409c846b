#pragma once
// What every subcommand shares: its options for the config and the output format.

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "host/base/table_writer.hpp"
#include "host/config/finger_config.hpp"

namespace strainfinger::cli {

/// The options every subcommand has. Filled while the command line is parsed, read when the command runs.
class CommonOptions {
 public:
  explicit CommonOptions(CLI::App& command);
  /// The file of -c, or the default finger. It is read once: it may be a pipe.
  const config::FingerConfig& config() const;
  /// Of a command that needs nothing of the config: a mistake in it is told all the same.
  void requireGoodConfig() const;
  bool hasConfig() const { return !path_.empty(); }
  TableFormat format() const { return json_ ? TableFormat::kJson : TableFormat::kCsv; }
  /// Throws Failure(kUsage) where an option names one of `files`, which the command writes beside the file
  /// that `option` names: one would be lost.
  void requireNoneNamed(const char* option, const std::vector<std::string>& files) const;

 private:
  const CLI::App* command_;
  std::string path_;
  bool json_ = false;
  mutable std::optional<config::FingerConfig> config_;
};

/// Throws Failure(kUsage) where an option that names a file (of a type name that begins with FILE) or a
/// folder (DIR) is given an empty name, or two name one file: one would be lost, or is not what was meant.
void requireGoodFileNames(const CLI::App& command);

/// Throws Failure(kFailure) where a file cannot be made, as it is a folder, or its own is not there or can't
/// be written to: before long work, not at its end; Failure(kUsage) for "-", which others take for stdout.
/// An empty path is no file.
void requireFolderOf(const char* option, const std::string& path);

/// Prints on stderr what a command goes on in spite of.
void warn(const char* command, const std::string& what);
void warn(const char* command, const std::vector<std::string>& all);

/// What stands between the commas of a list, be it nothing.
std::vector<std::string> itemsOf(const std::string& list);

/// The check of `each` on all the items of a list, none of which may be empty.
CLI::Validator isListOf(const CLI::Validator& each);

/// Adds an option whose values are lists of numbers, separated by commas. CLI11's own delimiter leaves out
/// empty items without a word.
template <typename Number>
CLI::Option& addList(CLI::App& command, const std::string& name, std::vector<Number>& numbers,
                     const std::string& help, const CLI::Validator& each) {
  const auto read = [&numbers](const std::vector<std::string>& lists) {
    for (const std::string& list : lists)
      for (const std::string& item : itemsOf(list)) CLI::detail::lexical_cast(item, numbers.emplace_back());
  };
  return *command.add_option_function<std::vector<std::string>>(name, read, help)->check(isListOf(each));
}

/// A check of an option that is a number from `least` to `most`, on a list of each of its elements. CLI11's
/// own lets NaN through.
CLI::Validator isFrom(double least, double most);

/// The same of an option that is a whole number.
CLI::Validator isWhole(int least, int most);

/// The same of a number of things, of which there may be any from 1 on.
CLI::Validator isCount();

/// The same of a node number.
CLI::Validator isNode();

/// The same of the seed of random numbers, which may be any of 64 bits.
CLI::Validator isSeed();

/// Adds a subcommand whose options live in an Options (constructed with the subcommand; its members are what
/// the options write to) and which runs `run(options)` when it was chosen.
template <typename Options>
void addCommand(CLI::App& app, const std::string& name, const std::string& help,
                void (*run)(const Options&)) {
  CLI::App& command = *app.add_subcommand(name, help);
  auto options = std::make_shared<Options>(command);
  command.callback([&command, options, run] {
    requireGoodFileNames(command);
    run(*options);
  });
}

}  // namespace strainfinger::cli
