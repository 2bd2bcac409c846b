#include "host/tables/self_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "common/fixed_real.hpp"
#include "firmware/core/detect.hpp"
#include "firmware/core/estimate.hpp"
#include "host/model/impulse_response.hpp"
#include "host/tables/readings.hpp"
#include "host/tables/table_builder.hpp"

namespace strainfinger::tables {
namespace {

using firmware::FitMode;

constexpr int kOffsets = 48;              ///< over a pitch; few of them coincide with the tables' rows
constexpr int kDirections = 16;           ///< over the friction cone
constexpr double kWrongBranch = 1.0 / 8;  ///< [pitches] right answers are a hundred times nearer
constexpr double kTolerance = 1e-9;       ///< of the model: below a step of StrainQ32 at half of full scale
/// Loads, of half of full scale: weak contacts are judged with more doubt, so the locator goes other ways.
constexpr std::array kLoads{1.0, 1.0 / 4, 1.0 / 16};

model::ImpulseResponse responseOf(const TableParameters& p) {
  const model::Annulus<double> annulus{p.core_radius_m, p.outer_radius_m, p.shear_modulus_pa,
                                       p.poisson_ratio};
  return {annulus, p.gauge_radius_m, p.component, p.arc_length_m, p.contact_width_m, kTolerance};
}

/// A ring's responses to contacts around the gauge half way round, away from where angles wrap.
class Ring {
 public:
  explicit Ring(const TableParameters& parameters) : gauges_(parameters.gauge_count) {
    const model::ImpulseResponse response = responseOf(parameters);
    const double pitch_rad = 2 * std::numbers::pi / gauges_;
    for (int k = 0; k <= kOffsets; ++k) {
      for (int gauge = 0; gauge < gauges_; ++gauge) {
        const auto value = response.at((gauge - middle() - offset_pitch(k)) * pitch_rad);
        responses_.push_back({value.normal, value.tangential});
        peak_ = std::max(peak_, std::abs(value.normal));
      }
    }
  }

  static double offset_pitch(int k) { return static_cast<double>(k) / kOffsets - 0.5; }
  int middle() const { return gauges_ / 2; }
  double peak() const { return peak_; }  ///< strain per N/m

  /// The strains of a load of 1 N/m, and `direction` times that sideways, at the k-th offset.
  std::vector<double> strains(int k, double direction) const {
    const auto begin = responses_.begin() + std::ptrdiff_t{k} * gauges_;
    std::vector<double> strains;
    std::transform(begin, begin + gauges_, std::back_inserter(strains),
                   [&](const Response& r) { return r.normal + direction * r.tangential; });
    return strains;
  }

 private:
  struct Response {
    double normal, tangential;
  };
  int gauges_;
  double peak_ = 0;
  std::vector<Response> responses_;
};

/// Tries the contacts one by one and keeps what the check tells.
class Trials {
 public:
  explicit Trials(const TableImage& image)
      : image_(image), ring_(image.parameters), readings_(image.parameters.gauge_count) {
    check_.halfScale_n_per_m = image.parameters.full_scale_strain / 2 / ring_.peak();
  }

  SelfCheck run() {
    const double friction = image_.parameters.friction_coefficient;
    for (int k = 0; k <= kOffsets; ++k) {
      for (int i = 0; i <= kDirections; ++i) tryContact(k, friction * (2.0 * i / kDirections - 1));
    }
    return check_;
  }

 private:
  void tryContact(int k, double direction) {
    const std::vector<double> strains = ring_.strains(k, direction);
    noteGate(strains);
    for (const double part : kLoads) {
      const double load = part * check_.halfScale_n_per_m;
      std::transform(strains.begin(), strains.end(), readings_.begin(),
                     [&](double strain) { return readingOf(image_.constants, load * strain); });
      const std::uint32_t energy = firmware::gateEnergy(image_.constants, readings_);
      if (energy < image_.constants.gate_on) continue;
      for (const FitMode mode : {FitMode::kThreePoint, FitMode::kRefined})
        judge(firmware::locate(image_, mode, readings_, energy),
              {mode, load, direction, Ring::offset_pitch(k), 0});
    }
  }

  void noteGate(const std::vector<double>& strains) {
    double norm = 0;
    for (const double strain : strains) norm = std::hypot(norm, strain);
    const double gate =
        std::sqrt(image_.constants.gate_on) * powerOfTwo(image_.constants.gate_shift - StrainQ32::kFracBits);
    check_.detected_n_per_m = std::max(check_.detected_n_per_m, gate / norm);
  }

  void judge(const firmware::Fit& fit, Misplaced trial) {
    ++check_.contacts;
    if (firmware::estimate(image_.constants, fit).uncertain) {
      ++check_.uncertain;
      return;
    }
    const double found = static_cast<double>(fit.best.position) / firmware::kOnePitch;
    trial.error_pitch =
        std::remainder(found - ring_.middle() - trial.offset_pitch, image_.constants.gauge_count);
    const double worst = check_.misplaced ? std::abs(check_.misplaced->error_pitch) : kWrongBranch;
    if (std::abs(trial.error_pitch) > worst) check_.misplaced = trial;
  }

  const TableImage& image_;
  Ring ring_;
  std::vector<std::int32_t> readings_;
  SelfCheck check_;
};

}  // namespace

SelfCheck selfCheck(const TableImage& image) { return Trials(image).run(); }

namespace {

/// Contacts that are not firm are scanned for: firm ones are here, too.
bool scanMisplaces(TableImage image) {
  image.start = {};
  return selfCheck(image).misplaced.has_value();
}

}  // namespace

CheckedTables buildCheckedTables(const config::FingerConfig& config) {
  CheckedTables tables{buildTableImage(config), {}};
  tables.check = selfCheck(tables.image);
  if (tables.image.constants.anchor_rule != AnchorRule::kExhaustive &&
      (tables.check.misplaced || scanMisplaces(tables.image))) {
    searchEverywhere(tables.image);
    tables.check = selfCheck(tables.image);
  }
  requireLocatable(tables.image, tables.check);
  return tables;
}

}  // namespace strainfinger::tables
