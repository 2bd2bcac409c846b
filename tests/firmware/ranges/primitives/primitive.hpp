#pragma once
// What the proof has a model of, listed once and compiled twice: as the firmware has it, and with bounds for
// numbers (../firmware/core).

#include <cstdint>
#include <string>
#include <vector>

namespace strainfinger::ranges {

/// Exact for all numbers of 64 bits, with and without a sign.
struct Interval {
  long double least, most;
};

/// What an argument may be without an overflow of the firmware's.
struct Domain {
  long double least, most;
  bool isPlain = false;  ///< an int in the model, too
};

struct Primitive {
  std::string name;
  std::vector<Domain> domain;
  Interval (*result)(const Interval* arguments);
  bool isExact = true;  ///< of known numbers; else the model knows bounds of it
};

/// The firmware's own; of each of the arguments, the lower bound.
std::vector<Primitive> firmwarePrimitives();

}  // namespace strainfinger::ranges
