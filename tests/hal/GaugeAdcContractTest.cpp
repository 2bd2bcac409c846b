#include "host/simulation/simulated_gauges.hpp"
#include "tests/doubles/fake_gauge_adc.hpp"
#include "tests/hal/gauge_adc_contract.hpp"

using namespace strainfinger;

namespace {

class FakeGaugeAdcBench {
 public:
  static constexpr int kGauges = kMaxGauges;
  static constexpr int kCapacity = doubles::FakeGaugeAdc::kCapacity;
  doubles::FakeGaugeAdc& adc() { return adc_; }
  hal::SampleSet convert() {
    hal::SampleSet set;
    for (std::uint16_t& code : set) code = ++code_;
    adc_.convert(set);
    return set;
  }

 private:
  doubles::FakeGaugeAdc adc_;
  std::uint16_t code_ = 0;
};

/// A twin that is read at once tells what each conversion gave; the noise makes every set another.
class SimulatedGaugeAdcBench {
 public:
  static constexpr int kGauges = config::Gauges{}.count;
  static constexpr int kCapacity = simulation::SimulatedGauges::kBuffers;
  simulation::SimulatedGauges& adc() { return adc_; }
  hal::SampleSet convert() {
    clock_.advance_us(simulation::SimulatedGauges::kSamplePeriod_us);
    hal::SampleSet set{};
    twin_.read(set);
    return set;
  }

 private:
  simulation::SimulatedClock clock_;
  simulation::SimulatedGauges adc_{config::FingerConfig{}, simulation::Scenario({}), clock_};
  simulation::SimulatedGauges twin_{config::FingerConfig{}, simulation::Scenario({}), clock_};
};

}  // namespace

GAUGE_ADC_CONTRACT(Fake, FakeGaugeAdcBench)
GAUGE_ADC_CONTRACT(Simulated, SimulatedGaugeAdcBench)
