#pragma once
// A view as JSON: what `serve` sends to browsers and `monitor --json` prints. README.md says what is in it.

#include <nlohmann/json.hpp>

#include "host/config/finger_config.hpp"
#include "host/live/finger_view.hpp"

namespace strainfinger::live {

/// SI units, named in the keys; null where a value is not known.
nlohmann::ordered_json toJson(const BusView& bus);

/// What of the finger a picture needs: radii, and where its gauges are.
nlohmann::ordered_json toJson(const config::FingerConfig& config);

}  // namespace strainfinger::live
