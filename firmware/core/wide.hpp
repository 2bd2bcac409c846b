#pragma once
// Numbers of 64 bits, of which the proof that nothing overflows knows bounds (tests/firmware/ranges).

#include <cstdint>

namespace strainfinger::firmware {

using Wide = std::int64_t;

}  // namespace strainfinger::firmware
