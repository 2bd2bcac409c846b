#pragma once
// The world of an emulated board: gauges, bus and time, as the host tells them.

#include <algorithm>
#include <cstdint>

#include "firmware/app/slcan_port.hpp"
#include "firmware/board/mps2/timer.hpp"
#include "firmware/board/mps2/world_record.hpp"
#include "hal/clock.hpp"
#include "hal/gauge_adc.hpp"

namespace strainfinger::mps2 {

/// hal::GaugeAdc and hal::Clock of an emulated board. The next record is taken only when the sample set
/// before it was handed out and everything sent is on its way: what the firmware does with a record never
/// depends on how fast the line is. Time is the number of records, or a timer's when there is one.
template <firmware::SerialLine Line, typename Can, hal::Clock Timer = mps2::Timer>
class World {
 public:
  constexpr World(Line& line, Can& can, const Timer* timer = nullptr)
      : line_(line), can_(can), timer_(timer) {}

  bool read(hal::SampleSet& set) noexcept {
    if (!waiting_) return false;
    const WorldRecord& record = reader_.record();
    for (std::size_t gauge = 0; gauge < record.size / 2; ++gauge) set[gauge] = record.code(gauge);
    waiting_ = false;
    return true;
  }
  std::uint32_t overruns() const noexcept { return 0; }
  std::uint32_t resynchronisations() const noexcept { return 0; }
  std::uint32_t now_us() const noexcept { return timer_ != nullptr ? timer_->now_us() : now_us_; }

  /// The next record, if it is there and nothing is left to do with the last. `act` gets those that are
  /// neither samples nor silence. True: something happened.
  template <typename Act>
  bool poll(Act act) noexcept {
    while (!waiting_ && can_.idle()) {
      const auto byte = line_.get();
      if (!byte) return false;
      if (!reader_.take(*byte)) continue;
      happen(act);
      return true;
    }
    return waiting_;
  }

 private:
  template <typename Act>
  void happen(Act act) {
    const WorldRecord& record = reader_.record();
    waiting_ = record.kind == RecordKind::kSamples;
    if (waiting_ || record.kind == RecordKind::kSilence)
      now_us_ += kRecordPeriod_us;
    else
      act(record);
  }

  Line& line_;
  Can& can_;
  const Timer* timer_;
  RecordReader reader_;
  std::uint32_t now_us_ = 0;
  bool waiting_ = false;
};

}  // namespace strainfinger::mps2
