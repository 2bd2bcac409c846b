#include "host/cli/command.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "common/frame_layout.hpp"
#include "host/base/atomic_file.hpp"
#include "host/base/excerpt.hpp"
#include "host/base/failure.hpp"
#include "host/base/notice.hpp"
#include "host/base/parse_number.hpp"
#include "host/config/read_config.hpp"

namespace strainfinger::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFolderType = "DIR";

struct FileOption {
  std::string option;
  std::string type;
  std::string path;
};

/// Of the command and of its own subcommands that were given.
std::vector<FileOption> fileOptions(const CLI::App& command) {
  std::vector<FileOption> files;
  for (const CLI::App* sub : command.get_subcommands()) {
    const std::vector<FileOption> itsOwn = fileOptions(*sub);
    files.insert(files.end(), itsOwn.begin(), itsOwn.end());
  }
  for (const CLI::Option* option : command.get_options())
    if (option->get_type_name().starts_with("FILE") || option->get_type_name() == kFolderType)
      for (const std::string& path : option->results())
        files.push_back({option->get_name(), option->get_type_name(), path});
  return files;
}

/// Devices and pipes aside, of which nothing is lost.
bool areOneFile(const std::string& one, const std::string& other) {
  std::error_code notThere;
  if (fs::exists(one, notThere) && fs::exists(other, notThere))
    return fs::is_regular_file(one, notThere) && fs::equivalent(one, other, notThere);
  // Made absolute, without which a name stays as it is where no part of it is there.
  const auto whole = [&](const std::string& path) {
    return fs::weakly_canonical(fs::absolute(path, notThere), notThere);
  };
  const fs::path first = whole(one), second = whole(other);
  return !first.empty() && first == second;
}

/// CLI11 takes nothing for 0.
bool read(const std::string& text, double& value) {
  return !text.empty() && CLI::detail::lexical_cast(text, value);
}

/// Only where CLI11, which reads the option itself, does not take it for octal digits.
template <std::integral Whole>
bool read(const std::string& text, Whole& value) {
  return CLI::detail::lexical_cast(text, value) && parseNumber<Whole>(text) == value;
}

template <typename Number>
CLI::Validator isOfKind(const char* kind, Number least, Number most, const std::string& inHelp) {
  return {[=](const std::string& text) {
            Number value{};
            const bool isWithin = read(text, value) && value >= least && value <= most;
            return isWithin ? std::string{}
                            : fmt::format("{} is not {} from {} to {}", excerpt(text), kind, least, most);
          },
          inHelp};
}

}  // namespace

CommonOptions::CommonOptions(CLI::App& command) : command_(&command) {
  command.add_option("-c,--config", path_, "The finger (finger.toml); the default finger without it")
      ->type_name("FILE.toml");
  command.add_flag("--json", json_, "One JSON object a line in place of CSV");
}

const config::FingerConfig& CommonOptions::config() const {
  if (!config_) config_ = path_.empty() ? config::FingerConfig{} : config::readConfigFile(path_);
  return *config_;
}

void CommonOptions::requireGoodConfig() const { config(); }

void CommonOptions::requireNoneNamed(const char* option, const std::vector<std::string>& files) const {
  for (const FileOption& named : fileOptions(*command_))
    for (const std::string& file : files)
      if (areOneFile(named.path, file))
        throw Failure(ExitCode::kUsage,
                      fmt::format("{}: {} writes {} as well, which {} names: name another for one",
                                  command_->get_name(), option, file, named.option));
}

void requireGoodFileNames(const CLI::App& command) {
  const auto files = fileOptions(command);
  for (auto file = files.begin(); file != files.end(); ++file) {
    if (file->path.empty())
      throw Failure(ExitCode::kUsage,
                    fmt::format("{}: {}: the name of a {} is missing", command.get_name(), file->option,
                                file->type == kFolderType ? "folder" : "file"));
    for (auto other = files.begin(); other != file; ++other) {
      if (other->option == file->option || !areOneFile(other->path, file->path)) continue;
      throw Failure(ExitCode::kUsage,
                    fmt::format("{}: {} and {} name the same file, {}: name another for one",
                                command.get_name(), other->option, file->option, file->path));
    }
  }
}

void requireFolderOf(const char* option, const std::string& path) {
  if (path.empty()) return;
  const auto fail = [&](const std::string& why) {
    throw Failure(ExitCode::kFailure, fmt::format("{} {}: {}", option, path, why));
  };
  if (path == "-")
    throw Failure(ExitCode::kUsage, fmt::format("{} -: name a file (./- if that is its name)", option));
  std::error_code notThere;
  if (fs::is_directory(path, notThere)) fail("this is a folder; name a file");
  const std::string folder = folderWrittenIn(path);
  if (folder.empty()) return;
  if (!fs::is_directory(folder, notThere))
    fail(fmt::format("there is no folder {}; make it, or name another", folder));
  if (::access(folder.c_str(), W_OK | X_OK) != 0)
    fail(fmt::format("no file can be made in the folder {}: {}", folder, std::strerror(errno)));
}

void warn(const char* command, const std::string& what) { tell("{}: warning: {}\n", command, what); }

void warn(const char* command, const std::vector<std::string>& all) {
  for (const std::string& each : all) warn(command, each);
}

std::vector<std::string> itemsOf(const std::string& list) {
  std::vector<std::string> items;
  std::size_t begin = 0;
  for (std::size_t comma; (comma = list.find(',', begin)) != std::string::npos; begin = comma + 1)
    items.push_back(list.substr(begin, comma - begin));
  items.push_back(list.substr(begin));
  return items;
}

CLI::Validator isListOf(const CLI::Validator& each) {
  return {[each](const std::string& list) {
            for (const std::string& item : itemsOf(list)) {
              if (item.empty()) return fmt::format("an item of {} is empty", excerpt(list));
              if (const std::string complaint = each(item); !complaint.empty()) return complaint;
            }
            return std::string{};
          },
          each.get_description()};
}

CLI::Validator isFrom(double least, double most) { return isOfKind("a number", least, most, ""); }

CLI::Validator isWhole(int least, int most) {
  return isOfKind("a whole number", least, most, fmt::format("{} to {}", least, most));
}

namespace {

constexpr std::uint64_t kMost64Bits = std::numeric_limits<std::uint64_t>::max();

}  // namespace

CLI::Validator isCount() { return isOfKind("a whole number", std::uint64_t{1}, kMost64Bits, "1 or more"); }

CLI::Validator isSeed() { return isOfKind("a whole number", std::uint64_t{0}, kMost64Bits, "0 to 2^64 - 1"); }

CLI::Validator isNode() { return isWhole(kFirstNode, kLastNode); }

}  // namespace strainfinger::cli
