#pragma once
// Frames as rows of a table: what `strainfinger decode` prints.

#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/can_frame.hpp"
#include "host/base/table_writer.hpp"
#include "host/can/frame_catalogue.hpp"

namespace strainfinger::can {

/// The column of a field: its name and its unit, "angle_deg".
std::string columnName(const FieldMeaning& meaning);

/// Choices and flags by name, joined by '+' ("contact+simulated"); a value or bit without a name by its
/// number.
std::string valueText(const FieldSpec& field, std::int64_t raw);

/// Prints the frames of fingers. As CSV one table: time_s,interface,node,frame, then a column for each field
/// of any frame, empty where the frame has no such field or the value is not known. As JSON one object a
/// frame with the frame's own fields, null where the value is not known. Numbers have the digits that are on
/// the bus.
class FramePrinter {
 public:
  FramePrinter(std::FILE* stream, TableFormat format);

  /// Prints a row; false, and prints nothing, if the frame is none of a finger's.
  bool print(std::optional<std::int64_t> time_ns, std::string_view interface, const CanFrame& frame);

 private:
  void printCsv(const std::vector<std::string>& names, const std::vector<Cell>& cells);

  std::FILE* stream_;
  std::vector<std::string> columns_;  ///< of the CSV table
  std::optional<TableWriter> csv_;    ///< absent: JSON
};

}  // namespace strainfinger::can
