#pragma once
// Frames as rows of a table: what `strainfinger decode` prints.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/can_frame.hpp"
#include "host/base/table_writer.hpp"
#include "host/can/decimal_text.hpp"
#include "host/can/field_text.hpp"
#include "host/can/frame_catalogue.hpp"
#include "host/can/row_start.hpp"

namespace strainfinger::can {

/// Prints the frames of fingers, and requests to them. As CSV one table: time_s,interface,node,frame, then a
/// column for each field of any frame, empty where the frame has no such field or the value is not known. As
/// JSON one object a frame with the frame's own fields, null where the value is not known. Numbers have the
/// digits that are on the bus.
class FramePrinter {
 public:
  /// Appends to `out`: at once the header, if the format has one.
  FramePrinter(std::string& out, TableFormat format);

  /// Appends a row; false, and nothing is appended, if the frame is none of a finger's.
  bool print(std::optional<std::int64_t> time_ns, std::string_view interface, const CanFrame& frame);

 private:
  struct Column {
    const FieldSpec* field;
    std::size_t number;  ///< in the CSV table
    DecimalScale scale;
    std::string key;                 ///< in the JSON object
    std::vector<std::string> texts;  ///< of each raw value of choices and flags, if they are few
  };
  struct Row {
    const FrameEntry* entry;
    std::string name;
    std::vector<Column> columns;  ///< JSON: in the order of the frame's bits; CSV: of the table
  };
  Row rowOf(const FrameEntry& entry, const std::vector<std::string>& names) const;
  const Row* findRow(const CanFrame& frame) const;
  void appendCsv(const Row& row, std::uint64_t word, int bits);
  void appendJson(const Row& row, std::uint64_t word, int bits);
  void appendValue(const Column& column, std::int64_t raw);

  std::string& out_;
  TableFormat format_;
  RowStart start_;
  std::size_t columns_ = 0;    ///< of the CSV table
  std::vector<Row> rows_;      ///< in the order of frameCatalogue()
  std::vector<Row> commands_;  ///< in the order of commandCatalogue()
};

}  // namespace strainfinger::can
