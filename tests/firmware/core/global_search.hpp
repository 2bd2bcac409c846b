#pragma once
// The contact that explains a ring's strains best, searched everywhere in double precision.

#include <Eigen/Dense>
#include <vector>

#include "tests/firmware/core/model_ring.hpp"

namespace strainfinger {

class GlobalSearch {
 public:
  explicit GlobalSearch(const ModelRing& ring) : ring_(ring) {
    for (int fraction = 0; fraction < kPerPitch; ++fraction)
      grid_.push_back(responseTo(static_cast<double>(fraction) / kPerPitch));
  }

  /// Least squares over all gauges with the contact at one position: loads [N/m] and what stays unexplained.
  struct Answer {
    Press press;
    double unexplained;  ///< squared strain
  };
  Answer at(double position_pitch, const std::vector<double>& strains) const {
    return solve(responseTo(position_pitch), position_pitch, strains);
  }

  /// The best answer within the friction cone (|tangential| <= cone * normal).
  Answer best(const std::vector<double>& strains, double cone) const {
    Answer found{{}, 1e300};
    for (int step = 0; step < ring_.gauges() * kPerPitch; ++step) {
      const int gauge = step / kPerPitch;
      std::vector<double> turned(strains);
      std::rotate(turned.begin(), turned.begin() + gauge, turned.end());
      const Answer answer = solve(grid_[static_cast<std::size_t>(step % kPerPitch)],
                                  static_cast<double>(step) / kPerPitch, turned);
      if (std::abs(answer.press.tangential) <= cone * answer.press.normal &&
          answer.unexplained < found.unexplained)
        found = answer;
    }
    return polished(found, strains);
  }

 private:
  static constexpr int kPerPitch = 32;

  struct Response {
    Eigen::VectorXd normal, tangential;
    double nn, nt, tt;
  };

  Response responseTo(double position_pitch) const {
    Response result{Eigen::VectorXd(ring_.gauges()), Eigen::VectorXd(ring_.gauges()), 0, 0, 0};
    for (int gauge = 0; gauge < ring_.gauges(); ++gauge) {
      const auto value = ring_.response(gauge - position_pitch);
      result.normal[gauge] = value.normal;
      result.tangential[gauge] = value.tangential;
    }
    result.nn = result.normal.squaredNorm();
    result.nt = result.normal.dot(result.tangential);
    result.tt = result.tangential.squaredNorm();
    return result;
  }

  Answer solve(const Response& r, double position_pitch, const std::vector<double>& strains) const {
    const Eigen::Map<const Eigen::VectorXd> s(strains.data(), ring_.gauges());
    const double sn = s.dot(r.normal), st = s.dot(r.tangential), determinant = r.nn * r.tt - r.nt * r.nt;
    const double normal = (r.tt * sn - r.nt * st) / determinant;
    const double tangential = (r.nn * st - r.nt * sn) / determinant;
    const double unexplained = (s - normal * r.normal - tangential * r.tangential).squaredNorm();
    return {{position_pitch, normal, tangential}, unexplained};
  }

  /// Ever finer steps about an answer of the grid.
  Answer polished(Answer answer, const std::vector<double>& strains) const {
    for (double step = 0.5 / kPerPitch; step > 1e-6; step /= 2)
      for (const double position : {answer.press.position_pitch - step, answer.press.position_pitch + step}) {
        const Answer beside = at(position, strains);
        if (beside.unexplained < answer.unexplained) answer = beside;
      }
    return answer;
  }

  const ModelRing& ring_;
  std::vector<Response> grid_;
};

}  // namespace strainfinger
