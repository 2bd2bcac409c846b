#include "firmware/core/hypothesis.hpp"

#include <algorithm>

namespace strainfinger::firmware {
namespace {

/// Rounding of a reading and of its prediction: 1/12 each, and what is lost in the columns [* 2^4].
constexpr std::uint32_t kRoundingVariance_q4 = 4;
constexpr std::uint32_t kMostVariance_q4 = 0x7FFFFFFF;

std::uint32_t noiseVariance_q4(const TableConstants& constants, int shift) {
  const int up = constants.noise_variance_exponent + 4 - 2 * shift;
  if (up <= -32) return 0;
  if (up < 0) return constants.noise_variance >> -up;
  if (up >= 8 || constants.noise_variance > kMostVariance_q4 >> up) return kMostVariance_q4;
  return constants.noise_variance << up;
}

}  // namespace

ScaledReadings scaledReadings(const TableConstants& constants, std::span<const Number> strains_q32,
                              GaugeSet gauges, std::uint32_t noise_q4, int shift) {
  Number largest = 0;
  for (std::size_t i = 0; i < strains_q32.size(); ++i)
    if (contains(gauges, static_cast<int>(i))) largest = larger(largest, signlessBits(strains_q32[i]));
  ScaledReadings scaled;
  const int own = std::max(bitWidth(largest) - 15, 0);
  scaled.shift = static_cast<std::int8_t>(shift == own + 1 ? shift : own);
  largest = largest >> scaled.shift;
  for (std::size_t i = 0; i < strains_q32.size(); ++i)
    scaled.value[i] = shortened(strains_q32[i] >> scaled.shift);
  const Natural modelError = static_cast<Natural>(largest) * constants.model_error_q16 >> 14;  // * 4
  const Natural noise =
      (Natural{noiseVariance_q4(constants, scaled.shift)} * noise_q4 >> 4) + kRoundingVariance_q4;
  const auto withModelError = [&](Natural error) {
    return static_cast<std::uint32_t>(std::min<Natural>(error * error + noise, kMostVariance_q4));
  };
  scaled.variances = {withModelError(modelError), withModelError(modelError >> kGateModelError),
                      withModelError(0)};
  return scaled;
}

ContactStates rescaled(const ContactStates& contacts, int from, int to) {
  ContactStates scaled = contacts;
  if (from == to) return scaled;
  for (ContactState& contact : scaled) {
    contact.normal = shifted(contact.normal, from - to, kMostLoad);
    contact.tangential = shifted(contact.tangential, from - to, kMostLoad);
  }
  return scaled;
}

}  // namespace strainfinger::firmware
