#pragma once
// Can the firmware's locator work with these tables? Its own code is asked, before anyone relies on them.

#include <optional>

#include "common/table_image.hpp"
#include "firmware/core/locate.hpp"
#include "host/config/finger_config.hpp"

namespace strainfinger::tables {

/// A noise-free line contact that the firmware puts in a wrong place.
struct Misplaced {
  firmware::FitMode mode;
  double load_n_per_m;  ///< normal
  double direction;     ///< tangential / normal load
  double offset_pitch;  ///< from the nearest gauge towards +theta, -1/2 .. 1/2
  double error_pitch;   ///< found - true
};

/// What became of noise-free contacts over one pitch: load directions within the friction cone, loads from
/// half of full scale down to 1/32, both modes.
struct SelfCheck {
  int contacts = 0;                    ///< that opened the gate
  int uncertain = 0;                   ///< flagged so by the firmware
  std::optional<Misplaced> misplaced;  ///< the worst answer on a wrong branch that was given as certain
  double halfScale_n_per_m = 0;        ///< normal load whose largest strain is half of full scale
  double detected_n_per_m = 0;         ///< from this normal load on a contact opens the gate wherever it is
};

/// Runs firmware::locate() on every contact. A wrong branch is more than 1/8 of a pitch off. The grid meets
/// any ambiguity wider than 1/48 of a pitch in offset and 1/8 of the friction coefficient in direction;
/// narrower ones it may miss. Cost: 5000 fits; 5 ms for the default finger, ten times that where every window
/// is looked at.
SelfCheck selfCheck(const TableImage& image);

/// Throws Failure(kUsage) with the reason, the finger's figures and what to change: where a contact is
/// misplaced, where more than half of them are uncertain, and where one at half of full scale may go
/// unnoticed.
void requireLocatable(const TableImage& image, const SelfCheck& check);

struct CheckedTables {
  TableImage image;
  SelfCheck check;
};

/// buildTableImage(), checked. Where a quick way to find the nearest gauge, a start that is told or a scan,
/// misplaces a contact, the image has the firmware look at every window; where that doesn't help either,
/// throws as requireLocatable() does.
CheckedTables buildCheckedTables(const config::FingerConfig& config);

}  // namespace strainfinger::tables
