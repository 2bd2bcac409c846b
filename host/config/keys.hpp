#pragma once
// The keys of finger.toml: one table, from which reading, messages and the documented file all come.

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "host/config/domain.hpp"
#include "host/config/finger_config.hpp"

namespace strainfinger::config {

inline constexpr int kSchema = 1;

/// The names of StrainComponent, in the order of its numbers.
inline constexpr std::array<std::string_view, 3> kComponentNames{"radial", "hoop", "shear"};

constexpr std::string_view componentName(StrainComponent component) {
  return kComponentNames[static_cast<std::size_t>(component)];
}

/// Where a key's value lives in a FingerConfig; its type is the key's type.
using Slot =
    std::variant<double& (*)(FingerConfig&), int& (*)(FingerConfig&), StrainComponent& (*)(FingerConfig&),
                 std::vector<double>& (*)(FingerConfig&), std::optional<double>& (*)(FingerConfig&)>;

struct Key {
  std::string_view section;
  std::string_view name;
  Slot slot;
  Domain domain;               ///< of the number; for a component, of its number; of each number of a list
  std::string_view doc;        ///< one line, with the unit if the name has none
  std::string dotted() const;  ///< "section.name"
};

/// All keys; those of a section follow each other, in the order a file lists them.
std::span<const Key> keys();
/// Domain: "section.name" of one of them.
const Key& keyOf(std::string_view dotted);

/// A condition between keys. Its text names them all.
struct Relation {
  std::function<bool(const FingerConfig&)> holds;
  /// Dotted, the one complained of first; a message points at the first that the file has.
  std::vector<std::string> keys;
  std::function<std::string(const FingerConfig&)> violation;  ///< names, values, and what would be right
};

/// In the order of checking: one may rely on those before it.
std::span<const Relation> relations();

}  // namespace strainfinger::config
