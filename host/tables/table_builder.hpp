#pragma once
// The flash image of a finger's lookup tables.

#include "common/table_image.hpp"
#include "host/config/finger_config.hpp"

namespace strainfinger::tables {

/// The parameters an image of this finger carries.
TableParameters tableParameters(const config::FingerConfig& config);

/// Builds the image from the elastic model. Throws Failure(kUsage) with the reason where the model has no
/// answer (see ImpulseResponse), where readings or loads don't fit the firmware's formats, and where three
/// gauges never suffice. Whether contacts can be told apart is for buildCheckedTables() (self_check.hpp) to
/// say. Cost: below a millisecond for the default finger, in proportion to the harmonics its depth needs.
TableImage buildTableImage(const config::FingerConfig& config);

/// Has the firmware look at every window, twice as finely: several times as dear, for responses whose
/// strongest gauge is not the nearest one.
void searchEverywhere(TableImage& image);

}  // namespace strainfinger::tables
