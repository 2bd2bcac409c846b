#pragma once
// Truth beside estimate, for people to watch.

#include <cstdio>
#include <optional>
#include <string>

#include "host/config/finger_config.hpp"
#include "host/simulation/simulated_finger.hpp"

namespace strainfinger::cli {

/// What the finger has just said beside what is true, every kPeriod_s of a run, as it goes: a line for each
/// touch and its contact. Where the stream takes nothing the run goes on.
class TruthTable {
 public:
  static constexpr double kPeriod_s = 0.25;

  TruthTable(std::FILE* stream, const config::Finger& finger);
  void add(const simulation::Moment& moment);

 private:
  void print(const simulation::ComparedTouch& compared) const;
  std::string estimateText(const can::ContactReport& contact,
                           const std::optional<simulation::Touch>& touch) const;
  void write(const std::string& line) const { std::fputs(line.c_str(), stream_); }

  std::FILE* stream_;
  config::Finger finger_;
  double nextLine_s_ = kPeriod_s;
  bool inContact_ = false;  ///< by the finger's last word
};

}  // namespace strainfinger::cli
