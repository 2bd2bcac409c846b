#include "host/cli/field_row.hpp"

#include "host/base/no_value.hpp"

namespace strainfinger::cli {
namespace {

Cell valueCell(const can::FieldValue& value) {
  const FieldMeaning& meaning = value.field->meaning;
  if (!value.isKnown) return kNoValue;
  if (meaning.kind != FieldKind::kNumber) return can::textOf(value);
  if (meaning.stepsPerUnit == 1) return value.raw * meaning.unitsPerStep;
  return *can::toPhysical(*value.field, value.raw);
}

}  // namespace

std::vector<Cell> fieldRow(const can::FieldValue& value) {
  const FieldMeaning& meaning = value.field->meaning;
  const char* const direction = value.raw < 0 ? "; this value or less" : "; this value or more";
  const std::string orMore = value.isOrMore ? direction : "";
  return {can::columnName(meaning), valueCell(value), meaning.comment + orMore};
}

}  // namespace strainfinger::cli
