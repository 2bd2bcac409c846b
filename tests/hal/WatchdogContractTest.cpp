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

}  // namespace

WATCHDOG_CONTRACT(Spy, SpyBench)
