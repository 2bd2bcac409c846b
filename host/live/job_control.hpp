#pragma once
// Being stopped by the shell (Ctrl-Z) and continued (`fg`).

#include <csignal>

namespace strainfinger::live {

/// While it lives, SIGTSTP (Ctrl-Z) doesn't stop the process but is remembered, so that the terminal can be
/// given back before; and so is SIGCONT, after which the terminal is as the shell left it. A shell without
/// job control has SIGTSTP ignored, and it stays so. One at a time.
class JobControl {
 public:
  JobControl() {
    stopAsked_ = 0;
    continued_ = 0;
    beforeStop_ = std::signal(SIGTSTP, rememberStop);
    if (beforeStop_ == SIG_IGN) std::signal(SIGTSTP, SIG_IGN);
    beforeContinue_ = std::signal(SIGCONT, rememberContinue);
  }
  /// A stop that is remembered still comes now.
  ~JobControl() {
    std::signal(SIGCONT, beforeContinue_);
    std::signal(SIGTSTP, beforeStop_);
    if (stopAsked_ != 0) std::raise(SIGTSTP);
  }
  JobControl(const JobControl&) = delete;
  JobControl& operator=(const JobControl&) = delete;

  bool stopAsked() const { return stopAsked_ != 0; }

  /// Stops the process, as SIGTSTP would have; returns when it is continued. At once where the kernel stops
  /// nothing, because no shell could continue it (an orphaned process group: `ssh -t HOST`, `xterm -e`).
  void stop() {
    stopAsked_ = 0;
    std::signal(SIGTSTP, SIG_DFL);
    std::raise(SIGTSTP);
    std::signal(SIGTSTP, rememberStop);
  }

  /// Whether the process was continued since this was asked last.
  bool takeContinued() {
    const bool was = continued_ != 0;
    continued_ = 0;
    return was;
  }

 private:
  static void rememberStop(int) { stopAsked_ = 1; }
  static void rememberContinue(int) { continued_ = 1; }

  inline static volatile std::sig_atomic_t stopAsked_ = 0, continued_ = 0;
  void (*beforeStop_)(int);
  void (*beforeContinue_)(int);
};

}  // namespace strainfinger::live
