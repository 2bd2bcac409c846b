#pragma once
// Rows of named values to a stream: CSV with a header row, or one JSON object a line.

#include <cstdint>
#include <cstdio>
#include <initializer_list>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace strainfinger {

enum class TableFormat { kCsv, kJson };

/// A value of a table. A NaN is an empty CSV field and a JSON null: "not known". A list is one CSV field, as
/// finger.toml writes it, and a JSON array.
using Cell = std::variant<double, std::int64_t, std::string, std::vector<double>>;

/// A value and the column that it is in, of a row that is long or put together from parts.
struct NamedCell {
  std::string column;
  Cell value;
};
using NamedRow = std::vector<NamedCell>;
std::vector<std::string> columnsOf(const NamedRow& row);
std::vector<Cell> valuesOf(const NamedRow& row);

/// A text as a CSV field: quoted where it has to be.
std::string csvField(const std::string& text);

/// A text as a JSON string; what is no UTF-8 becomes U+FFFD.
std::string jsonString(const std::string& text);

/// Writes the header at once and a row a call. Real numbers have as many digits as they need to be read back
/// exactly. Throws Failure(kFailure) when the stream refuses (disk full, closed pipe).
class TableWriter {
 public:
  TableWriter(std::FILE* stream, TableFormat format, std::vector<std::string> columns);
  void row(const std::vector<Cell>& cells);  ///< one cell a column
  /// Hands the rows over now: whoever reads along has them, and a killed program leaves whole ones.
  void flush();

 private:
  void write(std::string_view text);
  std::FILE* stream_;
  TableFormat format_;
  std::vector<std::string> columns_;
};

}  // namespace strainfinger
