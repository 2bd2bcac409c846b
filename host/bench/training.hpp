#pragma once
// Teaches the perceptron.

#include "host/bench/methods/perceptron.hpp"
#include "host/bench/readings.hpp"

namespace strainfinger::bench {

/// `contacts` is a multiple of the batch, 64. Bounded by `steps`, not by a clock: the same weights every
/// time.
struct Training {
  int steps = 150'000;
  std::uint64_t seed = 20;
  int contacts = 1 << 16;  ///< gone through again and again
};

/// Adam (Kingma & Ba 2015) on the mean square of offset, normal and tangential load, batches of 64 contacts
/// as readingOf() draws them at 0.3 % of noise, the rate falling to nothing along half a cosine. A step takes
/// about 60 us.
Perceptron trainedPerceptron(const BenchFinger& finger, const Training& training);

}  // namespace strainfinger::bench
