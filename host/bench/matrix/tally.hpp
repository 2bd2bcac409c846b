#pragma once
// How touches under a disturbance ended.

namespace strainfinger::bench {

/// Numbers of touches, each looked at in its last sample set; an untouched time of a row without touches
/// counts as one. "Flagged": the finger says that the place is uncertain, or that there is more than the one
/// contact that it tells.
struct Tally {
  int touches = 0;
  int silent = 0;  ///< a contact is told more than half a pitch from every true one, and not flagged
  int beyond = 0;  ///< place, normal or tangential load off by more than six reported sigmas, not flagged
  int flagged = 0;
  int blamed = 0;   ///< a healthy gauge is out of use
  int missed = 0;   ///< nothing is told
  int located = 0;  ///< every contact is told within half a pitch, none besides, and not flagged
  int ghosts = 0;   ///< a contact was told in the untouched time before
};

}  // namespace strainfinger::bench
