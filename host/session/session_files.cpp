#include "host/session/session_files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>

#include "host/base/atomic_file.hpp"
#include "host/base/failure.hpp"
#include "host/base/no_value.hpp"
#include "host/base/read_file.hpp"
#include "host/base/strain_rows.hpp"
#include "host/base/write_all.hpp"
#include "host/calibration/complaints.hpp"
#include "host/config/keys.hpp"
#include "host/config/read_config.hpp"
#include "host/config/write_config.hpp"

namespace strainfinger::session {
namespace {

constexpr const char* kNothingIsKnown = ",,\n";

/// How well a finger reads, not what: who is told to mend these goes on with the rows.
constexpr std::array<std::string_view, 2> kNotOfRows{"gauges.noise_strain", "gauges.model_error"};

/// The full scale is in each strain, the finger's length in each load in newtons, the rest in where rows are
/// kept and what is asked for.
bool isOfRows(const config::Key& key) {
  return (key.section == "finger" || key.section == "gauges") &&
         std::ranges::find(kNotOfRows, key.dotted()) == kNotOfRows.end();
}

config::FingerConfig keptConfig(const std::string& path) {
  try {
    return config::readConfigFile(path);
  } catch (const Failure& failure) {
    throw Failure(ExitCode::kFailure, failure.what());
  }
}

std::string strainsHeader(int gauges) {
  return fmt::format("time_s,{}", fmt::join(strainColumns(gauges), ","));
}

std::string besides(const std::string& outputPath, const char* ending) {
  return std::filesystem::path(outputPath).replace_extension(ending).string();
}

[[noreturn]] void cannot(const std::string& path, const char* what) {
  throw Failure(ExitCode::kFailure, fmt::format("{}: cannot {}: {}", path, what, std::strerror(errno)));
}

bool isThere(const std::string& path) {
  std::error_code unknown;  // a folder that cannot be looked into is one where no file can be made either
  return std::filesystem::exists(path, unknown);
}

/// Files that are there although there is no session of that name are somebody's.
void requireNoStranger(const std::string& path, const std::string& strainsPath) {
  if (!isThere(path) || isThere(strainsPath)) return;
  throw Failure(ExitCode::kFailure,
                fmt::format("{}: there is such a file already, and no session of it ({}): give another -o",
                            path, strainsPath));
}

int openToAppend(const std::string& path) {
  const int descriptor = ::open(path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (descriptor < 0) cannot(path, "open the file");
  if (::flock(descriptor, LOCK_EX | LOCK_NB) == 0) return descriptor;
  ::close(descriptor);
  throw Failure(ExitCode::kFailure,
                fmt::format("{}: another session writes it now: end that, or give another -o", path));
}

/// What is in a file, up to the end of its last whole line.
std::string wholeLines(const std::string& path) {
  std::string text = readFile(path, ExitCode::kFailure);
  const auto end = text.rfind('\n');
  text.resize(end == text.npos ? 0 : end + 1);
  return text;
}

void requireHeader(const std::string& text, const std::string& header, const std::string& path) {
  if (text.empty() || text.substr(0, text.find('\n')) == header) return;
  throw Failure(
      ExitCode::kFailure,
      fmt::format(
          "{}:1:1: no file of a session with this finger: its first line must be \"{}\"; give another -o",
          path, header));
}

std::string cellText(const std::optional<double>& value) { return value ? fmt::format("{}", *value) : ""; }

std::string touchLine(const calibration::KnownTouch& known) {
  return fmt::format("{},{},{}\n", cellText(known.angle_deg), cellText(known.normal_n_per_m),
                     cellText(known.tangential_n_per_m));
}

}  // namespace

SessionFiles::SessionFiles(const std::string& outputPath, const config::FingerConfig& config)
    : config_(config),
      configPath_(besides(outputPath, ".session.toml")),
      strains_{besides(outputPath, ".strains.csv")},
      touches_{besides(outputPath, ".touches.csv")} {
  for (File* file : {&strains_, &touches_}) file->isNew = !isThere(file->path);
  for (const std::string& path : {outputPath, configPath_}) requireNoStranger(path, strains_.path);
  try {
    for (File* file : {&strains_, &touches_}) file->descriptor = openToAppend(file->path);
    readRows();
  } catch (...) {
    close();
    throw;
  }
}

SessionFiles::~SessionFiles() { close(); }

void SessionFiles::close() const {
  for (const File* file : {&strains_, &touches_}) {
    if (file->descriptor < 0) continue;
    if (file->isNew && !hasRows_) ::unlink(file->path.c_str());
    ::close(file->descriptor);
  }
}

/// Strains of another full scale would be wrong by its ratio, and nothing else would tell.
void SessionFiles::requireSameFinger() const {
  if (rows_.size() == 0 || !isThere(configPath_)) return;
  const config::FingerConfig kept = keptConfig(configPath_);
  for (const config::Key& key : config::keys()) {
    const std::string then = valueText(key, kept), now = valueText(key, config_);
    if (!isOfRows(key) || then == now) continue;
    throw Failure(
        ExitCode::kFailure,
        fmt::format("{}: its rows were collected with {} = {}, and the config now has {}: go on with "
                    "-c {}, or give another -o",
                    strains_.path, key.dotted(), then, now, configPath_));
  }
}

void SessionFiles::readRows() {
  const int gauges = config_.gauges.count;
  const std::string strains = wholeLines(strains_.path), touches = wholeLines(touches_.path);
  requireHeader(strains, strainsHeader(gauges), strains_.path);
  requireHeader(touches, kTouchHeader, touches_.path);
  std::istringstream strainText(strains), touchText(touches);
  const auto columns = static_cast<std::size_t>(gauges);
  NumberRowReader strainRows(strainText, strains_.path, columns, strainLimit(gauges));
  NumberRowReader touchRows(touchText, touches_.path, 3, touchLimit());
  std::size_t unpaired = 0;
  for (std::vector<double> row, known; strainRows.next(row);) {
    const bool isPaired = touchRows.next(known);
    if (!isPaired) known.assign(3, kNoValue);
    unpaired += isPaired ? 0 : 1;
    rows_.add(Eigen::Map<const Eigen::VectorXd>(row.data(), gauges),
              {valueOf(known[0]), valueOf(known[1]), valueOf(known[2])});
  }
  if (std::vector<double> known; touchRows.next(known))
    throw Failure(ExitCode::kFailure, fmt::format("{}: more rows than in {}, to whose rows they belong: take "
                                                  "the last ones away, or give another -o",
                                                  touches_.path, strains_.path));
  requireSameFinger();
  if (::ftruncate(strains_.descriptor, static_cast<off_t>(strains.size())) != 0)
    cannot(strains_.path, "write");
  if (::ftruncate(touches_.descriptor, static_cast<off_t>(touches.size())) != 0)
    cannot(touches_.path, "write");
  if (strains.empty()) appendLines(strains_.descriptor, strains_.path, strainsHeader(gauges) + "\n");
  if (touches.empty()) appendLines(touches_.descriptor, touches_.path, std::string(kTouchHeader) + "\n");
  for (std::size_t i = 0; i < unpaired; ++i) appendLines(touches_.descriptor, touches_.path, kNothingIsKnown);
  kept_ = rows_.size();
  hasRows_ = kept_ > 0;
}

std::string SessionFiles::named(std::string message) const {
  return calibration::ofFile(std::move(message), touches_.path);
}

/// The config before the first row, so that no row is without it; then the strains: a row without its touch
/// is one of which nothing is known.
void SessionFiles::add(double time_s, const Eigen::VectorXd& strains, const calibration::KnownTouch& known) {
  if (!hasRows_) writeFileAtomically(configPath_, config::writeConfig(config_));
  hasRows_ = true;
  appendLines(strains_.descriptor, strains_.path,
              fmt::format("{:.6f},{}\n", time_s, fmt::join(strains.begin(), strains.end(), ",")));
  ++kept_;
  appendLines(touches_.descriptor, touches_.path, touchLine(known));
}

void SessionFiles::rewriteTouches(const std::vector<calibration::KnownTouch>& known) {
  std::string text = std::string(kTouchHeader) + "\n";
  for (const calibration::KnownTouch& touch : known) text += touchLine(touch);
  writeFileAtomically(touches_.path, text);
  ::close(std::exchange(touches_.descriptor, openToAppend(touches_.path)));
}

}  // namespace strainfinger::session
