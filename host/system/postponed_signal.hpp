#pragma once
// A signal that is to wait.

#include <csignal>

namespace strainfinger::system {

/// While it lives, the signal does nothing; if it came meanwhile, it is raised when that ends. One at a time.
class PostponedSignal {
 public:
  explicit PostponedSignal(int number) : number_(number) {
    came_ = 0;
    previous_ = std::signal(number_, remember);
  }
  ~PostponedSignal() {
    std::signal(number_, previous_);
    if (came_ != 0) std::raise(number_);
  }
  PostponedSignal(const PostponedSignal&) = delete;
  PostponedSignal& operator=(const PostponedSignal&) = delete;

 private:
  static void remember(int) { came_ = 1; }

  inline static volatile std::sig_atomic_t came_ = 0;
  int number_;
  void (*previous_)(int);
};

}  // namespace strainfinger::system
