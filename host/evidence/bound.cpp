#include "host/evidence/bound.hpp"

#include <Eigen/Dense>
#include <limits>

namespace strainfinger::evidence {
namespace {

constexpr std::array kParameters{kAngle, kNormal, kTangential, kMoment};

/// Columns of all that is unknown, in the order of the contacts and of their parameters.
Eigen::MatrixXd jacobian(const FitModel& model, std::span<const FittedContact> contacts,
                         const Unknowns& unknowns, std::span<const int> leftOut) {
  Eigen::MatrixXd columns(model.gauges(), 4 * static_cast<Eigen::Index>(contacts.size()));
  Eigen::Index count = 0;
  for (const FittedContact& contact : contacts) {
    const Eigen::MatrixX4d slopes = model.slopes(contact);
    for (const Parameter parameter : kParameters)
      if (unknowns.has(parameter)) columns.col(count++) = slopes.col(parameter);
  }
  columns.conservativeResize(Eigen::NoChange, count);
  for (const int gauge : leftOut) columns.row(gauge).setZero();
  return columns;
}

/// Square roots of the diagonal of (J^T J)^-1, or infinity. Columns are scaled first, so that the rank
/// doesn't depend on units.
Eigen::VectorXd deviations(const Eigen::MatrixXd& jacobian) {
  const Eigen::Index count = jacobian.cols();
  const Eigen::VectorXd norms = jacobian.colwise().norm();
  const auto unknown = Eigen::VectorXd::Constant(count, std::numeric_limits<double>::infinity());
  if (count > jacobian.rows() || (norms.array() == 0).any()) return unknown;
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(jacobian * norms.cwiseInverse().asDiagonal());
  if (qr.rank() < count) return unknown;
  const Eigen::MatrixXd upper = qr.matrixR().topRows(count);
  const Eigen::MatrixXd inverse =
      upper.triangularView<Eigen::Upper>().solve(Eigen::MatrixXd::Identity(count, count));
  return (qr.colsPermutation() * inverse.rowwise().norm()).cwiseQuotient(norms);
}

}  // namespace

std::vector<Parameters> cramerRaoBound(const FitModel& model, std::span<const FittedContact> contacts,
                                       const Unknowns& unknowns, double noise_strain,
                                       std::span<const int> leftOut) {
  const Eigen::VectorXd sigmas = noise_strain * deviations(jacobian(model, contacts, unknowns, leftOut));
  std::vector<Parameters> bounds(contacts.size(), Parameters::Zero());
  Eigen::Index next = 0;
  for (Parameters& bound : bounds)
    for (const Parameter parameter : kParameters)
      if (unknowns.has(parameter)) bound[parameter] = sigmas[next++];
  return bounds;
}

Parameters cramerRaoBound(const FitModel& model, const FittedContact& contact, const Unknowns& unknowns,
                          double noise_strain, std::span<const int> leftOut) {
  return cramerRaoBound(model, {&contact, 1}, unknowns, noise_strain, leftOut).front();
}

}  // namespace strainfinger::evidence
