#pragma once
// Being asked to stop.

#include <chrono>
#include <csignal>

namespace strainfinger::system {

/// While it lives, SIGINT (Ctrl-C) and SIGTERM don't end the process but are remembered. One at a time.
class StopSignal {
 public:
  StopSignal() {
    asked_ = 0;
    previousInterrupt_ = std::signal(SIGINT, remember);
    previousTerminate_ = std::signal(SIGTERM, remember);
  }
  ~StopSignal() {
    std::signal(SIGINT, previousInterrupt_);
    std::signal(SIGTERM, previousTerminate_);
  }
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;

  /// How often to look at asked() while waiting for something else: nobody notices that a Ctrl-C takes so
  /// long.
  static constexpr std::chrono::milliseconds kLookEvery{100};

  bool asked() const { return asked_ != 0; }

 private:
  using Handler = void (*)(int);
  static void remember(int) { asked_ = 1; }

  inline static volatile std::sig_atomic_t asked_ = 0;
  Handler previousInterrupt_;
  Handler previousTerminate_;
};

}  // namespace strainfinger::system
