#pragma once
// Can the firmware's locator work with these tables? Its own code is asked, before anyone relies on them.

#include <cstdint>
#include <optional>
#include <span>

#include "common/contact.hpp"
#include "common/table_image.hpp"
#include "firmware/core/locator.hpp"
#include "host/config/finger_config.hpp"

namespace strainfinger::tables {

/// What the firmware tells from one set of readings alone.
struct Located {
  Contact contact;
  bool isCertain = false;  ///< one contact, without a flag
};
Located locateAlone(const TableImage& image, std::span<const std::int32_t> readings_q32,
                    firmware::FitMode mode);

/// A noise-free contact that the firmware puts in a wrong place.
struct Misplaced {
  firmware::FitMode mode;
  double load_n_per_m;  ///< normal
  double direction;     ///< tangential / normal load
  double width_m;
  double offset_pitch;  ///< from the nearest gauge towards +theta, -1/2 .. 1/2
  double error_pitch;   ///< found - true
};

/// What became of noise-free contacts around one gauge: load directions within the friction cone, loads of
/// half of full scale and a fifth of that, a line and 3/8 of the largest width where the width is fitted,
/// and both modes where it is known.
struct SelfCheck {
  static constexpr double kWeakerLoad = 1.0 / 5;  ///< of half of full scale

  int contacts = 0;                    ///< that opened the gate
  int uncertain = 0;                   ///< flagged so by the firmware
  std::optional<Misplaced> misplaced;  ///< the worst wrong answer that was given as certain
  double halfScale_n_per_m = 0;        ///< normal load whose largest strain is half of full scale
  double detected_n_per_m = 0;         ///< from this normal load on a line contact opens the gate anywhere
};

/// Has the firmware locate every contact, each from nothing but its readings. Wrong is more than 1/8 of a
/// pitch off. The grid meets any ambiguity wider than 1/8 of a pitch in place and 1/2 of the friction
/// coefficient in direction, where the width is known half of that; narrower ones it may miss. Cost: 180
/// searches, 0.1 s for the default finger; where the width is known 612, 0.05 s.
SelfCheck selfCheck(const TableImage& image);

/// Throws Failure(kUsage) with the reason, the finger's figures and what to change: where a contact is
/// misplaced, where more than half of them are uncertain, and where one at half of full scale may go
/// unnoticed.
void requireLocatable(const TableImage& image, const SelfCheck& check);

struct CheckedTables {
  TableImage image;
  SelfCheck check;
};

/// buildTableImage(), checked. Throws as that and requireLocatable() do.
CheckedTables buildCheckedTables(const config::FingerConfig& config);

}  // namespace strainfinger::tables
