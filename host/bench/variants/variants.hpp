#pragma once
// Every variant of the locator by its name.

#include "firmware/core/locate.hpp"
#include "host/bench/methods/sample.hpp"

namespace strainfinger::bench {

/// As in locate_into.hpp, in whichever namespace.
using LocateInto = void(void* fit, const void* tables, bool byThree, const std::int32_t* strains_q32);

}  // namespace strainfinger::bench

namespace strainfinger_rows64::bench {
strainfinger::bench::LocateInto locateInto;
}
namespace strainfinger_rows32::bench {
strainfinger::bench::LocateInto locateInto;
}
namespace strainfinger_rows16::bench {
strainfinger::bench::LocateInto locateInto;
}
namespace strainfinger_two_rows::bench {
strainfinger::bench::LocateInto locateInto;
}
namespace strainfinger_one_step::bench {
strainfinger::bench::LocateInto locateInto;
}

namespace strainfinger::bench {

struct Variant {
  const char* name;
  LocateInto* locateInto;
  bool byThree;

  firmware::Fit fitOf(const TableImage& tables, const Sample& sample) const {
    firmware::Fit fit;
    locateInto(&fit, &tables, byThree, sample.strain_q32.data());
    return fit;
  }
};

inline constexpr std::array<Variant, 7> kVariants{
    {{"ours: refined with 64 rows a pitch", strainfinger_rows64::bench::locateInto, false},
     {"ours: refined with 32 rows a pitch", strainfinger_rows32::bench::locateInto, false},
     {"ours: refined with 16 rows a pitch", strainfinger_rows16::bench::locateInto, false},
     {"ours: refined until a step of 2 rows", strainfinger_two_rows::bench::locateInto, false},
     {"ours: refined by one step", strainfinger_one_step::bench::locateInto, false},
     {"ours: three-point with 32 rows a pitch", strainfinger_rows32::bench::locateInto, true},
     {"ours: three-point with 16 rows a pitch", strainfinger_rows16::bench::locateInto, true}}};

}  // namespace strainfinger::bench
