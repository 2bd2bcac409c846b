#pragma once
// How far answers are from the truth, from the bound and from what they say of themselves.

#include <array>
#include <vector>

#include "host/evidence/fit_model.hpp"

namespace strainfinger::evidence {

/// Some errors. All figures are NaN without any.
class Errors {
 public:
  void add(double error) { errors_.push_back(error); }
  int count() const { return static_cast<int>(errors_.size()); }
  double mean() const;
  double rms() const;
  /// The magnitude that this share of all don't exceed: the least of the errors of which it is true. 0 <
  /// share <= 1.
  double quantile(double share) const;
  double worst() const { return quantile(1); }

 private:
  std::vector<double> errors_;
};

/// What a locator says of one contact.
struct Answer {
  Parameters values;       ///< a moment that it doesn't tell: NaN
  Parameters sigmas;       ///< as reported; NaN where it reports none
  bool isFlagged = false;  ///< it says itself that it may be wrong
};

/// Answers to many touches. Errors, and errors over the bound, are of answers in the right place; errors over
/// sigma of those that aren't flagged.
class Accuracy {
 public:
  /// An answer further off than gross_rad, half a pitch as a rule, is in a wrong place.
  explicit Accuracy(double gross_rad) : gross_rad_(gross_rad) {}

  void addMissed() {
    ++touches_;
    ++missed_;
  }
  /// A bound of 0 or NaN, or an infinite one, is not compared with.
  void add(const Parameters& truth, const Parameters& bound, const Answer& answer);

  int touches() const { return touches_; }
  int missed() const { return missed_; }    ///< no answer
  int flagged() const { return flagged_; }  ///< answers that say they may be wrong
  int gross() const { return gross_; }      ///< in a wrong place
  int silent() const { return silent_; }    ///< in a wrong place, and not flagged
  /// Off by more than kFarSigmas reported sigmas in any parameter, and not flagged.
  int overconfident() const { return overconfident_; }
  static constexpr double kFarSigmas = 6;

  const Errors& errors(Parameter parameter) const { return at(errors_, parameter); }
  const Errors& overBound(Parameter parameter) const { return at(overBound_, parameter); }
  const Errors& overSigma(Parameter parameter) const { return at(overSigma_, parameter); }

 private:
  using Each = std::array<Errors, 4>;
  static const Errors& at(const Each& each, Parameter parameter) {
    return each[static_cast<std::size_t>(parameter)];
  }

  double gross_rad_;
  int touches_ = 0, missed_ = 0, flagged_ = 0, gross_ = 0, silent_ = 0, overconfident_ = 0;
  Each errors_, overBound_, overSigma_;
};

}  // namespace strainfinger::evidence
