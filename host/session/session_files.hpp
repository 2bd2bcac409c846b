#pragma once
// The files of a session: rows of strains and of what is known of them, as `calibrate --strains --touches`
// reads them, and the config that they were collected with. A row that was added is there whatever ends the
// program.

#include <string>
#include <vector>

#include "host/config/finger_config.hpp"
#include "host/session/rows.hpp"

namespace strainfinger::session {

class SessionFiles {
 public:
  /// Beside the config that the session is to write: of "cal.toml", cal.strains.csv, cal.touches.csv and,
  /// from the first row on, cal.session.toml. Makes them, or goes on with what they hold; a row that a killed
  /// program left half written is taken away. New files without a row don't stay. Throws Failure(kFailure),
  /// and changes nothing, when one of the configs is there but no strains, when they hold something else,
  /// when their rows were collected with another [finger] or other [gauges] (noise and model error apart,
  /// which rows don't depend on), or when another session writes them now. Rows without a cal.session.toml,
  /// of older programs, are taken for this config's.
  SessionFiles(const std::string& outputPath, const config::FingerConfig& config);
  ~SessionFiles();
  SessionFiles(const SessionFiles&) = delete;
  SessionFiles& operator=(const SessionFiles&) = delete;

  /// What was there.
  const Rows& rows() const { return rows_; }
  const std::string& strainsPath() const { return strains_.path; }
  const std::string& touchesPath() const { return touches_.path; }

  /// What calibrate() says of touches.csv, of this session's file.
  std::string named(std::string message) const;

  /// Rows that the files hold by now.
  std::size_t kept() const { return kept_; }

  /// `time_s`: since 1970. Throws Failure(kFailure) when the disk is full or broken.
  void add(double time_s, const Eigen::VectorXd& strains, const calibration::KnownTouch& known);
  /// What is known of each row now, after something was taken back. Throws as add(); the file then holds what
  /// it did.
  void rewriteTouches(const std::vector<calibration::KnownTouch>& known);

 private:
  struct File {
    std::string path;
    bool isNew = true;
    int descriptor = -1;
  };
  void close() const;
  void readRows();
  void requireSameFinger() const;

  config::FingerConfig config_;
  std::string configPath_;
  File strains_, touches_;
  Rows rows_;
  bool hasRows_ = false;  ///< or one was begun
  std::size_t kept_ = 0;
};

}  // namespace strainfinger::session
