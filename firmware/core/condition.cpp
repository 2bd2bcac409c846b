#include "firmware/core/condition.hpp"

#include <algorithm>

namespace strainfinger::firmware {

namespace {
constexpr int kCodeBits = 15;  ///< a code's fraction bits as a zero
}

Calibration nominalCalibration(const TableConstants& constants) {
  Calibration calibration;
  calibration.zero_q15.fill(0x8000 << kCodeBits);
  calibration.gain.fill(constants.reading_gain);
  return calibration;
}

std::int32_t strainOf(const Calibration& calibration, std::uint16_t code, std::size_t gauge) {
  return mulHigh((std::int32_t{code} << kCodeBits) - calibration.zero_q15[gauge], calibration.gain[gauge]);
}

void condition(const TableConstants& constants, const Calibration& calibration, Codes codes,
               Readings& readings) {
  readings.saturated = 0;
  for (std::size_t i = 0; i < codes.size(); ++i) {
    readings.strain_q32[i] = strainOf(calibration, codes[i], i);
    if (codes[i] == 0 || codes[i] >= constants.adc_rail) readings.saturated |= 1u << i;
  }
}

bool ZeroAverage::add(Codes codes) {
  if (complete()) return true;
  std::transform(codes.begin(), codes.end(), sum_.begin(), sum_.begin(),
                 [](std::uint16_t code, std::uint32_t sum) { return sum + code; });
  ++count_;
  return complete();
}

void ZeroAverage::writeTo(Calibration& calibration) const {
  static_assert(kSamples == 1 << 6 && kCodeBits >= 6);
  std::transform(sum_.begin(), sum_.end(), calibration.zero_q15.begin(),
                 [](std::uint32_t sum) { return static_cast<std::int32_t>(sum << (kCodeBits - 6)); });
}

}  // namespace strainfinger::firmware
