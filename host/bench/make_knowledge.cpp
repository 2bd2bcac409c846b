#include "host/bench/make_knowledge.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <stdexcept>

#include "host/tables/response_table.hpp"

namespace strainfinger::bench {
namespace {

/// Both responses over `Size` gauges from gauge `first` on, the contact at `position_pitch`.
template <std::size_t Size>
Eigen::Matrix<double, Size, 2> responsesOf(const BenchFinger& finger, int first, double position_pitch) {
  Eigen::Matrix<double, Size, 2> both;
  for (int k = 0; k < static_cast<int>(Size); ++k) {
    const auto value = finger.response(first + k - position_pitch);
    both.row(k) << value.normal, value.tangential;
  }
  return both;
}

template <typename Real, std::size_t Size>
Projection<Real, Size> projectionOf(const Eigen::Matrix<double, Size, 2>& responses) {
  const Eigen::HouseholderQR<Eigen::Matrix<double, Size, 2>> qr(responses);
  const Eigen::Matrix<double, Size, 2> basis = qr.householderQ() * Eigen::Matrix<double, Size, 2>::Identity();
  const Eigen::Matrix2d load =
      Eigen::Matrix2d(qr.matrixQR().template topRows<2>().template triangularView<Eigen::Upper>()).inverse();
  Projection<Real, Size> projection;
  for (std::size_t k = 0; k < Size; ++k) {
    projection.first[k] = static_cast<Real>(basis(static_cast<Eigen::Index>(k), 0));
    projection.second[k] = static_cast<Real>(basis(static_cast<Eigen::Index>(k), 1));
  }
  projection.load = {static_cast<Real>(load(0, 0)), static_cast<Real>(load(0, 1)),
                     static_cast<Real>(load(1, 1))};
  return projection;
}

TemplateBank makeTemplates(const BenchFinger& finger) {
  TemplateBank bank{};
  for (std::size_t i = 0; i < bank.shape.size(); ++i) {
    const double offset = (static_cast<double>(i) - TemplateBank::kPerPitch / 2) / TemplateBank::kPerPitch;
    const Eigen::Matrix<double, kWindow, 1> normal = responsesOf<kWindow>(finger, -kReach, offset).col(0);
    bank.load[i] = static_cast<float>(1 / normal.norm());
    for (std::size_t k = 0; k < kWindow; ++k)
      bank.shape[i][k] = static_cast<float>(normal[static_cast<Eigen::Index>(k)] / normal.norm());
  }
  return bank;
}

ScanBank makeScan(const BenchFinger& finger) {
  ScanBank bank{};
  for (std::size_t i = 0; i < bank.rows.size(); ++i) {
    const double offset = (static_cast<double>(i) - ScanBank::kFarthest) / ScanBank::kPerPitch;
    bank.rows[i] = projectionOf<float, kWindow>(responsesOf<kWindow>(finger, -kReach, offset));
  }
  return bank;
}

}  // namespace

template <typename Real>
RingResponse<Real> makeResponse(const BenchFinger& finger) {
  RingResponse<Real> table{};
  for (int i = 0; i < RingResponse<Real>::kPoints; ++i) {
    const auto value = finger.response(static_cast<double>(i) / RingResponse<Real>::kPerPitch);
    table.points[static_cast<std::size_t>(i)] = {
        static_cast<Real>(value.normal), static_cast<Real>(value.normalSlope),
        static_cast<Real>(value.tangential), static_cast<Real>(value.tangentialSlope)};
  }
  return table;
}

template <typename Real>
GlobalBank<Real> makeGlobalBank(const BenchFinger& finger) {
  GlobalBank<Real> bank{};
  for (std::size_t i = 0; i < bank.rows.size(); ++i)
    bank.rows[i] = projectionOf<Real, kGauges>(
        responsesOf<kGauges>(finger, 0, static_cast<double>(i) / GlobalBank<Real>::kPerPitch));
  return bank;
}

template <typename Real>
PatchTable<Real> makePatches(const BenchFinger& finger) {
  const tables::ResponseTable table = tables::responseTable(finger.config());
  PatchTable<Real> patches{};
  if (table.nodes != PatchTable<Real>::kNodes || table.cells != PatchTable<Real>::kCells)
    throw std::logic_error("the benchmark's patches are laid out for another table");
  for (std::size_t i = 0; i < patches.edge.size(); ++i)
    patches.edge[i] = static_cast<Real>(std::ldexp(table.cell_edge_q15[i], -15));
  const auto strains = [&](const ResponsePatch& weights) {
    typename PatchTable<Real>::Patch patch;
    // The firmware's order is 1, s, t, t^2, s t, s^2, too.
    for (std::size_t k = 0; k < patch.size(); ++k)
      patch[k] = static_cast<Real>(std::ldexp(weights[k], -15) * table.strainPerUnit);
    return patch;
  };
  for (std::size_t i = 0; i < patches.patch.size(); ++i)
    patches.patch[i] = {strains(table.patches[i].normal), strains(table.patches[i].tangential)};
  return patches;
}

template <typename Real>
WidthBank<Real> makeWidthBank(const PatchTable<Real>& patches) {
  constexpr Place<Real> kHalfSlips{0, 1, Real{0.5}};
  WidthBank<Real> bank{};
  for (std::size_t place = 0; place < bank.rows.size(); ++place)
    for (std::size_t width = 0; width < bank.rows[place].size(); ++width) {
      const WidePlace<Real> contact{kHalfSlips, bank.momentOf(width)};
      Eigen::Matrix<double, kGauges, 2> both;
      for (int gauge = 0; gauge < kGauges; ++gauge) {
        const Real beyond = static_cast<Real>(gauge) - static_cast<Real>(place) / bank.kPerPitch;
        const auto at = patches.at(beyond, contact);
        both.row(gauge) << static_cast<double>(at.normal.value), static_cast<double>(at.tangential.value);
      }
      bank.rows[place][width] = projectionOf<Real, kGauges>(both);
    }
  return bank;
}

template RingResponse<float> makeResponse(const BenchFinger&);
template RingResponse<double> makeResponse(const BenchFinger&);
template GlobalBank<float> makeGlobalBank(const BenchFinger&);
template GlobalBank<double> makeGlobalBank(const BenchFinger&);
template PatchTable<float> makePatches(const BenchFinger&);
template PatchTable<double> makePatches(const BenchFinger&);
template WidthBank<float> makeWidthBank(const PatchTable<float>&);
template WidthBank<double> makeWidthBank(const PatchTable<double>&);

Knowledge makeKnowledge(const BenchFinger& finger, const Training& training) {
  const auto patches = makePatches<float>(finger);
  return {makeResponse<float>(finger),
          makeTemplates(finger),
          makeScan(finger),
          makeGlobalBank<float>(finger),
          patches,
          makeWidthBank(patches),
          trainedPerceptron(finger, training)};
}

}  // namespace strainfinger::bench
