#include "host/can/frame_printer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "host/base/no_value.hpp"

namespace strainfinger::can {
namespace {

std::string nameOrNumber(const FieldMeaning& meaning, std::int64_t value) {
  const ValueName* name = findName(meaning.names, value);
  return name != nullptr ? name->name : fmt::format("{}", value);
}

std::string flagNames(const FieldSpec& field, std::int64_t raw) {
  std::string text;
  for (int bit = 0; bit < field.bits.width; ++bit) {
    if ((raw >> bit & 1) == 0) continue;
    if (!text.empty()) text.push_back('+');
    text += nameOrNumber(field.meaning, bit);
  }
  return text;
}

/// The shortest text that reads back as `value`: 35.73, where 17 digits would say 35.729999999999997.
Cell decimal(double value) { return fmt::format("{}", value); }

Cell fieldCell(const FieldSpec& field, std::int64_t raw, bool csv) {
  if (field.meaning.kind != FieldKind::kNumber) return valueText(field, raw);
  const std::optional<double> value = toPhysical(field, raw);
  if (!value) return kNoValue;
  if (field.meaning.stepsPerUnit == 1) return raw * field.meaning.unitsPerStep;
  return csv ? decimal(*value) : Cell(*value);
}

Cell timeCell(std::optional<std::int64_t> time_ns, bool csv) {
  if (!time_ns) return kNoValue;
  constexpr std::int64_t kSecond = 1'000'000'000;
  if (!csv) return static_cast<double>(*time_ns) / kSecond;
  if (*time_ns % 1000 == 0) return fmt::format("{}.{:06}", *time_ns / kSecond, *time_ns % kSecond / 1000);
  return fmt::format("{}.{:09}", *time_ns / kSecond, *time_ns % kSecond);
}

std::vector<std::string> leadingColumns() { return {"time_s", "interface", "node", "frame"}; }

std::vector<std::string> columnsOf(const FrameEntry& entry) {
  std::vector<std::string> columns = leadingColumns();
  for (const FieldSpec& field : entry.fields) columns.push_back(columnName(field.meaning));
  return columns;
}

std::vector<std::string> columnsOfAll() {
  std::vector<std::string> all = leadingColumns();
  for (const FrameEntry& entry : frameCatalogue())
    for (const std::string& column : columnsOf(entry))
      if (std::find(all.begin(), all.end(), column) == all.end()) all.push_back(column);
  return all;
}

}  // namespace

std::string columnName(const FieldMeaning& meaning) {
  std::string name = meaning.name;
  if (*meaning.unit != '\0') name.append("_").append(meaning.unit);
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return name;
}

std::string valueText(const FieldSpec& field, std::int64_t raw) {
  return field.meaning.kind == FieldKind::kFlags ? flagNames(field, raw) : nameOrNumber(field.meaning, raw);
}

FramePrinter::FramePrinter(std::FILE* stream, TableFormat format) : stream_(stream) {
  if (format == TableFormat::kJson) return;
  columns_ = columnsOfAll();
  csv_.emplace(stream, format, columns_);
}

bool FramePrinter::print(std::optional<std::int64_t> time_ns, std::string_view interface,
                         const CanFrame& frame) {
  const FrameEntry* entry = findFrame(frame);
  if (entry == nullptr) return false;
  const bool csv = csv_.has_value();
  std::vector<Cell> cells{timeCell(time_ns, csv), std::string(interface),
                          std::int64_t{*nodeOf(frame.id, entry->spec.function)},
                          std::string(entry->spec.name)};
  for (const FieldSpec& field : entry->fields)
    cells.push_back(fieldCell(field, extractRaw(field.bits, toWord(frame)), csv));
  if (csv)
    printCsv(columnsOf(*entry), cells);
  else
    TableWriter(stream_, TableFormat::kJson, columnsOf(*entry)).row(cells);
  return true;
}

void FramePrinter::printCsv(const std::vector<std::string>& names, const std::vector<Cell>& cells) {
  std::vector<Cell> row(columns_.size(), kNoValue);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto column = std::find(columns_.begin(), columns_.end(), names[i]);
    row[static_cast<std::size_t>(column - columns_.begin())] = cells[i];
  }
  csv_->row(row);
}

}  // namespace strainfinger::can
