#include "host/config/write_config.hpp"

#include <fmt/format.h>

#include <optional>
#include <variant>

#include "host/config/keys.hpp"

namespace strainfinger::config {
namespace {

std::string valueText(double value) { return fmt::format("{}", value); }
std::string valueText(int value) { return fmt::format("{}", value); }
std::string valueText(const std::vector<double>& values) {
  return fmt::format("[{}]", fmt::join(values, ", "));
}
std::string valueText(StrainComponent value) { return fmt::format("\"{}\"", componentName(value)); }

/// "key = value", or a comment for a value that is left out.
template <typename Value>
std::string lineOf(const Key& key, const Value& value) {
  return fmt::format("{} = {}", key.name, valueText(value));
}
std::string lineOf(const Key& key, const std::optional<double>& value) {
  return value ? lineOf(key, *value) : fmt::format("# {} is left out", key.name);
}

std::string domainText(const Key& key) {
  if (std::holds_alternative<StrainComponent& (*)(FingerConfig&)>(key.slot))
    return fmt::format("one of {}", fmt::join(kComponentNames, ", "));
  if (std::holds_alternative<std::vector<double>& (*)(FingerConfig&)>(key.slot))
    return fmt::format("each {}", key.domain.text());
  return key.domain.text();
}

}  // namespace

std::string writeConfig(const FingerConfig& config) {
  FingerConfig copy = config;
  std::string text = fmt::format("schema = {}\n", kSchema);
  std::string_view section;
  for (const Key& key : keys()) {
    if (key.section != section) text += fmt::format("\n[{}]\n", section = key.section);
    const auto line = std::visit([&](auto slot) { return lineOf(key, slot(copy)); }, key.slot);
    text += fmt::format("# {} [{}]\n{}\n", key.doc, domainText(key), line);
  }
  return text;
}

}  // namespace strainfinger::config
