#pragma once
// The paper's figures and what it says about them.

#include <span>
#include <string>
#include <vector>

#include "host/config/finger_config.hpp"
#include "host/model/annulus.hpp"
#include "host/plot/picture.hpp"

namespace strainfinger::paper {

/// What figures are drawn of.
struct Subject {
  model::Annulus<double> annulus;
  double gaugeRadius_m;

  /// Width of the contact of figs. 6 to 10: the paper's 2 mm, on another finger the same angle.
  double contactWidth_m() const { return 2e-3 / 12.7e-3 * annulus.outer_radius_m; }

  explicit Subject(const config::FingerConfig& config)
      : annulus(config.finger.annulus()), gaugeRadius_m(config.gauges.radius_m) {}
};

/// The paper's own finger (sec. 3), which is the default one.
inline Subject paperSubject() { return Subject(config::FingerConfig{}); }

enum class Verdict { kBorneOut, kInPart, kNotBorneOut };

/// "borne out", "in part", "not borne out".
const char* nameOf(Verdict verdict);

/// Something the paper says of its finger, and what was found.
struct Claim {
  std::string name;      ///< short, the same in every run
  std::string paper;     ///< what it says, and where
  std::string computed;  ///< numbers, with units
  Verdict verdict;
};

struct Figure {
  int number;
  const char* title;
  plot::Picture (*picture)(const Subject& subject);
  std::vector<Claim> (*claims)();                ///< of the paper's finger
  std::string (*lacks)(const Subject& subject);  ///< what of it isn't there, and why; empty: nothing
};

/// In the order of their numbers. Costs of picture() and claims() of all of them together: below 2 s.
std::span<const Figure> figures();

}  // namespace strainfinger::paper
