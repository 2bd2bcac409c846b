#include "host/can/frame_printer.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace strainfinger::can {
namespace {

/// RAW has readers of its own: a row a page would say nothing.
bool isPrinted(const FrameEntry& entry) { return entry.spec.function != FunctionCode::kRaw; }

std::vector<std::string> columnNames() {
  std::vector<std::string> all;
  for (const auto& catalogue : {frameCatalogue(), commandCatalogue()})
    for (const FrameEntry& entry : catalogue)
      for (const FieldSpec& field : entry.fields) {
        const std::string name = columnName(field.meaning);
        if (isPrinted(entry) && isShown(field) && std::ranges::find(all, name) == all.end())
          all.push_back(name);
      }
  return all;
}

/// Of fields of a byte at most, which are in most frames.
std::vector<std::string> valueTexts(const FieldSpec& field) {
  std::vector<std::string> texts;
  if (field.meaning.kind == FieldKind::kNumber || field.bits.width > 8) return texts;
  for (int raw = 0; raw < 1 << field.bits.width; ++raw) texts.push_back(valueText(field, raw));
  return texts;
}

}  // namespace

FramePrinter::FramePrinter(std::string& out, TableFormat format)
    : out_(out), format_(format), start_(format) {
  const std::vector<std::string> names = columnNames();
  columns_ = names.size();
  for (const FrameEntry& entry : frameCatalogue()) rows_.push_back(rowOf(entry, names));
  for (const FrameEntry& entry : commandCatalogue()) commands_.push_back(rowOf(entry, names));
  if (format == TableFormat::kCsv)
    out.append(RowStart::kColumns).append(fmt::format(",frame,{}\n", fmt::join(names, ",")));
}

FramePrinter::Row FramePrinter::rowOf(const FrameEntry& entry, const std::vector<std::string>& names) const {
  Row row{&entry, entry.spec.name, {}};
  for (const FieldSpec& field : entry.fields) {
    if (!isShown(field)) continue;
    const std::string name = columnName(field.meaning);
    const auto number = static_cast<std::size_t>(std::ranges::find(names, name) - names.begin());
    row.columns.push_back({&field, number, decimalScale(field.meaning.stepsPerUnit).value(),
                           fmt::format(",\"{}\":", name), valueTexts(field)});
  }
  if (format_ == TableFormat::kCsv) std::ranges::sort(row.columns, {}, &Column::number);
  return row;
}

const FramePrinter::Row* FramePrinter::findRow(const CanFrame& frame) const {
  if (const FrameEntry* const entry = findFrame(frame))
    return &rows_[static_cast<std::size_t>(entry - frameCatalogue().data())];
  if (const FrameEntry* const entry = findCommand(frame))
    return &commands_[static_cast<std::size_t>(entry - commandCatalogue().data())];
  return nullptr;
}

bool FramePrinter::print(std::optional<std::int64_t> time_ns, std::string_view interface,
                         const CanFrame& frame) {
  const Row* const row = findRow(frame);
  if (row == nullptr) return false;
  const FrameSpec& spec = row->entry->spec;
  start_.append(out_, time_ns, interface, *nodeOf(frame.id, spec.function));
  const int bits = sentBits(frame, *row->entry);
  const std::uint64_t word = sentWord(frame, *row->entry);
  if (format_ == TableFormat::kCsv)
    appendCsv(*row, word, bits);
  else
    appendJson(*row, word, bits);
  endRow(out_, format_);
  return true;
}

void FramePrinter::appendCsv(const Row& row, std::uint64_t word, int bits) {
  out_.append(",").append(row.name);
  std::size_t written = 0;
  for (const Column& column : row.columns) {
    out_.append(column.number + 1 - written, ',');
    written = column.number + 1;
    const std::int64_t raw = extractRaw(column.field->bits, word);
    if (isKnown(*column.field, raw, bits)) appendValue(column, raw);
  }
  out_.append(columns_ - written, ',');
}

void FramePrinter::appendJson(const Row& row, std::uint64_t word, int bits) {
  out_.append(",\"frame\":\"").append(row.name).append("\"");
  for (const Column& column : row.columns) {
    out_.append(column.key);
    const std::int64_t raw = extractRaw(column.field->bits, word);
    if (isKnown(*column.field, raw, bits))
      appendValue(column, raw);
    else
      out_.append("null");
  }
}

/// JSON shows what is text, and which numbers could have a fraction.
void FramePrinter::appendValue(const Column& column, std::int64_t raw) {
  const FieldMeaning& meaning = column.field->meaning;
  const bool json = format_ == TableFormat::kJson;
  if (meaning.kind == FieldKind::kNumber) {
    const bool pointed = json && meaning.stepsPerUnit != 1;
    appendDecimal(out_, raw * meaning.unitsPerStep, column.scale,
                  pointed ? WholeNumber::kWithPoint : WholeNumber::kPlain);
    return;
  }
  if (json) out_.push_back('"');
  if (column.texts.empty())
    out_.append(valueText(*column.field, raw));
  else
    out_.append(column.texts[static_cast<std::size_t>(raw)]);
  if (json) out_.push_back('"');
}

}  // namespace strainfinger::can
