#pragma once
// The files of a session: rows of strains and of what is known of them, as `calibrate --strains --touches`
// reads them. A row that was added is there whatever ends the program.

#include <string>
#include <vector>

#include "host/session/rows.hpp"

namespace strainfinger::session {

class SessionFiles {
 public:
  /// Beside the config that the session is to write: of "cal.toml", cal.strains.csv and cal.touches.csv; of
  /// rings with so many gauges. Makes them, or goes on with what they hold; a row that a killed program left
  /// half written is taken away. New files without a row don't stay. Throws Failure(kFailure), and changes
  /// nothing, when the config is there already but not these, when they hold something else, or when another
  /// session writes them now.
  SessionFiles(const std::string& outputPath, int gauges);
  ~SessionFiles();
  SessionFiles(const SessionFiles&) = delete;
  SessionFiles& operator=(const SessionFiles&) = delete;

  /// What was there.
  const Rows& rows() const { return rows_; }
  const std::string& strainsPath() const { return strains_.path; }
  const std::string& touchesPath() const { return touches_.path; }

  /// What calibrate() says of touches.csv, of this session's file.
  std::string named(std::string message) const;

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
  void readRows(int gauges);
  static void append(const File& file, const std::string& line);

  File strains_, touches_;
  Rows rows_;
  bool hasRows_ = false;
};

}  // namespace strainfinger::session
