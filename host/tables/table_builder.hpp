#pragma once
// The flash image of a finger's lookup tables.

#include "common/table_image.hpp"
#include "host/config/finger_config.hpp"

namespace strainfinger::tables {

/// Builds the image from the elastic model. Throws Failure(kUsage) with the reason where the model has no
/// answer (see ImpulseResponse), where readings, loads or widths don't fit the firmware's formats, and where
/// patches are too coarse for a response as narrow as this finger's. Whether contacts can be told apart is
/// for buildCheckedTables() (self_check.hpp) to say. Cost: that of responseTable().
TableImage buildTableImage(const config::FingerConfig& config);

}  // namespace strainfinger::tables
