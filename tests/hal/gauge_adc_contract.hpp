#pragma once
// The contract of hal::GaugeAdc as tests, for any backend:
//
//   struct MyBench {
//     MyAdc& adc();
//     hal::SampleSet convert();       // one more conversion period ends; the codes that it gave
//     static constexpr int kGauges;   // codes that are looked at
//     static constexpr int kCapacity; // sets kept for a slow reader
//   };
//   GAUGE_ADC_CONTRACT(MyAdc, MyBench)

#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <vector>

#include "hal/gauge_adc.hpp"

namespace strainfinger::contract {

template <typename Bench>
class GaugeAdcContract {
 public:
  void withoutAConversionTheSetIsLeftAlone() {
    hal::SampleSet set;
    set.fill(kUntouched);
    CHECK_FALSE(bench_.adc().read(set));
    CHECK_TRUE(std::ranges::all_of(set, [](std::uint16_t code) { return code == kUntouched; }));
  }

  void aSetIsHandedOutOnce() {
    const hal::SampleSet converted = bench_.convert();
    hal::SampleSet set{};
    CHECK_TRUE(bench_.adc().read(set));
    CHECK_TRUE(sameCodes(converted, set));
    CHECK_FALSE(bench_.adc().read(set));
    LONGS_EQUAL(0, bench_.adc().overruns());
    LONGS_EQUAL(0, bench_.adc().resynchronisations());
  }

  void aSlowReaderGetsTheNewestSetsInOrderAndTheRestIsCounted() {
    constexpr int kTooMany = 3;
    std::vector<hal::SampleSet> converted;
    for (int i = 0; i < Bench::kCapacity + kTooMany; ++i) converted.push_back(bench_.convert());
    hal::SampleSet set{};
    for (std::size_t i = kTooMany; i < converted.size(); ++i) {
      CHECK_TRUE(bench_.adc().read(set));
      CHECK_TRUE(sameCodes(converted[i], set));
    }
    CHECK_FALSE(bench_.adc().read(set));
    LONGS_EQUAL(kTooMany, bench_.adc().overruns());
  }

 private:
  static constexpr std::uint16_t kUntouched = 0x5A5A;

  static bool sameCodes(const hal::SampleSet& a, const hal::SampleSet& b) {
    return std::equal(a.begin(), a.begin() + Bench::kGauges, b.begin());
  }

  Bench bench_;
};

}  // namespace strainfinger::contract

#define GAUGE_ADC_CONTRACT(Backend, Bench)                                           \
  TEST_GROUP(GaugeAdc_##Backend) {                                                   \
    strainfinger::contract::GaugeAdcContract<Bench> contract;                        \
  };                                                                                 \
  TEST(GaugeAdc_##Backend, WithoutAConversionTheSetIsLeftAlone) {                    \
    contract.withoutAConversionTheSetIsLeftAlone();                                  \
  }                                                                                  \
  TEST(GaugeAdc_##Backend, ASetIsHandedOutOnce) { contract.aSetIsHandedOutOnce(); }  \
  TEST(GaugeAdc_##Backend, ASlowReaderGetsTheNewestSetsInOrderAndTheRestIsCounted) { \
    contract.aSlowReaderGetsTheNewestSetsInOrderAndTheRestIsCounted();               \
  }
