#pragma once
// A gauge converter whose sample sets the test provides.

#include <deque>

#include "hal/gauge_adc.hpp"

namespace strainfinger::doubles {

class FakeGaugeAdc {
 public:
  static constexpr std::size_t kCapacity = 2;  ///< sets not read yet, as a double-buffered DMA holds

  /// A conversion period ends with these codes.
  void convert(const hal::SampleSet& set) {
    if (waiting_.size() == kCapacity) {
      waiting_.pop_front();
      ++overruns_;
    }
    waiting_.push_back(set);
  }

  /// It lost track and begins anew: what waits is lost.
  void resynchronise() {
    overruns_ += static_cast<std::uint32_t>(waiting_.size());
    waiting_.clear();
    ++resynchronisations_;
  }

  bool read(hal::SampleSet& set) noexcept {
    if (waiting_.empty()) return false;
    set = waiting_.front();
    waiting_.pop_front();
    return true;
  }

  std::uint32_t overruns() const noexcept { return overruns_; }
  std::uint32_t resynchronisations() const noexcept { return resynchronisations_; }

 private:
  std::deque<hal::SampleSet> waiting_;
  std::uint32_t overruns_ = 0;
  std::uint32_t resynchronisations_ = 0;
};

static_assert(hal::GaugeAdc<FakeGaugeAdc>);

}  // namespace strainfinger::doubles
