#include "host/system/no_watchdog.hpp"
#include "tests/doubles/spy_watchdog.hpp"
#include "tests/hal/watchdog_contract.hpp"

using namespace strainfinger;

namespace {

class SpyBench {
 public:
  doubles::SpyWatchdog& watchdog() { return watchdog_; }

 private:
  doubles::SpyWatchdog watchdog_{hal::ResetCause::kBrownOut};
};

class NoneBench {
 public:
  system::NoWatchdog& watchdog() { return watchdog_; }

 private:
  system::NoWatchdog watchdog_;
};

}  // namespace

WATCHDOG_CONTRACT(Spy, SpyBench)
WATCHDOG_CONTRACT(None, NoneBench)
