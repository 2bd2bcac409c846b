#include "host/config/toml_text.hpp"

#include <algorithm>
#include <memory>

#include <fmt/format.h>

#include "host/base/edit_distance.hpp"
#include "host/base/excerpt.hpp"
#include "host/base/failure.hpp"

namespace strainfinger::config {
namespace {

/// The parser calls itself for each part of a key, and with values in values, of which it takes 256, the
/// stack would end at some 100.
constexpr int kMostDots = 64;

std::string_view typeName(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::table:
      return "a section";
    case toml::node_type::array:
      return "a list";
    case toml::node_type::string:
      return "a text";
    case toml::node_type::integer:
      return "an integer";
    case toml::node_type::floating_point:
      return "a real number";
    case toml::node_type::boolean:
      return "a boolean";
    default:
      return "a date or time";
  }
}

[[noreturn]] void failType(const toml::node& node, std::string_view key, std::string_view wanted) {
  failAt(node.source(), fmt::format("{} is {}; it must be {}", key, typeName(node), wanted));
}

template <typename Number>
Number checked(Number value, const toml::node& node, std::string_view key, const Domain& domain) {
  if (domain.contains(static_cast<double>(value))) return value;
  failAt(node.source(),
         fmt::format("{} = {} is out of its domain; it must be {}", key, value, domain.text()));
}

std::string_view lastPart(std::string_view dotted) { return dotted.substr(dotted.rfind('.') + 1); }

/// Distance of the names; a different section costs as much as one letter.
std::size_t distance(std::string_view word, std::string_view candidate) {
  const auto wordName = lastPart(word), name = lastPart(candidate);
  const bool sameSection =
      word.substr(0, word.size() - wordName.size()) == candidate.substr(0, candidate.size() - name.size());
  return editDistance(wordName, name) + (sameSection ? 0 : 1);
}

/// The first column [from 1] at which a line has too many dots for any key, or 0. Commas keep the numbers of
/// a list apart, but not behind a quotation mark, where one may be part of a key's name.
std::size_t columnOfTooManyDots(std::string_view line) {
  bool hasQuotes = false;
  int dots = 0;
  for (std::size_t i = 0; i < line.size() && (hasQuotes || line[i] != '#'); ++i) {
    hasQuotes |= line[i] == '"' || line[i] == '\'';
    if (line[i] == ',' && !hasQuotes) dots = 0;
    if (line[i] == '.' && ++dots > kMostDots) return i + 1;
  }
  return 0;
}

/// Before parsing: such a text would end the program.
void requireShortKeys(std::string_view text, const std::string& name) {
  toml::source_index number = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    ++number;
    if (const std::size_t column = columnOfTooManyDots(text.substr(begin, end - begin))) {
      const toml::source_position at{number, static_cast<toml::source_index>(column)};
      failAt({at, at, std::make_shared<const std::string>(name)},
             fmt::format("more than {} dots in one key or text; a key has one or none, as in gauges.count",
                         kMostDots));
    }
    begin = end + 1;
  }
}

}  // namespace

toml::table parseToml(std::string_view text, const std::string& name) {
  requireShortKeys(text, name);
  try {
    return toml::parse(text, name);
  } catch (const toml::parse_error& error) {
    failAt(error.source(), excerptWords(error.description()));
  }
}

void failAt(const toml::source_region& where, std::string_view message) {
  throw Failure(ExitCode::kUsage,
                fmt::format("{}:{}:{}: {}", *where.path, where.begin.line, where.begin.column, message));
}

void checkSchema(const toml::table& root, std::int64_t version) {
  const toml::node* node = root.get("schema");
  if (node == nullptr)
    failAt(root.source(), fmt::format("schema is missing; the file must begin with schema = {}", version));
  integerIn(*node, "schema", Domain::oneOf({static_cast<double>(version)}));
}

std::string nearestTo(std::string_view word, std::span<const std::string> candidates) {
  const auto nearer = [&](const auto& a, const auto& b) { return distance(word, a) < distance(word, b); };
  const auto best = std::min_element(candidates.begin(), candidates.end(), nearer);
  const std::size_t allowed = std::max<std::size_t>(2, lastPart(word).size() / 3);
  return best != candidates.end() && distance(word, *best) <= allowed ? *best : std::string();
}

void checkKeys(const toml::table& table, std::string_view prefix, std::span<const std::string> known,
               std::span<const std::string> suggestions) {
  for (const auto& [key, node] : table) {
    std::string dotted(prefix);
    dotted += key.str();
    if (std::find(known.begin(), known.end(), dotted) != known.end()) continue;
    const std::string nearest = nearestTo(dotted, suggestions);
    failAt(key.source(),
           nearest.empty()
               ? fmt::format("unknown key {}; known here: {}", excerpt(dotted), fmt::join(known, ", "))
               : fmt::format("unknown key {}; did you mean {}?", excerpt(dotted), nearest));
  }
}

double realIn(const toml::node& node, std::string_view key, const Domain& domain) {
  const auto value = node.value<double>();
  if (!node.is_number() || !value) failType(node, key, fmt::format("a real number: {}", domain.text()));
  return checked(*value, node, key, domain);
}

std::vector<double> realsIn(const toml::node& node, std::string_view key, const Domain& domain) {
  if (!node.is_array()) failType(node, key, fmt::format("a list of real numbers, each {}", domain.text()));
  std::vector<double> values;
  for (const toml::node& element : *node.as_array())
    values.push_back(realIn(element, fmt::format("{}[{}]", key, values.size()), domain));
  return values;
}

std::int64_t integerIn(const toml::node& node, std::string_view key, const Domain& domain) {
  if (!node.is_integer()) failType(node, key, fmt::format("an integer: {}", domain.text()));
  return checked(node.as_integer()->get(), node, key, domain);
}

std::string textOf(const toml::node& node, std::string_view key) {
  if (!node.is_string()) failType(node, key, "a text in quotes");
  return node.as_string()->get();
}

const toml::table& sectionOf(const toml::node& node, std::string_view key) {
  if (!node.is_table()) failType(node, key, fmt::format("a section: [{}]", key));
  return *node.as_table();
}

}  // namespace strainfinger::config
