#include "host/paper/sensing.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <vector>

#include "host/base/quantile.hpp"
#include "host/contact/decompositions.hpp"
#include "host/paper/spread_response.hpp"

namespace strainfinger::paper {
namespace {

using std::numbers::pi;

/// e_rr of a normal load all around, at even angles.
Eigen::VectorXd normalProfile(const SpreadResponse& response) {
  constexpr int kAngles = 721;
  Eigen::VectorXd profile(kAngles);
  for (int i = 0; i < kAngles; ++i) profile[i] = response.at(pi * (2.0 * i / (kAngles - 1) - 1)).normal;
  return profile;
}

/// What three neighbouring gauges read per N/m of a normal and of a tangential load at each of some angles
/// from the middle one.
struct Triples {
  std::vector<double> angles_rad;
  std::vector<Eigen::Matrix<double, 3, 2>> readings;

  Triples(const SpreadResponse& line, double pitch_rad, int angles) {
    for (int i = 0; i < angles; ++i) {
      angles_rad.push_back(pitch_rad * ((i + 0.5) / angles - 0.5));
      Eigen::Matrix<double, 3, 2>& triple = readings.emplace_back();
      for (int gauge = -1; gauge <= 1; ++gauge) {
        const auto value = line.at(gauge * pitch_rad - angles_rad.back());
        triple.row(gauge + 1) << value.normal, value.tangential;
      }
    }
  }
};

/// How many angles explain three readings exactly, with a load that presses and is held by friction of 1.
int solutions(const Triples& triples, const Eigen::Vector3d& readings) {
  const auto misfit = [&](std::size_t i) {
    const auto& triple = triples.readings[i];
    return readings.dot(triple.col(0).cross(triple.col(1)).normalized());
  };
  int count = 0;
  for (std::size_t i = 1; i < triples.readings.size(); ++i) {
    if ((misfit(i - 1) < 0) == (misfit(i) < 0)) continue;
    const Eigen::Vector2d load = contact::leastSquares(triples.readings[i], readings);
    count += load[0] > 0 && std::abs(load[1]) <= load[0] ? 1 : 0;
  }
  return count;
}

}  // namespace

WidthEffect widthEffect(const model::Annulus<double>& annulus, double radius_m, double width_m) {
  const Eigen::VectorXd line = normalProfile({annulus, radius_m, 0});
  const Eigen::VectorXd wide = normalProfile({annulus, radius_m, width_m});
  const double peak = line.cwiseAbs().maxCoeff(), scale = line.dot(wide) / line.squaredNorm();
  return {1 - wide.cwiseAbs().maxCoeff() / peak, (wide - scale * line).cwiseAbs().maxCoeff() / peak};
}

double kindEffect(const model::Annulus<double>& annulus, double radius_m, double width_m) {
  const Eigen::VectorXd ellipse = normalProfile({annulus, radius_m, width_m});
  const Eigen::VectorXd punch = normalProfile({annulus, radius_m, width_m, model::Profile::kPunch});
  return (punch - ellipse).cwiseAbs().maxCoeff() / ellipse.cwiseAbs().maxCoeff();
}

double ambiguousShare(const model::Annulus<double>& annulus, double radius_m, int gauges) {
  constexpr int kSearched = 401, kAngles = 40, kLoads = 20;
  const SpreadResponse line(annulus, radius_m, 0);
  const double pitch_rad = 2 * pi / gauges;
  const Triples searched(line, pitch_rad, kSearched), contacts(line, pitch_rad, kAngles);
  int ambiguous = 0;
  for (const auto& triple : contacts.readings)
    for (int i = 0; i < kLoads; ++i) {
      const Eigen::Vector2d load(1, 2 * (i + 0.5) / kLoads - 1);
      ambiguous += solutions(searched, triple * load) > 1 ? 1 : 0;
    }
  return ambiguous / static_cast<double>(kAngles * kLoads);
}

double widthSigma(const model::Annulus<double>& annulus, double radius_m, int gauges, double width_m,
                  bool withShear) {
  constexpr int kPhases = 16;
  constexpr double kNoise = 0.01;
  const double noise = kNoise * std::abs(SpreadResponse(annulus, radius_m, 0).at(0).normal);
  std::vector<SpreadResponse> responses{{annulus, radius_m, width_m}};
  if (withShear)
    responses.emplace_back(annulus, radius_m, width_m, model::Profile::kEllipse, StrainComponent::kShear);
  std::vector<double> sigmas;
  for (int phase = 0; phase < kPhases; ++phase) {
    Eigen::Matrix4d information = Eigen::Matrix4d::Zero();  // of angle, P, Q, width per itself
    for (const SpreadResponse& response : responses)
      for (int gauge = 0; gauge < gauges; ++gauge) {
        const auto value = response.at(2 * pi / gauges * (gauge - (phase + 0.5) / (2 * kPhases)));
        const Eigen::Vector4d slopes(-value.normalSlope, value.normal, value.tangential,
                                     value.normalPerWidth * width_m);
        information += slopes * slopes.transpose();
      }
    sigmas.push_back(noise * std::sqrt(information.inverse()(3, 3)));
  }
  return medianOf(sigmas);
}

}  // namespace strainfinger::paper
