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
  const std::string orMore = value.isOrMore ? "; this value or more" : "";
  return {can::columnName(meaning), valueCell(value), meaning.comment + orMore};
}

}  // namespace strainfinger::cli
