#pragma once
// The options that tell of an indenter pressed on the finger.

#include <CLI/CLI.hpp>
#include <string>

#include "host/config/finger_config.hpp"
#include "host/contact/contact.hpp"

namespace strainfinger::cli {

/// What the subcommands about contacts share. Filled while the command line is parsed.
struct ContactOptions {
  explicit ContactOptions(CLI::App& command);

  /// Throws Failure(kUsage) naming the option or the place in the shape's file that is wrong.
  contact::ContactRequest request(const config::FingerConfig& config) const;

  std::string indenter;
  std::string regime;
  double width_m = 0;
  double load_n_per_m = 0;
  double tangential_n_per_m = 0;
  double friction = 0;
  double centre_deg = 0;
  CLI::Option* hasWidth;
  CLI::Option* hasLoad;
  CLI::Option* hasTangential;
  CLI::Option* hasFriction;
  CLI::Option* hasCentre;
};

/// Residual and warnings, on stderr.
void tellOf(const char* command, const contact::Contact& contact, const contact::ContactRequest& request,
            const config::FingerConfig& config);

/// flat, cylinder:RADIUS_M, wedge:HALF_ANGLE_DEG, or the path of a measured shape: CSV of x_m,height_m.
contact::Indenter parseIndenter(const std::string& text);

}  // namespace strainfinger::cli
