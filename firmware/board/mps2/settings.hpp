#pragma once
// What an emulated finger is: shared with who wants to know what it will say.

#include "firmware/app/finger.hpp"

namespace strainfinger::mps2 {

inline constexpr firmware::FingerSettings kSettings{
    .standingFlags = {FingerFlag::kUncalibrated, FingerFlag::kSimulated}};

}  // namespace strainfinger::mps2
