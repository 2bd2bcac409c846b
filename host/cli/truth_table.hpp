#pragma once
// Truth beside estimate, for people to watch.

#include <cstdio>
#include <string>

#include "host/config/finger_config.hpp"
#include "host/simulation/simulated_finger.hpp"

namespace strainfinger::cli {

/// A line every kPeriod_s of a run, as it goes: what the finger has just said beside what is true. Where the
/// stream takes nothing the run goes on.
class TruthTable {
 public:
  static constexpr double kPeriod_s = 0.25;

  TruthTable(std::FILE* stream, const config::Finger& finger);
  void add(const simulation::Moment& moment);

 private:
  void print(const simulation::ComparedTouch& touch) const;
  void write(const std::string& line) const { std::fputs(line.c_str(), stream_); }

  std::FILE* stream_;
  config::Finger finger_;
  double nextLine_s_ = kPeriod_s;
  bool inContact_ = false;  ///< by the finger's last word
};

}  // namespace strainfinger::cli
