#pragma once
// A field of a frame as cells of a table.

#include <string>
#include <vector>

#include "host/base/table_writer.hpp"
#include "host/can/field_text.hpp"

namespace strainfinger::cli {

/// A number as one, choices and flags by name ("none" where no flag is set), empty where it is not known.
inline const std::vector<std::string> kFieldColumns{"field", "value", "meaning"};
std::vector<Cell> fieldRow(const can::FieldValue& value);

}  // namespace strainfinger::cli
