#include "host/config/read_config.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <variant>
#include <vector>

#include "host/base/excerpt.hpp"
#include "host/base/read_file.hpp"
#include "host/config/keys.hpp"
#include "host/config/toml_text.hpp"

namespace strainfinger::config {
namespace {

const toml::node* find(const toml::table& root, std::string_view section, std::string_view name) {
  const toml::node* table = root.get(section);
  return table == nullptr ? nullptr : sectionOf(*table, section).get(name);
}

/// What `record` notes beside a config: not a finger's.
constexpr std::string_view kRecordingSection = "recording";

std::vector<std::string> dottedKeys(std::string_view section = {}) {
  std::vector<std::string> names;
  for (const Key& key : keys())
    if (section.empty() || key.section == section) names.push_back(key.dotted());
  return names;
}

std::vector<std::string> sections() {
  std::vector<std::string> names{"schema"};
  for (const Key& key : keys())
    if (names.back() != key.section) names.emplace_back(key.section);
  names.emplace_back(kRecordingSection);
  return names;
}

void checkAllKeys(const toml::table& root) {
  const auto top = sections(), all = dottedKeys();
  auto suggestions = top;
  suggestions.insert(suggestions.end(), all.begin(), all.end());
  checkKeys(root, "", top, suggestions);
  for (const auto& [name, node] : root) {
    if (name.str() == "schema" || name.str() == kRecordingSection) continue;
    const auto& section = sectionOf(node, name.str());
    checkKeys(section, fmt::format("{}.", name.str()), dottedKeys(name.str()), all);
  }
}

void readValue(const toml::node& node, const Key& key, double& value) {
  value = realIn(node, key.dotted(), key.domain);
}

void readValue(const toml::node& node, const Key& key, int& value) {
  value = static_cast<int>(integerIn(node, key.dotted(), key.domain));
}

void readValue(const toml::node& node, const Key& key, StrainComponent& value) {
  const std::string text = textOf(node, key.dotted());
  const auto name = std::find(kComponentNames.begin(), kComponentNames.end(), text);
  if (name == kComponentNames.end())
    failAt(node.source(), fmt::format("{} = \"{}\" is out of its domain; it must be one of {}", key.dotted(),
                                      excerpt(text), fmt::join(kComponentNames, ", ")));
  value = static_cast<StrainComponent>(name - kComponentNames.begin());
}

void readValue(const toml::node& node, const Key& key, std::vector<double>& value) {
  value = realsIn(node, key.dotted(), key.domain);
}

void readValue(const toml::node& node, const Key& key, std::optional<double>& value) {
  value = realIn(node, key.dotted(), key.domain);
}

/// What to add where the value complained of is a default, which nobody finds in the file.
std::string defaultOf(const Relation& relation, const toml::table& root) {
  if (root.at_path(relation.keys.front())) return {};
  return fmt::format(" ({} is not in the file, this is its default)", relation.keys.front());
}

/// Where a broken relation is reported: the defaults keep all of them, so the file has one of its keys.
const toml::source_region& placeOf(const Relation& relation, const toml::table& root) {
  for (const std::string& dotted : relation.keys)
    if (const auto view = root.at_path(dotted)) return view.node()->source();
  return root.source();
}

}  // namespace

FingerConfig readConfigFile(const std::string& path) {
  return readConfig(readFile(path, ExitCode::kUsage), path);
}

FingerConfig readConfig(std::string_view text, const std::string& name) {
  const toml::table root = parseToml(text, name);
  checkSchema(root, kSchema);
  checkAllKeys(root);
  FingerConfig config;
  config.source = name;
  for (const Key& key : keys())
    if (const toml::node* node = find(root, key.section, key.name))
      std::visit([&](auto slot) { readValue(*node, key, slot(config)); }, key.slot);
  for (const Relation& relation : relations())
    if (!relation.holds(config))
      failAt(placeOf(relation, root), relation.violation(config) + defaultOf(relation, root));
  return config;
}

}  // namespace strainfinger::config
