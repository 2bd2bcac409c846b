#include "host/cli/contact_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <sstream>

#include "host/base/angles.hpp"
#include "host/base/excerpt.hpp"
#include "host/base/failure.hpp"
#include "host/base/notice.hpp"
#include "host/base/number_rows.hpp"
#include "host/base/parse_number.hpp"
#include "host/base/read_file.hpp"
#include "host/cli/command.hpp"
#include "host/cli/model_options.hpp"

namespace strainfinger::cli {
namespace {

using contact::Indenter;

/// The number after "kind:", within its domain.
double parameterOf(const std::string& text, const std::string& kind, double least, double most) {
  const std::string number = text.substr(kind.size() + 1);
  const auto value = parseNumber<double>(number);
  if (value && *value > least && *value < most) return *value;
  throw Failure(ExitCode::kUsage, fmt::format("--indenter: {}: {} is not a number between {} and {}", kind,
                                              excerpt(number), least, most));
}

std::string textOf(const std::string& path) {
  try {
    return readFile(path, ExitCode::kUsage);
  } catch (const Failure& failure) {
    throw Failure(
        failure.code(),
        fmt::format("--indenter: \"{}\" is neither flat, cylinder:RADIUS_M, wedge:HALF_ANGLE_DEG nor a file "
                    "that can be read ({})",
                    excerpt(path), excerptWords(failure.what())));
  }
}

/// All that is wrong with a shape is a wrong request: exit status 2.
Indenter readShape(const std::string& path) {
  std::istringstream text(textOf(path));
  std::string where;
  try {
    NumberRowReader reader(text, path, 2, {.header = "x_m,height_m"});
    std::vector<double> position_m, height_m;
    for (std::vector<double> row; reader.next(row);) {
      if (!position_m.empty() && !(row[0] > position_m.back()))
        throw Failure(ExitCode::kUsage, fmt::format("{}: x_m must rise from row to row: {} comes after {}",
                                                    reader.place(), row[0], position_m.back()));
      position_m.push_back(row[0]);
      height_m.push_back(row[1]);
    }
    where = path + ": ";  // the reader's messages have the place themselves
    return Indenter::measured(position_m, height_m);
  } catch (const Failure& failure) {
    throw Failure(ExitCode::kUsage, where + failure.what());
  }
}

/// x_m is an arc along the finger: one in millimetres would go round it several times.
void requireOnSurface(const Indenter& indenter, const std::string& path, double radius_m) {
  const double half_m = std::numbers::pi * radius_m;
  const double first_m = indenter.firstPosition_m(), last_m = indenter.lastPosition_m();
  constexpr double kRounded = 1.001;
  if (!std::isfinite(first_m) || std::max(-first_m, last_m) <= kRounded * half_m) return;
  throw Failure(ExitCode::kUsage,
                fmt::format("{}: x_m goes from {} to {}: as an arc along this finger it is from -{:.4g} to "
                            "{:.4g} m; are these metres?",
                            path, first_m, last_m, half_m, half_m));
}

contact::Regime regimeOf(const std::string& name) {
  if (name == "sliding") return contact::Regime::kSliding;
  return name == "stick" ? contact::Regime::kStick : contact::Regime::kFrictionless;
}

void require(bool is, const char* what) {
  if (!is) throw Failure(ExitCode::kUsage, what);
}

/// "; regions from .. to .. and from .. to .. m", if there are several.
std::string regionsOf(const contact::Contact& contact, double radius_m) {
  if (contact.tractions.size() < 2) return "";
  std::string text = fmt::format("; {} regions:", contact.tractions.size());
  for (const contact::PatchTractions& part : contact.tractions)
    fmt::format_to(std::back_inserter(text), "{} {:.6g} to {:.6g}", text.ends_with(':') ? "" : ",",
                   radius_m * part.patch.first_rad(), radius_m * part.patch.last_rad());
  return text.append(" m");
}

/// Of the rubber's thickness, without a warning.
constexpr double kMostDepth = 0.2;

/// About what the mean pressure makes: p / 2 mu on a half space; where a layer is thinner than half of the
/// contact, the core holds it together.
double strainBelow(const contact::Contact& contact, const model::Annulus<double>& annulus) {
  double width_m = 0;
  for (const contact::PatchTractions& part : contact.tractions)
    width_m += 2 * annulus.outer_radius_m * part.patch.half_rad;
  const double layer_m = annulus.outer_radius_m - annulus.core_radius_m;
  return contact.normal_n_per_m / width_m / (2 * annulus.shear_modulus_pa) *
         std::min(1.0, 2 * layer_m / width_m);
}

}  // namespace

Indenter parseIndenter(const std::string& text) {
  constexpr double kMostRadius_m = 1e6;
  if (text == "flat") return Indenter::flat();
  if (text.starts_with("cylinder:"))
    return Indenter::cylinder(parameterOf(text, "cylinder", 0, kMostRadius_m));
  if (text.starts_with("wedge:")) return Indenter::wedge(parameterOf(text, "wedge", 0, 90));
  return readShape(text);
}

void tellOf(const char* command, const contact::Contact& contact, const contact::ContactRequest& request,
            const config::FingerConfig& config) {
  const model::Annulus<double> annulus = config.finger.annulus();
  tell("{}: residual {:.2g} m, recomputed from the tractions; {} terms a patch{}\n", command,
       contact.residual_m, contact.terms, regionsOf(contact, annulus.outer_radius_m));
  warn(command, contact.warnings);
  const double needed = std::abs(contact.tangential_n_per_m) / contact.normal_n_per_m;
  if (request.regime == contact::Regime::kStick && needed > config.contact.friction_coefficient)
    warn(command, fmt::format("sticks with a coefficient of friction of {:.3g} at least; "
                              "contact.friction_coefficient is {}, with which it slides",
                              needed, config.contact.friction_coefficient));
  const double layer_m = annulus.outer_radius_m - annulus.core_radius_m;
  const double share = contact.deepest_m / layer_m;
  if (share > kMostDepth)
    warn(command,
         fmt::format("{:.2g} of the rubber's thickness deep: strains are large, the model is for small ones",
                     share));
  else if (const double strain = strainBelow(contact, annulus); strain > kMostLinearStrain)
    warn(command,
         fmt::format("strains of about {:.2g} below the contact: the model is for small ones", strain));
}

ContactOptions::ContactOptions(CLI::App& command) {
  command
      .add_option(
          "--indenter", indenter,
          "flat, cylinder:RADIUS_M, wedge:HALF_ANGLE_DEG (between its axis and a face), or a CSV file of "
          "x_m,height_m: the arc along the finger and the indenter's height above its tangent plane, "
          "positive away from the finger")
      ->required();
  hasWidth = command.add_option("--width-m", width_m, "Width of the contact, an arc on the surface [m]");
  hasLoad = command.add_option("--load-n-per-m", load_n_per_m, "Or: normal load [N/m]");
  hasFriction = command.add_option(
      "--friction", friction,
      "Coefficient of friction when sliding, negative towards -theta; without it the config's");
  command
      .add_option("--regime", regime,
                  "What happens sidewards; frictionless without it, sliding if --friction is given. Stick is "
                  "ill-posed below nu = 1/2: a warning tells how open its load is, above 10 % it is refused")
      ->check(CLI::IsMember({"frictionless", "sliding", "stick"}));
  hasTangential = command.add_option("--tangential-n-per-m", tangential_n_per_m,
                                     "Load sidewards of what sticks [N/m], to +theta; 0 without it");
  hasCentre = command.add_option("--centre-deg", centre_deg,
                                 "Holds the contact's centre there, from the indenter's normal [degrees]");
  for (CLI::Option* option : {hasWidth, hasLoad, hasFriction, hasTangential, hasCentre})
    option->type_name("NUMBER")->check(option == hasCentre ? isFrom(-180, 180) : isFrom(-1e12, 1e12));
  hasWidth->excludes(hasLoad);
}

contact::ContactRequest ContactOptions::request(const config::FingerConfig& config) const {
  using contact::ContactSize;
  require(hasWidth->count() + hasLoad->count() == 1,
          "give the contact's size: --width-m W or --load-n-per-m P");
  require(hasTangential->count() == 0 || regime == "stick", "--tangential-n-per-m goes with --regime stick");
  require(hasFriction->count() == 0 || regime.empty() || regime == "sliding",
          "--friction goes with --regime sliding");
  contact::ContactRequest request;
  request.indenter = parseIndenter(indenter);
  requireOnSurface(request.indenter, indenter, config.finger.outer_radius_m);
  request.regime = regimeOf(regime.empty() && hasFriction->count() ? "sliding" : regime);
  if (request.regime == contact::Regime::kSliding)
    request.friction = hasFriction->count() ? friction : config.contact.friction_coefficient;
  request.tangential_n_per_m = tangential_n_per_m;
  request.size = hasWidth->count() ? ContactSize{ContactSize::Kind::kWidth, width_m}
                                   : ContactSize{ContactSize::Kind::kLoad, load_n_per_m};
  if (hasCentre->count()) request.centre_rad = centre_deg * kRadPerDeg;
  return request;
}

}  // namespace strainfinger::cli
