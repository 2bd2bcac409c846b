#pragma once
// For timing and counting.

namespace strainfinger::bench {

/// Has the compiler believe that somebody looks at `result`.
template <typename Result>
[[gnu::always_inline]] inline void keep(const Result& result) {
  asm volatile("" : : "r"(&result) : "memory");
}

}  // namespace strainfinger::bench
