#pragma once
// Values of a view as people read them.

#include <limits>
#include <string>
#include <vector>

#include "host/live/finger_view.hpp"

namespace strainfinger::live {

/// What a finger says: its `largest` value stands for anything beyond it too.
struct Said {
  double value;
  double largest = std::numeric_limits<double>::infinity();
};

/// "57.21 ± 0.01 deg"; "?" in place of what is not known, ">=0.127" for that or more. `unit` may be empty.
std::string measured(const Said& value, const Said& sigma, int decimals, const char* unit);

/// The same, always with its sign: "+0.282 ± 0.004 N".
std::string measuredSigned(const Said& value, const Said& sigma, int decimals, const char* unit);

std::string angleText(const can::ContactReport& contact);
std::string normalText(const can::ContactReport& contact);
std::string tangentialText(const can::ContactReport& contact);
/// "quality 20 % or at 95 deg": what else fits as well; "" where it is not known.
std::string qualityText(const can::ContactReport& contact);
std::string widthText(const can::TouchReport& touch);

/// "1:02:03"; "?" where it is not known, ">=18:12:14" for the largest that a finger can say.
std::string durationText(std::uint16_t seconds);

/// "run"; "silent" for one that says nothing any more.
std::string stateWord(const FingerView& finger);

/// What keeps a finger's touches from being shown, or makes them doubtful, besides what it says itself:
/// "silent for 2.3 s", "speaks protocol 3, this program 2: use the strainfinger of its firmware".
std::vector<std::string> troublesOf(const FingerView& finger);

/// What is to be known of a finger besides its numbers: troublesOf() it, "faults: gauges, noisy", "gauges out
/// of use: 5, 7"; joined by "; ", "" for nothing.
std::string warningsText(const FingerView& finger);

/// Flags of its touch but for "contact", which the screen shows: "uncertain, simulated".
std::string flagsText(const FingerView& finger);

/// A line for people and for logs: "12.300 s  can0 node 1  run  angle 57.21 ± 0.01 deg  ..".
std::string plainLine(const BusView& bus, const FingerView& finger);

}  // namespace strainfinger::live
