#include "tests/doubles/fake_gauge_adc.hpp"
#include "tests/hal/gauge_adc_contract.hpp"

using namespace strainfinger;

namespace {

class FakeBench {
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

}  // namespace

GAUGE_ADC_CONTRACT(Fake, FakeBench)
