#pragma once
// Every name on the bus: of frames, fields and their values. Made from the frames' tables and remedies.hpp.

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace strainfinger::can {

struct Term {
  std::string name;     ///< "CONTACT", "angle_deg", "uncertain"
  std::string kind;     ///< what it is, and where it is found: "bit 3 of flags in CONTACT, FORCE"
  std::string meaning;  ///< one sentence, without a full stop
  std::string remedy;   ///< what to do about it; empty: nothing
  std::string alias{};  ///< another name: of a field, that without its unit
};

/// Frames first, then fields, then their values, in the order of the frames' tables.
std::span<const Term> glossary();

/// Those of this name, whatever its case, with spaces or dashes for underscores; none if it is no name.
std::vector<Term> termsNamed(std::string_view word);

/// Up to three names that are nearest to a word that is none, at most three letters off.
std::vector<std::string> namesLike(std::string_view word);

}  // namespace strainfinger::can
