#pragma once
// From the elastic model to what the methods know.

#include "host/bench/methods/knowledge.hpp"
#include "host/bench/readings.hpp"
#include "host/bench/training.hpp"

namespace strainfinger::bench {

template <typename Real>
RingResponse<Real> makeResponse(const BenchFinger& finger);

template <typename Real>
GlobalBank<Real> makeGlobalBank(const BenchFinger& finger);

/// The firmware's patches for any width.
template <typename Real>
PatchTable<Real> makePatches(const BenchFinger& finger);

template <typename Real>
WidthBank<Real> makeWidthBank(const PatchTable<Real>& patches);

/// Trains the perceptron too: ten seconds by default, and the same weights on every run of one machine.
Knowledge makeKnowledge(const BenchFinger& finger, const Training& training = {});

}  // namespace strainfinger::bench
