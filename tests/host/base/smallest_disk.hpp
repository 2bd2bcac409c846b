#pragma once
// A disk that is soon full.

#include <sys/resource.h>

#include <csignal>

namespace strainfinger {

/// While it lives, no file takes more than so many bytes.
class SmallestDisk {
 public:
  explicit SmallestDisk(rlim_t most_bytes) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{most_bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~SmallestDisk() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, signalBefore_);
  }
  SmallestDisk(const SmallestDisk&) = delete;
  SmallestDisk& operator=(const SmallestDisk&) = delete;

 private:
  rlimit before_{};
  void (*signalBefore_)(int) = std::signal(SIGXFSZ, SIG_IGN);  // as the program does: an error, not its end
};

}  // namespace strainfinger
