#pragma once
// The firmware's locator on one set of readings alone, with answers as host/evidence compares them.

#include <memory>
#include <numbers>
#include <vector>

#include "common/fixed_real.hpp"
#include "common/table_image.hpp"
#include "firmware/core/detect.hpp"
#include "firmware/core/estimate.hpp"
#include "firmware/core/locator.hpp"
#include "host/base/no_value.hpp"
#include "host/evidence/accuracy.hpp"
#include "host/evidence/touched_ring.hpp"
#include "host/tables/table_builder.hpp"

namespace strainfinger {

/// The fourth parameter in these tests, instead of the second moment: the width [m] as the bus tells it, of
/// the uniform pressure with that moment.
inline constexpr evidence::Parameter kWidth = evidence::kMoment;

inline evidence::Answer answerOf(const Contact& contact) {
  constexpr double kTurn_rad = 2 * std::numbers::pi;
  const auto metres = [](std::uint32_t width_um) {
    return width_um == kWidthNotFitted ? kNoValue : width_um * 1e-6;
  };
  return {{toReal(contact.angle) * kTurn_rad, toReal(contact.normal), toReal(contact.tangential),
           metres(contact.width_um)},
          {toReal(contact.sigmaAngle) * kTurn_rad, toReal(contact.sigmaNormal),
           toReal(contact.sigmaTangential), metres(contact.sigmaWidth_um)},
          contact.uncertain};
}

class StatelessLocator {
 public:
  struct Found {
    std::vector<evidence::Answer> contacts;  ///< none: nothing touches the finger
    bool several = false;
    firmware::GaugeSet suspect = 0;
  };

  explicit StatelessLocator(const config::FingerConfig& config,
                            firmware::FitMode mode = firmware::FitMode::kRefined)
      : tables_(std::make_unique<TableImage>(tables::buildTableImage(config))), locator_(mode) {}

  /// `readings`: strains. Gauges in `leftOut` are known not to work.
  Found locate(const Eigen::VectorXd& readings, firmware::GaugeSet leftOut = 0) {
    const std::vector<std::int32_t> strains_q32 = evidence::conditioned_q32(readings);
    const TableConstants& constants = tables_->constants;
    if (firmware::gateEnergy(constants, strains_q32) < constants.gate_on) return {};
    locateOnce(*tables_, strains_q32, firmware::allGauges(constants.gauge_count) & ~leftOut, locator_);
    const firmware::Answer& answer = locator_.answer();
    Found found{{}, answer.several, answer.suspect};
    for (int i = 0; i < answer.solution.hypothesis.contacts; ++i)
      found.contacts.push_back(
          answerOf(estimate(constants, answer, firmware::unitErrors(locator_.linearisation()), i)));
    return found;
  }

 private:
  std::unique_ptr<TableImage> tables_;
  firmware::Locator locator_;
};

}  // namespace strainfinger
