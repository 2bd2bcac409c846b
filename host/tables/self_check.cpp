#include "host/tables/self_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "common/fixed_real.hpp"
#include "firmware/core/detect.hpp"
#include "firmware/core/estimate.hpp"
#include "host/base/angles.hpp"
#include "host/base/failure.hpp"
#include "host/model/impulse_response.hpp"
#include "host/model/touch_load.hpp"
#include "host/tables/readings.hpp"
#include "host/tables/table_builder.hpp"

namespace strainfinger::tables {
namespace {

using firmware::FitMode;

/// Steps over a pitch, few of which coincide with the tables' nodes, and over the friction cone. Where the
/// width is fitted each search costs five times as much.
struct Grid {
  int offsets, directions;
};
constexpr Grid kFitted{8, 4}, kKnown{16, 8};

constexpr double kWrong_pitch = 1.0 / 8;  ///< right answers are a hundred times nearer
constexpr double kModelTolerance = 1e-9;  ///< of the model: below a step of StrainQ32 at half of full scale
/// Loads, of half of full scale: weak contacts are judged with more doubt, so the locator goes other ways.
constexpr std::array kLoads{1.0, SelfCheck::kWeakerLoad};
/// Widths that are fitted, of the largest. Wider contacts have rivals that full scale does not tell apart.
constexpr std::array kWidths{0.0, 3.0 / 8};

/// The gauge around which contacts are tried, away from where angles wrap.
std::size_t middleOf(const TableImage& image) { return image.constants.gauge_count / 2u; }

/// Strains of a ring under loads of 1 N/m.
class Ring {
 public:
  explicit Ring(const TableImage& image) : image_(image), response_(responseOf(image.parameters)) {
    for (int i = -180; i <= 180; ++i) {
      const double angle_rad = i * kRadPerDeg;
      peak_ = std::max(peak_, std::abs(response_.at(angle_rad).normal));
    }
  }

  double pitch_rad() const { return 2 * std::numbers::pi / image_.constants.gauge_count; }
  double peak() const { return peak_; }  ///< of a line load: strain per N/m

  /// The strains of a load of 1 N/m, and `direction` times that sideways, at an offset from the middle gauge.
  std::vector<double> strains(double offset_pitch, double direction, double width_m) const {
    const TableParameters& p = image_.parameters;
    const double moment_rad2 = model::momentOf(model::Profile::kUniform, width_m / p.outer_radius_m);
    const model::TouchLoad touch{1, direction, moment_rad2, model::Profile::kEllipse, p.friction_coefficient};
    const model::LoadSpectrum spectrum = model::fittedSpectrum(touch, response_.harmonics());
    std::vector<double> strains;
    for (std::size_t gauge = 0; gauge < image_.constants.gauge_count; ++gauge)
      strains.push_back(response_.under(spectrum, fromMiddle_rad(gauge) - offset_pitch * pitch_rad()).strain);
    return strains;
  }

 private:
  static model::ImpulseResponse responseOf(const TableParameters& p) {
    const model::Annulus<double> annulus{p.core_radius_m, p.outer_radius_m, p.shear_modulus_pa,
                                         p.poisson_ratio};
    return {annulus, p.gauge_radius_m, p.component, p.arc_length_m, 0, kModelTolerance};
  }
  double fromMiddle_rad(std::size_t gauge) const {
    const std::uint32_t turned_q32 = image_.gauge_angle_q32[gauge] - image_.gauge_angle_q32[middleOf(image_)];
    return toReal(TurnQ32::fromRaw(turned_q32)) * 2 * std::numbers::pi;
  }

  const TableImage& image_;
  model::ImpulseResponse response_;
  double peak_ = 0;
};

/// Tries the contacts one by one and keeps what the check tells.
class Trials {
 public:
  explicit Trials(const TableImage& image)
      : image_(image), ring_(image), readings_(image.parameters.gauge_count) {
    check_.halfScale_n_per_m = image.parameters.full_scale_strain / 2 / ring_.peak();
  }

  SelfCheck run() {
    const double friction = image_.parameters.friction_coefficient;
    const Grid& grid = widthIsKnown() ? kKnown : kFitted;
    for (const double width_m : widths_m())
      for (int k = 0; k <= grid.offsets; ++k)
        for (int i = 0; i <= grid.directions; ++i)
          tryContact(static_cast<double>(k) / grid.offsets - 0.5, friction * (2.0 * i / grid.directions - 1),
                     width_m);
    return check_;
  }

 private:
  bool widthIsKnown() const { return image_.constants.width_is_known != 0; }

  std::vector<double> widths_m() const {
    if (widthIsKnown()) return {image_.parameters.contact_width_m};
    std::vector<double> widths;
    for (const double part : kWidths) widths.push_back(part * image_.parameters.largest_width_m);
    return widths;
  }

  std::vector<FitMode> modes() const {
    if (widthIsKnown()) return {FitMode::kThreePoint, FitMode::kRefined};
    return {FitMode::kRefined};
  }

  void tryContact(double offset_pitch, double direction, double width_m) {
    const std::vector<double> strains = ring_.strains(offset_pitch, direction, width_m);
    noteGate(strains);
    for (const double part : kLoads) {
      const double load = part * check_.halfScale_n_per_m;
      std::transform(strains.begin(), strains.end(), readings_.begin(),
                     [&](double strain) { return readingOf(image_.constants, load * strain); });
      if (firmware::gateEnergy(image_.constants, readings_) < image_.constants.gate_on) continue;
      for (const FitMode mode : modes()) locate({mode, load, direction, width_m, offset_pitch, 0});
    }
  }

  void noteGate(const std::vector<double>& strains) {
    double norm = 0;
    for (const double strain : strains) norm = std::hypot(norm, strain);
    const double gate =
        std::sqrt(image_.constants.gate_on) * powerOfTwo(image_.constants.gate_shift - StrainQ32::kFracBits);
    check_.detected_n_per_m = std::max(check_.detected_n_per_m, gate / norm);
  }

  void locate(Misplaced trial) {
    const Located located = locateAlone(image_, readings_, trial.mode);
    ++check_.contacts;
    if (!located.isCertain) {
      ++check_.uncertain;
      return;
    }
    const std::uint32_t turned_q32 = located.contact.angle.raw() - image_.gauge_angle_q32[middleOf(image_)];
    const double turned_pitch = toReal(TurnQ32::fromRaw(turned_q32)) * image_.constants.gauge_count;
    trial.error_pitch = std::remainder(turned_pitch - trial.offset_pitch, image_.constants.gauge_count);
    const double worst = check_.misplaced ? std::abs(check_.misplaced->error_pitch) : kWrong_pitch;
    if (std::abs(trial.error_pitch) > worst) check_.misplaced = trial;
  }

  const TableImage& image_;
  Ring ring_;
  std::vector<std::int32_t> readings_;
  SelfCheck check_;
};

}  // namespace

Located locateAlone(const TableImage& image, std::span<const std::int32_t> readings_q32, FitMode mode) {
  firmware::Locator locator(mode);
  firmware::locateOnce(image, readings_q32, firmware::allGauges(image.constants.gauge_count), locator);
  const firmware::Answer& answer = locator.answer();
  const Contact found =
      firmware::estimate(image.constants, answer, firmware::unitErrors(locator.linearisation()), 0);
  return {found, !found.uncertain && !answer.several && answer.suspect == 0};
}

SelfCheck selfCheck(const TableImage& image) { return Trials(image).run(); }

CheckedTables buildCheckedTables(const config::FingerConfig& config) try {
  CheckedTables tables{buildTableImage(config), {}};
  tables.check = selfCheck(tables.image);
  requireLocatable(tables.image, tables.check);
  return tables;
} catch (const Failure& failure) {
  if (config.source.empty()) throw;
  throw Failure(failure.code(), config.source + ": " + failure.what());
}

}  // namespace strainfinger::tables
