#pragma once
// The flash image of a finger's lookup tables.

#include "common/table_image.hpp"
#include "host/config/finger_config.hpp"

namespace strainfinger::tables {

/// The parameters an image of this finger carries.
TableParameters tableParameters(const config::FingerConfig& config);

/// Builds the image from the elastic model. Throws Failure(kUsage) when the finger cannot be located with:
/// the message says why. Cost: milliseconds, nearly all of it the impulse response.
TableImage buildTableImage(const config::FingerConfig& config);

}  // namespace strainfinger::tables
