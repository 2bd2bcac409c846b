#include "host/base/table_writer.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "host/base/text_output.hpp"

namespace strainfinger {
namespace {

std::string dump(const nlohmann::ordered_json& value) {
  return value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string csvText(const Cell& cell) {
  if (const auto* real = std::get_if<double>(&cell)) return std::isnan(*real) ? "" : fmt::format("{}", *real);
  if (const auto* integer = std::get_if<std::int64_t>(&cell)) return fmt::format("{}", *integer);
  if (const auto* list = std::get_if<std::vector<double>>(&cell))
    return csvField(fmt::format("[{}]", fmt::join(*list, ", ")));
  return csvField(std::get<std::string>(cell));
}

nlohmann::ordered_json jsonValue(const Cell& cell) {
  return std::visit([](const auto& value) -> nlohmann::ordered_json { return value; }, cell);
}

}  // namespace

std::vector<std::string> columnsOf(const NamedRow& row) {
  std::vector<std::string> columns;
  for (const NamedCell& cell : row) columns.push_back(cell.column);
  return columns;
}

std::vector<Cell> valuesOf(const NamedRow& row) {
  std::vector<Cell> values;
  for (const NamedCell& cell : row) values.push_back(cell.value);
  return values;
}

std::string csvField(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted.append(c == '"' ? 2 : 1, c);
  quoted.push_back('"');
  return quoted;
}

std::string jsonString(const std::string& text) { return dump(text); }

TableWriter::TableWriter(std::FILE* stream, TableFormat format, std::vector<std::string> columns)
    : stream_(stream), format_(format), columns_(std::move(columns)) {
  if (format_ != TableFormat::kCsv) return;
  std::vector<std::string> names;
  for (const std::string& column : columns_) names.push_back(csvField(column));
  write(fmt::format("{}\n", fmt::join(names, ",")));
}

void TableWriter::row(const std::vector<Cell>& cells) {
  if (cells.size() != columns_.size())
    throw std::logic_error(
        fmt::format("a row has {} cells, its table {} columns", cells.size(), columns_.size()));
  std::string line;
  if (format_ == TableFormat::kJson) {
    nlohmann::ordered_json object;
    for (std::size_t i = 0; i < cells.size(); ++i) object[columns_[i]] = jsonValue(cells[i]);
    line = dump(object);
  } else {
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (i > 0) line.push_back(',');
      line += csvText(cells[i]);
    }
  }
  line.push_back('\n');
  write(line);
}

void TableWriter::flush() { writeAndFlush(stream_, ""); }

void TableWriter::write(std::string_view text) { writeText(stream_, text); }

}  // namespace strainfinger
