#pragma once
// Being asked to stop.

#include <array>
#include <chrono>
#include <csignal>
#include <cstdint>

namespace strainfinger::system {

/// While it lives, SIGINT (Ctrl-C), SIGTERM and SIGHUP (the terminal is closed) don't end the process but are
/// remembered. One at a time.
class StopSignal {
 public:
  StopSignal() {
    asked_ = 0;
    for (Handled& each : handled_) each.previous = std::signal(each.number, remember);
    Handled& hangUp = handled_.back();
    if (hangUp.previous == SIG_IGN) std::signal(hangUp.number, SIG_IGN);  // nohup: it is to go on
  }
  ~StopSignal() {
    for (const Handled& each : handled_) std::signal(each.number, each.previous);
  }
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;

  /// How often to look at asked() while waiting for something else: nobody notices that a Ctrl-C takes so
  /// long.
  static constexpr std::chrono::milliseconds kLookEvery{100};

  bool asked() const { return asked_ != 0; }

  /// How often it was asked: the first time may only be taken note of, where stopping does harm.
  int times() const { return asked_; }

 private:
  struct Handled {
    int number;
    void (*previous)(int) = SIG_DFL;
  };
  static void remember(int) {
    if (asked_ < SIG_ATOMIC_MAX) asked_ = asked_ + 1;
  }

  inline static volatile std::sig_atomic_t asked_ = 0;
  std::array<Handled, 3> handled_{Handled{SIGINT}, Handled{SIGTERM}, Handled{SIGHUP}};
};

}  // namespace strainfinger::system
