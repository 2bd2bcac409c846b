#pragma once
// How every row about a frame begins: when, on which interface, of which node.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "host/base/table_writer.hpp"

namespace strainfinger::can {

class RowStart {
 public:
  explicit RowStart(TableFormat format) : format_(format) {}

  static constexpr std::string_view kColumns = "time_s,interface,node";

  /// CSV: the values of kColumns. JSON: an object that is still open, with these members. A time has the
  /// digits of its log; one that is not known is an empty field or null.
  void append(std::string& out, std::optional<std::int64_t> time_ns, std::string_view interface, int node);

 private:
  TableFormat format_;
  std::string interface_;
  std::string interfaceText_;  ///< as a field of the row
};

/// Closes the row that append() began.
inline void endRow(std::string& out, TableFormat format) {
  out.append(format == TableFormat::kJson ? "}\n" : "\n");
}

}  // namespace strainfinger::can
