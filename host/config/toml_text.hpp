#pragma once
// What all our TOML files share: values by type, and errors that point into the text.
// Every function throws Failure(kUsage) with file:line:column, what is wrong and what would be right.

#include <toml++/toml.h>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "host/config/domain.hpp"

namespace strainfinger::config {

/// Parses; `name` stands for the file in messages, here and in all that follows from the result.
toml::table parseToml(std::string_view text, const std::string& name);

/// Ends with "file:line:column: message".
[[noreturn]] void failAt(const toml::source_region& where, std::string_view message);

/// Demands `schema = version` at the root.
void checkSchema(const toml::table& root, std::int64_t version);

/// The candidate that `word` was probably meant to be, or an empty string. Candidates may be dotted
/// ("gauges.count"); the right name in the wrong section is recognised.
std::string nearestTo(std::string_view word, std::span<const std::string> candidates);

/// Demands that every key of `table` is among `known`. `prefix` ("gauges.") stands before it in messages, and
/// `suggestions` are what an unknown one may have been meant to be, all dotted.
void checkKeys(const toml::table& table, std::string_view prefix, std::span<const std::string> known,
               std::span<const std::string> suggestions);

/// The value of a key, of its type and in its domain. An integer is a real number too, not the reverse.
double realIn(const toml::node& node, std::string_view key, const Domain& domain);
std::vector<double> realsIn(const toml::node& node, std::string_view key, const Domain& domain);  ///< a list
std::int64_t integerIn(const toml::node& node, std::string_view key, const Domain& domain);
std::string textOf(const toml::node& node, std::string_view key);
const toml::table& sectionOf(const toml::node& node, std::string_view key);

}  // namespace strainfinger::config
