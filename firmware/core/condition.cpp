#include "firmware/core/condition.hpp"

#include <algorithm>

namespace strainfinger::firmware {

Calibration tabledCalibration(const TableImage& tables) {
  Calibration calibration;
  calibration.zero_q15.fill(0x8000 << kCodeBits);
  for (std::size_t i = 0; i < calibration.gain.size(); ++i)
    calibration.gain[i] = static_cast<std::int32_t>(tables.gains.gainOf(tables.constants.reading_gain, i));
  return calibration;
}

void condition(const Calibration& calibration, Codes codes, Readings& readings) {
  const std::uint16_t* code = codes.data();
  const std::int32_t* zero = calibration.zero_q15.data();
  const std::int32_t* gain = calibration.gain.data();
  std::int32_t* strain = readings.strain_q32.data();
  const auto conditionTwo = [&](std::ptrdiff_t i) {  // in this order two words are loaded and stored at once
    const std::int32_t zero1 = zero[i], zero2 = zero[i + 1];
    const std::int32_t gain1 = gain[i], gain2 = gain[i + 1];
    const std::int32_t first = conditioned(code[i], zero1, gain1);
    const std::int32_t second = conditioned(code[i + 1], zero2, gain2);
    strain[i] = first;
    strain[i + 1] = second;
  };
  const auto advance = [&](std::ptrdiff_t by) {
    code += by;
    zero += by;
    gain += by;
    strain += by;
  };
  const std::uint16_t* const end = code + codes.size();
  for (std::size_t left = codes.size() % 8; left > 0; --left) {
    *strain = conditioned(*code, *zero, *gain);
    advance(1);
  }
  while (code != end) {
    conditionTwo(0);
    conditionTwo(2);
    conditionTwo(4);
    conditionTwo(6);
    advance(8);
  }
}

std::uint32_t saturatedGauges(const TableConstants& constants, Codes codes) {
  const int upper = constants.adc_rail, lower = 0xFFFF - upper;
  std::uint32_t saturated = 0;
  for (std::size_t i = 0; i < codes.size(); ++i)
    if (codes[i] <= lower || codes[i] >= upper) saturated |= 1u << i;
  return saturated;
}

bool ZeroAverage::add(Codes codes) {
  if (complete()) return true;
  std::transform(codes.begin(), codes.end(), sum_.begin(), sum_.begin(),
                 [](std::uint16_t code, std::uint32_t sum) { return sum + code; });
  if (++count_ == kSamples / 2)
    std::transform(sum_.begin(), sum_.end(), firstHalf_.begin(), [](std::uint32_t sum) {
      return static_cast<std::uint16_t>((sum + kSamples / 4) >> (kSampleBits - 1));
    });
  return complete();
}

void ZeroAverage::writeTo(Calibration& calibration) const {
  std::transform(sum_.begin(), sum_.end(), calibration.zero_q15.begin(), [](std::uint32_t sum) {
    return static_cast<std::int32_t>(sum << (kCodeBits - kSampleBits));
  });
}

std::uint32_t ZeroAverage::gaugesAtRail(const TableConstants& constants) const {
  std::array<std::uint16_t, kMaxGauges> mean;
  std::transform(sum_.begin(), sum_.end(), mean.begin(),
                 [](std::uint32_t sum) { return static_cast<std::uint16_t>(sum >> kSampleBits); });
  return saturatedGauges(constants, std::span(mean).first(constants.gauge_count));
}

Readings ZeroAverage::change(const Calibration& calibration) const {
  Readings change;
  for (std::size_t i = 0; i < change.strain_q32.size(); ++i) {
    const std::int32_t twice = static_cast<std::int32_t>(sum_[i]) - firstHalf_[i] * kSamples;
    change.strain_q32[i] = mulHigh(twice * (1 << (kCodeBits - kSampleBits + 1)), calibration.gain[i]);
  }
  return change;
}

}  // namespace strainfinger::firmware
