#pragma once
// The Cramer-Rao bound of contacts.

#include <array>
#include <initializer_list>
#include <span>
#include <vector>

#include "host/evidence/fit_model.hpp"

namespace strainfinger::evidence {

/// What a fit has to find out of each contact; what is not free is known.
class Unknowns {
 public:
  constexpr Unknowns(std::initializer_list<Parameter> free) {
    for (const Parameter parameter : free) isFree_[static_cast<std::size_t>(parameter)] = true;
  }
  constexpr bool has(Parameter parameter) const { return isFree_[static_cast<std::size_t>(parameter)]; }

 private:
  std::array<bool, 4> isFree_{};
};

inline constexpr Unknowns kWidthUnknown{kAngle, kNormal, kTangential, kMoment};
inline constexpr Unknowns kWidthKnown{kAngle, kNormal, kTangential};

/// Least standard deviations that an unbiased fit of the contacts, all together, can have from readings of
/// all gauges but those left out, with independent normal noise: one vector a contact, 0 for what is known.
/// All are infinite where the readings don't determine all unknowns. Exact for small noise; a bound of a
/// moment takes moments below 0 for possible. Costs 0.1 ms a contact.
std::vector<Parameters> cramerRaoBound(const FitModel& model, std::span<const FittedContact> contacts,
                                       const Unknowns& unknowns, double noise_strain,
                                       std::span<const int> leftOut = {});

/// The same of one contact.
Parameters cramerRaoBound(const FitModel& model, const FittedContact& contact, const Unknowns& unknowns,
                          double noise_strain, std::span<const int> leftOut = {});

}  // namespace strainfinger::evidence
