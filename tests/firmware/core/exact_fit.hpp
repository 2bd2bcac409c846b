#pragma once
// Contacts that explain strains best, by Levenberg and Marquardt's method on the elastic model in double
// precision, and by trying everything: what the firmware's fit and search are held against.

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "tests/firmware/core/model_ring.hpp"

namespace strainfinger {

/// Contacts and their chi-squared: residuals over what a reading may be off.
struct Fitted {
  std::vector<Press> presses;
  double chiSquared;
};

class ExactFit {
 public:
  /// `gauges`: those whose strains count.
  ExactFit(const ModelRing& ring, std::vector<double> strains, firmware::GaugeSet gauges, bool isWidthFree)
      : ring_(ring),
        strains_(std::move(strains)),
        deviations_(ring.deviations(strains_)),
        gauges_(gauges),
        isWidthFree_(isWidthFree) {}
  ExactFit(const ModelRing& ring, std::vector<double> strains)
      : ExactFit(ring, std::move(strains), ring.allGauges(), ring.constants().width_is_known == 0) {}

  double chiSquared(std::span<const Press> presses) const { return residuals(presses).squaredNorm(); }
  double chiSquared(const Press& press) const { return chiSquared({&press, 1}); }

  /// The optimum that is downhill from these.
  Fitted from(std::vector<Press> presses) const {
    double chi = chiSquared(presses);
    for (double damping = 1e-3; damping < 1e9;) {
      const auto tried = stepped(presses, damping);
      const double left = chiSquared(tried);
      damping *= left < chi ? 0.1 : 10;
      if (left >= chi) continue;
      const bool isDone = chi - left < 1e-9 * (1 + chi);
      presses = tried;
      chi = left;
      if (isDone) break;
    }
    return {presses, chi};
  }

 private:
  Eigen::VectorXd residuals(std::span<const Press> presses) const {
    const auto predicted = ring_.strains(presses);
    Eigen::VectorXd left = Eigen::VectorXd::Zero(ring_.gauges());
    for (int i = 0; i < ring_.gauges(); ++i)
      if (firmware::contains(gauges_, i))
        left[i] =
            (strains_[static_cast<std::size_t>(i)] - predicted[static_cast<std::size_t>(i)]) / deviations_[i];
    return left;
  }
  Eigen::MatrixXd slopes(std::span<const Press> presses) const {
    Eigen::MatrixXd all(ring_.gauges(), 4 * static_cast<Eigen::Index>(presses.size()));
    for (std::size_t k = 0; k < presses.size(); ++k)
      all.middleCols<4>(4 * static_cast<Eigen::Index>(k)) =
          deviations_.cwiseInverse().asDiagonal() * ring_.slopes(presses[k]);
    for (int i = 0; i < ring_.gauges(); ++i)
      if (!firmware::contains(gauges_, i)) all.row(i).setZero();
    return all;
  }
  /// A damped step. Widths that are known, or 0 and would shrink, stay.
  std::vector<Press> stepped(std::vector<Press> presses, double damping) const {
    Eigen::MatrixXd columns = slopes(presses);
    const Eigen::VectorXd left = residuals(presses);
    for (std::size_t k = 0; k < presses.size(); ++k) {
      auto column = columns.col(4 * static_cast<Eigen::Index>(k) + 3);
      if (!isWidthFree_ || (presses[k].width_mm == 0 && column.dot(left) <= 0)) column.setZero();
    }
    Eigen::MatrixXd normal = columns.transpose() * columns;
    for (double& each : normal.diagonal()) each = each * (1 + damping) + 1e-12;
    const Eigen::VectorXd step = normal.ldlt().solve(columns.transpose() * left);
    for (std::size_t k = 0; k < presses.size(); ++k)
      move(presses[k], step.segment<4>(4 * static_cast<Eigen::Index>(k)));
    return presses;
  }
  static void move(Press& press, const Eigen::Vector4d& step) {
    press.position_pitch += step[0];
    press.normal += step[1];
    press.tangential += step[2];
    press.width_mm = std::min(widthOf_mm(momentOf_mm2(press.width_mm) + step[3]), kMostWidth_mm);
  }
  static constexpr double kMostWidth_mm = 8;

  const ModelRing& ring_;
  std::vector<double> strains_;
  Eigen::VectorXd deviations_;
  firmware::GaugeSet gauges_;
  bool isWidthFree_;
};

/// Looks at every place of an even ring and every width for one contact, and follows the best of them
/// downhill.
class ExactSearch {
 public:
  explicit ExactSearch(const ModelRing& ring) : ring_(ring) {
    const int widths = isWidthKnown() ? 1 : kWidths;
    for (int i = 0; i < widths; ++i) {
      const double width_mm = isWidthKnown() ? widthKnown_mm() : 0.25 + 0.5 * i;
      for (int place = 0; place < kPlacesAPitch; ++place) {
        const double position = static_cast<double>(place) / kPlacesAPitch;
        units_.push_back({position, width_mm, unitStrains(position, width_mm)});
      }
    }
  }

  /// The most likely contact that presses, within friction.
  Fitted best(const std::vector<double>& strains) const {
    const ExactFit fit(ring_, strains);
    std::optional<Fitted> best;
    for (const Press& start : starts(strains)) {
      const Fitted fitted = fit.from({start});
      const Press& press = fitted.presses[0];
      if (press.normal <= 0 || std::abs(press.tangential) > 1.25 * ring_.friction() * press.normal) continue;
      if (!best || fitted.chiSquared < best->chiSquared) best = fitted;
    }
    return best.value_or(Fitted{{Press{0, 0, 0}}, 1e30});
  }

 private:
  static constexpr int kPlacesAPitch = 16, kWidths = 15, kStarts = 6;
  struct Unit {
    double position_pitch, width_mm;
    Eigen::MatrixX2d strains;  ///< of a normal and of a tangential load
  };
  struct Start {
    Press press;
    double left;
  };

  bool isWidthKnown() const { return ring_.constants().width_is_known != 0; }
  double widthKnown_mm() const {
    return ring_.pressOf({0, 0, 0, static_cast<firmware::Number>(ring_.constants().known_moment_q20)}, 0)
        .width_mm;
  }
  /// Half of the contact slips.
  Eigen::MatrixX2d unitStrains(double position, double width_mm) const {
    const double friction = ring_.friction();
    const auto both = ring_.strains(Press{position, 1, friction / 2, width_mm});
    const auto normal = ring_.strains(Press{position, 1, 0, width_mm});
    Eigen::MatrixX2d unit(ring_.gauges(), 2);
    for (std::size_t i = 0; i < normal.size(); ++i)
      unit.row(static_cast<Eigen::Index>(i)) << normal[i], (both[i] - normal[i]) / (friction / 2);
    return unit;
  }
  /// The best places and widths, none next to a better one.
  std::vector<Press> starts(const std::vector<double>& strains) const {
    std::vector<Start> all;
    for (int gauge = 0; gauge < ring_.gauges(); ++gauge) {
      const Eigen::VectorXd turned = turnedBy(gauge, strains);
      for (const Unit& unit : units_) {
        const Eigen::Matrix2d normal = unit.strains.transpose() * unit.strains;
        const Eigen::Vector2d loads = normal.llt().solve(unit.strains.transpose() * turned);
        if (loads[0] <= 0) continue;
        all.push_back({{unit.position_pitch + gauge, loads[0], loads[1], unit.width_mm},
                       (turned - unit.strains * loads).squaredNorm()});
      }
    }
    std::sort(all.begin(), all.end(), [](const Start& a, const Start& b) { return a.left < b.left; });
    std::vector<Press> chosen;
    for (const Start& start : all)
      if (chosen.size() < kStarts && std::none_of(chosen.begin(), chosen.end(), [&](const Press& other) {
            return isBeside(start.press, other);
          }))
        chosen.push_back(start.press);
    return chosen;
  }
  Eigen::VectorXd turnedBy(int gauge, const std::vector<double>& strains) const {
    Eigen::VectorXd turned(ring_.gauges());
    for (int i = 0; i < ring_.gauges(); ++i)
      turned[i] = strains[static_cast<std::size_t>((i + gauge) % ring_.gauges())];
    return turned;
  }
  bool isBeside(const Press& a, const Press& b) const {
    return std::abs(ring_.between(a.position_pitch, b.position_pitch)) < 0.1 &&
           std::abs(a.width_mm - b.width_mm) < 1.1;
  }

  const ModelRing& ring_;
  std::vector<Unit> units_;
};

}  // namespace strainfinger
