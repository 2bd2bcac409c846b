#include <chrono>
#include <thread>

#include "host/simulation/simulated_clock.hpp"
#include "host/system/steady_clock.hpp"
#include "tests/doubles/fake_clock.hpp"
#include "tests/hal/clock_contract.hpp"

using namespace strainfinger;

namespace {

class SteadyBench {
 public:
  system::SteadyClock& clock() { return clock_; }
  void pass(std::uint32_t time_us) { std::this_thread::sleep_for(std::chrono::microseconds(time_us)); }

 private:
  system::SteadyClock clock_;
};

class FakeClockBench {
 public:
  doubles::FakeClock& clock() { return clock_; }
  void pass(std::uint32_t time_us) { clock_.advance(time_us); }

 private:
  doubles::FakeClock clock_{UINT32_MAX - 1000};  // so that it wraps on the way
};

class SimulatedClockBench {
 public:
  SimulatedClockBench() { clock_.advance_us(UINT32_MAX - 1000); }
  simulation::SimulatedClock& clock() { return clock_; }
  void pass(std::uint32_t time_us) { clock_.advance_us(time_us); }

 private:
  simulation::SimulatedClock clock_;
};

}  // namespace

CLOCK_CONTRACT(Steady, SteadyBench)
CLOCK_CONTRACT(Fake, FakeClockBench)
CLOCK_CONTRACT(Simulated, SimulatedClockBench)
