#pragma once
// The harmonics of loads that are spread over a contact.

#include <Eigen/Core>

namespace strainfinger::model {

/// Harmonics n = 0, 1, .. about the contact's centre [N/m]: what each of them would be of a line load of that
/// strength. Of loads that are even about the centre.
struct LoadSpectrum {
  Eigen::VectorXd normal;      ///< positive: pressing
  Eigen::VectorXd tangential;  ///< positive: towards +theta
};

}  // namespace strainfinger::model
