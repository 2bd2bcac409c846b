#pragma once
// A small multilayer perceptron, trained by training.hpp.

#include "host/bench/methods/peak.hpp"
#include "host/bench/methods/templates.hpp"

namespace strainfinger::bench {

template <std::size_t Inputs, std::size_t Outputs>
struct Layer {
  std::array<std::array<float, Inputs>, Outputs> weight;
  std::array<float, Outputs> bias;

  std::array<float, Outputs> operator()(const std::array<float, Inputs>& input) const {
    std::array<float, Outputs> output;
    for (std::size_t i = 0; i < Outputs; ++i) output[i] = bias[i] + dot(weight[i], input);
    return output;
  }
};

/// Seven gauges about the sharpest one, over the sum of their magnitudes, to offset and loads over the same.
struct Perceptron {
  static constexpr std::size_t kHidden = 16;
  static constexpr float kLeak = 0.1f;           ///< slope of a hidden unit below zero
  static constexpr float kLoadPerStrain = 1e3f;  ///< brings loads over strains near 1 [N/m]

  Layer<kWindow, kHidden> first;
  Layer<kHidden, kHidden> second;
  Layer<kHidden, 3> last;

  static float scaleOf(const Window<float>& window) {
    float sum = 0;
    for (const float strain : window) sum += strain < 0 ? -strain : strain;
    return sum;
  }
  static std::array<float, kHidden> bent(std::array<float, kHidden> values) {
    for (float& value : values)
      if (value < 0) value *= kLeak;
    return values;
  }

  Place<float> operator()(const Ring<float>& strain) const {
    const int middle = sharpestGauge(strain);
    Window<float> window = windowAbout(strain, middle);
    const float scale = scaleOf(window);
    for (float& value : window) value /= scale;
    const auto output = last(bent(second(bent(first(window)))));
    const float load = scale * kLoadPerStrain;
    return {static_cast<float>(middle) + output[0], output[1] * load, output[2] * load};
  }
};

}  // namespace strainfinger::bench
