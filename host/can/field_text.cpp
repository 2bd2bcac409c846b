#include "host/can/field_text.hpp"

#include <string_view>

#include "common/commands.hpp"
#include "host/base/text_parts.hpp"
#include "host/can/decimal_text.hpp"

namespace strainfinger::can {

std::string columnName(const FieldMeaning& meaning) {
  std::string name = meaning.name;
  if (*meaning.unit != '\0') name.append("_").append(meaning.unit);
  return lowerCase(name);
}

std::string valueText(const FieldSpec& field, std::int64_t raw) {
  const auto& names = field.meaning.names;
  const bool areFlags = field.meaning.kind == FieldKind::kFlags;
  return areFlags ? flagsText(names, static_cast<std::uint32_t>(raw)) : nameText(names, raw);
}

bool isShown(const FieldSpec& field) {
  const std::string_view name = field.meaning.name;
  return name != kLengthMeaning.name && name != kAnswerMeaning.name;
}

int sentBits(const CanFrame& frame, const FrameEntry& entry) {
  const bool counts = std::string_view(entry.fields.front().meaning.name) == kLengthMeaning.name;
  return 8 * (counts ? 1 + frame.data[0] : frame.length);
}

std::uint64_t sentWord(const CanFrame& frame, const FrameEntry& entry) {
  return toWord(frame) & ~std::uint64_t{0} >> (64 - sentBits(frame, entry));
}

bool isKnown(const FieldSpec& field, std::int64_t raw, int sentBits) {
  return field.bits.lsb < sentBits &&
         (field.meaning.kind != FieldKind::kNumber || isValidRaw(field.bits, raw));
}

bool isOrMore(const FieldSpec& field, std::int64_t raw) {
  return field.meaning.openEnded &&
         (raw == maxRaw(field.bits) || (field.bits.isSigned && raw == minRaw(field.bits)));
}

std::vector<FieldValue> fieldValues(const FrameEntry& entry, const CanFrame& frame) {
  const int bits = sentBits(frame, entry);
  const std::uint64_t word = sentWord(frame, entry);
  std::vector<FieldValue> values;
  for (const FieldSpec& field : entry.fields) {
    if (!isShown(field)) continue;
    const std::int64_t raw = extractRaw(field.bits, word);
    const bool known = isKnown(field, raw, bits);
    values.push_back({&field, raw, known, known && isOrMore(field, raw)});
  }
  return values;
}

std::string textOf(const FieldValue& value) {
  const FieldMeaning& meaning = value.field->meaning;
  if (!value.isKnown) return "?";
  if (meaning.kind == FieldKind::kFlags && value.raw == 0) return "none";
  if (meaning.kind != FieldKind::kNumber) return valueText(*value.field, value.raw);
  std::string text = !value.isOrMore ? "" : value.raw < 0 ? "<=" : ">=";
  appendDecimal(text, value.raw * meaning.unitsPerStep, decimalScale(meaning.stepsPerUnit).value());
  return text;
}

}  // namespace strainfinger::can
