#pragma once
// Contacts of the default finger (nu = 1/2 unless said), computed for this project before the solver was
// written: Chebyshev collocation by least squares with another treatment of the kernel (numpy), the surface
// under its tractions confirmed by the sum of 200,000 harmonics (Bessel coefficients) to 1e-14 m. Printed
// digits are exact.

#include <array>

namespace strainfinger::testing {

struct KnownFlat {
  double half_m, load_n_per_m, peak_pa;
};

inline constexpr std::array kKnownFlats{
    KnownFlat{0.05e-3, 0.0513340929, 653.605551},     KnownFlat{0.10e-3, 0.205399823, 1307.61257},
    KnownFlat{0.20e-3, 0.822666403, 2618.60354},      KnownFlat{0.50e-3, 5.19099040, 6609.15120},
    KnownFlat{1.00e-3, 21.4939181405, 13686.2526384}, KnownFlat{1.50e-3, 51.1203727, 21729.3918},
    KnownFlat{2.00e-3, 97.6769438, 31240.3054},       KnownFlat{3.00e-3, 261.802646, 56578.1980}};

/// Width of a flat contact under a load.
struct KnownWidth {
  double load_n_per_m, width_m;
};

inline constexpr std::array kKnownWidths{KnownWidth{1, 0.440925862e-3}, KnownWidth{10, 1.380704644e-3},
                                         KnownWidth{20, 1.932184257e-3}, KnownWidth{50, 2.969825218e-3},
                                         KnownWidth{100, 4.040770314e-3}};

/// Load of a flat contact 2 mm wide over Hertz's, pi E* a^2 / 4 r_b.
struct KnownFinger {
  double alpha, poissonRatio, overHertz;
};

inline constexpr std::array kKnownFingers{
    KnownFinger{0.5, 0.5, 1.008383},         KnownFinger{0.7, 0.5, 1.046547},
    KnownFinger{0.85, 0.5, 1.231429},        KnownFinger{0.93, 0.5, 2.044388},
    KnownFinger{0.97, 0.5, 5.815734},        KnownFinger{8.9 / 12.7, 0.3, 1.048010},
    KnownFinger{8.9 / 12.7, 0.45, 1.046612}, KnownFinger{8.9 / 12.7, 0.49, 1.046758}};

/// Full sliding towards +theta, flat, 2 mm.
struct KnownSliding {
  double poissonRatio, friction, load_n_per_m, depth_m, offset_m;
  double loadTolerance, offsetTolerance;  ///< relative; below nu = 1/2 they were known to so much only
};

inline constexpr std::array kKnownSliding{
    KnownSliding{0.5, 0.5, 21.4885228, 72.0468950e-6, 0.0621079e-3, 3e-9, 1e-6},
    KnownSliding{0.5, 1, 21.4723573, 72.0877689e-6, 0.124122e-3, 3e-9, 4e-6},
    KnownSliding{0.45, 1, 19.51562, 76.947e-6, 0.0631955e-3, 6e-6, 1e-5},
    KnownSliding{0.3, 1, 14.99755, 84.654e-6, -0.064070e-3, 6e-6, 1e-5},
    KnownSliding{0.45, 0.5, 19.53027, 77.024e-6, 0.0316243e-3, 6e-6, 1e-5}};

/// Load of a wedge, 2 mm, good to 1e-6.
struct KnownWedge {
  double half_angle_deg, load_n_per_m;
};

inline constexpr std::array kKnownWedges{KnownWedge{85, 51.90768}, KnownWedge{80, 82.79063},
                                         KnownWedge{60, 222.19872}};

}  // namespace strainfinger::testing
