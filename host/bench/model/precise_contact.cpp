#include "host/bench/model/precise_contact.hpp"

#include <Eigen/Jacobi>
#include <Eigen/LU>
#include <algorithm>
#include <boost/math/constants/constants.hpp>
#include <cmath>
#include <functional>
#include <tuple>

#include "host/bench/model/precise.hpp"

namespace strainfinger::bench {
namespace {

using Matrix = Eigen::MatrixX<Precise>;
using Vector = Eigen::VectorX<Precise>;
using model::kNormal;
using model::kTangential;

const Precise kPi = boost::math::constants::pi<Precise>();
constexpr int kNodes = 40;
constexpr int kHarmonics = 170;  // the rest falls like 0.49^n

/// What u_r reads of unit harmonics of either traction at the surface; n = 0 .. last.
Matrix surfaceResponses(int last) {
  const model::HarmonicModel<Precise> harmonics(preciseAnnulus(), preciseAnnulus().outer_radius_m);
  Matrix responses(last + 1, 2);
  for (int n = 0; n <= last; ++n) responses.row(n) = harmonics(n).row(model::kUr);
  return responses;
}

/// u_r = int K(theta - phi) traction(phi) dphi. For nu = 1/2 and n >= 2 the responses are s (1/(n-1) +
/// 1/(n+1)) and s (1/(n-1) - 1/(n+1)), s = r_b / 4 mu, but for a rest of alpha^2n; their sums are 2 cos x C -
/// 1 - cos x / 2 and 2 sin x C + sin x / 2, C = -ln(2 sin |x| / 2).
class Kernel {
 public:
  Kernel() : rest_(surfaceResponses(kHarmonics)) {
    const auto annulus = preciseAnnulus();
    scale_ = annulus.outer_radius_m / (4 * annulus.shear_modulus_pa);
    sign_ = rest_(kHarmonics, kTangential) > 0 ? 1 : -1;
    for (int n = 2; n <= kHarmonics; ++n) {
      rest_(n, kNormal) -= scale_ * (Precise(1) / (n - 1) + Precise(1) / (n + 1));
      rest_(n, kTangential) -= sign_ * scale_ * (Precise(1) / (n - 1) - Precise(1) / (n + 1));
    }
    rest_(0, kNormal) /= 2;
  }

  /// K of pressure and of shear friction times it.
  struct Parts {
    Precise logarithm;  ///< the factor of ln |x - y|, x and y in half widths
    Precise rest;
  };
  Parts at(const Precise& x, const Precise& halfWidth, const Precise& friction) const {
    const Precise angle = x * halfWidth, c = cos(angle), s = sin(angle);
    // -C without ln |x - y|
    const Precise smooth = log(x == 0 ? halfWidth : Precise(2 * sin(abs(angle) / 2) / abs(x)));
    const Precise factor = -2 * scale_ * (-c + friction * sign_ * s);
    Precise rest = scale_ * (1 + c / 2) + friction * sign_ * scale_ * s / 2;
    Precise cn = 1, sn = 0;
    for (int n = 0; n <= kHarmonics; ++n) {
      rest += -rest_(n, kNormal) * cn + friction * rest_(n, kTangential) * sn;
      const Precise next = cn * c - sn * s;
      sn = sn * c + cn * s;
      cn = next;
    }
    return {factor / kPi, (factor * smooth + rest) / kPi};
  }

 private:
  Matrix rest_;
  Precise scale_;
  int sign_;
};

/// int sqrt(1 - y^2) U_k(y) ln |x - y| dy, x = cos(turn).
Precise logarithmOf(int k, const Precise& turn) {
  const auto ofT = [&](int m) {
    return m == 0 ? Precise(-kPi * boost::math::constants::ln_two<Precise>())
                  : Precise(-kPi * cos(m * turn) / m);
  };
  return (ofT(k) - ofT(k + 2)) / 2;
}

constexpr int kSlopes = 300;       // n_c
constexpr int kRowsOfSlopes = 48;  // rows are band-limited: 40 give all digits of double

/// The positive half of an even number of nodes of Gauss & Legendre on -1 .. 1.
struct GaussRule {
  explicit GaussRule(int count) : nodes(count / 2), weights(count / 2) {
    for (int i = 0; i < count / 2; ++i) {
      Precise x = cos(kPi * (4 * i + 3) / (4 * count + 2)), slope = 1;
      for (int step = 0; step < 8; ++step) {  // Newton's, from three digits
        Precise before = 1, here = x;
        for (int n = 2; n <= count; ++n) {
          const Precise next = ((2 * n - 1) * x * here - (n - 1) * before) / n;
          before = here;
          here = next;
        }
        slope = count * (x * here - before) / (x * x - 1);
        x -= here / slope;
      }
      nodes[i] = x;
      weights[i] = 2 / ((1 - x * x) * slope * slope);
    }
  }
  Vector nodes, weights;
};

/// (1/pi) int (1 + cos(2 pi theta / width))/2 cos n theta dtheta over the width.
Vector hanningCoefficients(const Precise& width, int count) {
  const auto sinc = [](const Precise& x) { return x == 0 ? Precise(1) : Precise(sin(x) / x); };
  Vector coefficients(count);
  for (int n = 0; n < count; ++n) {
    const Precise x = n * width / 2;
    coefficients[n] =
        n > kSlopes / 2 ? Precise(0) : width / (2 * kPi) * (sinc(x) + (sinc(x - kPi) + sinc(x + kPi)) / 2);
  }
  return coefficients;
}

/// The window times cos j (sign 1) or sin j (-1), column j, as coefficients of cos n or sin n, row n.
Matrix windowed(const Vector& hanning, int sign) {
  Matrix result(kSlopes + 1, kSlopes / 2 + 1);
  for (int j = 0; j < result.cols(); ++j)
    for (int n = 0; n <= kSlopes; ++n) result(n, j) = (hanning[std::abs(n - j)] + sign * hanning[n + j]) / 2;
  result.row(0) /= 2;
  return result;
}

/// Of a symmetric matrix, by Jacobi's rotations: Eigen's own need an infinity, which 50 digits have none of.
Vector eigenvaluesOf(Matrix matrix) {
  constexpr int kSweeps = 12;  // quadratic: 8 reach 50 digits
  for (int sweep = 0; sweep < kSweeps; ++sweep)
    for (Eigen::Index p = 1; p < matrix.rows(); ++p)
      for (Eigen::Index q = 0; q < p; ++q) {
        if (matrix(p, q) == 0) continue;
        const Precise ratio = (matrix(q, q) - matrix(p, p)) / (2 * matrix(p, q));
        const Precise tangent = (ratio < 0 ? -1 : 1) / (abs(ratio) + sqrt(ratio * ratio + 1));
        const Precise cosine = 1 / sqrt(tangent * tangent + 1);
        const Eigen::JacobiRotation<Precise> rotation(cosine, tangent * cosine);
        matrix.applyOnTheLeft(p, q, rotation.adjoint());
        matrix.applyOnTheRight(p, q, rotation);
      }
  return matrix.diagonal();
}

}  // namespace

// p = sqrt(1 - y^2) f, f by its values at the zeros of U_kNodes; equations at those of T_(kNodes + 2), whose
// further unknowns are the depth and the tilt by which the indenter's centre is off.
PreciseContact preciseContact(double width_m, double friction) {
  const Kernel kernel;
  const Precise half = Precise(width_m) / 2 / preciseAnnulus().outer_radius_m;
  const Precise radius = preciseAnnulus().outer_radius_m, mu = friction;
  constexpr int kRows = kNodes + 2;
  Matrix equations(kRows, kRows);
  Vector right(kRows), nodes(kNodes), weights(kNodes);
  for (int j = 0; j < kNodes; ++j) {
    const Precise turn = kPi * (j + 1) / (kNodes + 1), sine = sin(turn);
    nodes[j] = cos(turn);
    weights[j] = kPi * sine * sine / (kNodes + 1);
  }
  for (int i = 0; i < kRows; ++i) {
    const Precise turn = kPi * (2 * i + 1) / (2 * kRows), x = cos(turn);
    for (int j = 0; j < kNodes; ++j) {
      const Precise nodeTurn = kPi * (j + 1) / (kNodes + 1);
      Precise logarithm = 0;  // of the interpolant that is 1 at the node
      for (int k = 0; k < kNodes; ++k)
        logarithm += logarithmOf(k, turn) * sin((k + 1) * nodeTurn) / sin(nodeTurn);
      logarithm *= 2 * weights[j] / kPi;
      const auto parts = kernel.at(x - nodes[j], half, mu);
      equations(i, j) = half * (parts.logarithm * logarithm + parts.rest * weights[j]);
    }
    equations(i, kNodes) = 1;                      // depth
    equations(i, kNodes + 1) = radius * half * x;  // r_b theta e of r_b (theta - e)^2 / 2
    right[i] = radius * half * half * x * x / 2;
  }
  const Vector found = equations.partialPivLu().solve(right);
  const Vector pressure = found.head(kNodes).cwiseProduct((1 - nodes.array().square()).sqrt().matrix());
  return {static_cast<double>(Precise(radius * half * weights.dot(found.head(kNodes)))),
          static_cast<double>(Precise(-found[kNodes + 1])), (half * nodes).cast<double>(),
          pressure.cast<double>()};
}

std::vector<double> preciseSingularValues(double width_m, int count) {
  const Precise width = Precise(width_m) / preciseAnnulus().outer_radius_m;
  const Vector hanning = hanningCoefficients(width, 2 * kSlopes + 1);
  Matrix responses = surfaceResponses(kSlopes);
  for (int n = 0; n <= kSlopes; ++n) responses.row(n) *= n;
  const Matrix cosines = windowed(hanning, 1), sines = windowed(hanning, -1);
  const GaussRule rule(kRowsOfSlopes);
  Matrix c(rule.nodes.size(), kSlopes + 1), s = c;
  for (Eigen::Index i = 0; i < c.rows(); ++i)
    for (int n = 0; n <= kSlopes; ++n) {
      const Precise phase = n * rule.nodes[i] * width / 2, root = sqrt(rule.weights[i]);
      c(i, n) = root * cos(phase);
      s(i, n) = root * sin(phase);
    }
  std::vector<double> values;
  for (const auto& [waves, ofPressure, ofShear] :
       {std::tie(s, cosines, sines), std::tie(c, sines, cosines)}) {
    const Matrix p = waves * (responses.col(kNormal).asDiagonal() * ofPressure);
    const Matrix q = waves * (responses.col(kTangential).asDiagonal() * ofShear);
    for (const Precise& value : eigenvaluesOf(p * p.transpose() + q * q.transpose()))
      values.push_back(static_cast<double>(Precise(sqrt(abs(value)))));
  }
  std::ranges::sort(values, std::greater());
  values.resize(static_cast<std::size_t>(count));
  return values;
}

}  // namespace strainfinger::bench
