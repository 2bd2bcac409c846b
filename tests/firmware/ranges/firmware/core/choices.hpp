#pragma once
// Code that goes one way or the other by what a number is, run for both where only bounds of it are known.

#include <cstddef>
#include <stdexcept>
#include <vector>

namespace strainfinger::firmware {

/// The decisions of a run; every run that could be is made in turn.
class Choices {
 public:
  /// 0 .. count - 1: all of them, in as many runs.
  int of(int count) {
    if (count == 1) return 0;
    if (!running_) throw std::logic_error("a choice of which the other ways would be forgotten");
    if (next_ == made_.size()) made_.push_back({0, count});
    return made_[next_++].taken;
  }
  /// Whether there is another run.
  bool advance() {
    next_ = 0;
    while (!made_.empty() && ++made_.back().taken == made_.back().count) made_.pop_back();
    return running_ = !made_.empty();
  }
  void begin() {
    if (running_) throw std::logic_error("ways within ways");
    made_.clear();
    next_ = 0;
    running_ = true;
  }

 private:
  struct Choice {
    int taken, count;
  };
  std::vector<Choice> made_;
  std::size_t next_ = 0;
  bool running_ = false;
};
inline Choices choices;

/// Runs a function once for each way through it.
template <typename Run>
int forEachWay(Run run) {
  int ways = 0;
  choices.begin();
  do {
    run();
    ++ways;
  } while (choices.advance());
  return ways;
}

}  // namespace strainfinger::firmware
