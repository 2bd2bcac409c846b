#include "host/config/write_config.hpp"

#include <fmt/format.h>

#include <optional>
#include <variant>

namespace strainfinger::config {
namespace {

constexpr const char* kLeftOut = "left out";

std::string valueText(double value) { return fmt::format("{}", value); }
std::string valueText(int value) { return fmt::format("{}", value); }
std::string valueText(const std::vector<double>& values) {
  return fmt::format("[{}]", fmt::join(values, ", "));
}
std::string valueText(StrainComponent value) { return fmt::format("\"{}\"", componentName(value)); }
std::string valueText(const std::optional<double>& value) { return value ? valueText(*value) : kLeftOut; }

/// "key = value", or a comment for a value that is left out.
std::string lineOf(const Key& key, const FingerConfig& config) {
  const std::string value = valueText(key, config);
  return value == kLeftOut ? fmt::format("# {} is {}", key.name, value)
                           : fmt::format("{} = {}", key.name, value);
}

std::string domainText(const Key& key) {
  if (std::holds_alternative<StrainComponent& (*)(FingerConfig&)>(key.slot))
    return fmt::format("one of {}", fmt::join(kComponentNames, ", "));
  if (std::holds_alternative<std::vector<double>& (*)(FingerConfig&)>(key.slot))
    return fmt::format("each {}", key.domain.text());
  return key.domain.text();
}

}  // namespace

std::string valueText(const Key& key, const FingerConfig& config) {
  FingerConfig copy = config;  // a slot gives what may be written
  return std::visit([&](auto slot) { return valueText(slot(copy)); }, key.slot);
}

std::string writeConfig(const FingerConfig& config) {
  std::string text = fmt::format("schema = {}\n", kSchema);
  std::string_view section;
  for (const Key& key : keys()) {
    if (key.section != section) text += fmt::format("\n[{}]\n", section = key.section);
    text += fmt::format("# {} [{}]\n{}\n", key.doc, domainText(key), lineOf(key, config));
  }
  return text;
}

}  // namespace strainfinger::config
