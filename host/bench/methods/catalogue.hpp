#pragma once
// Every method of the benchmark by its name: the one list for this machine and the emulated processors.

#include <string_view>

#include "firmware/core/detect.hpp"
#include "firmware/core/estimate.hpp"
#include "firmware/core/locate.hpp"
#include "host/bench/methods/bundle.hpp"
#include "host/bench/methods/levenberg_marquardt.hpp"
#include "host/bench/methods/scan_and_step.hpp"
#include "host/bench/variants/variants.hpp"

namespace strainfinger::bench {

struct Method {
  std::string_view name;
  bool usesFloat;
  /// Of the samples for counting on the emulated processors, every how many-th: slow methods count fewer.
  int stride;
};

/// The firmware's locator, from conditioned strains: gate and fit.
inline firmware::Fit fitOf(const TableImage& tables, firmware::FitMode mode, const Sample& sample) {
  return firmware::locate(tables, mode, sample.strain_q32,
                          firmware::gateEnergy(tables.constants, sample.strain_q32));
}

/// Calls visit(Method, f) for each of ours; f(sample) gives a firmware::Fit or a Contact.
template <typename Visit>
void visitOurs(const NoiseTables& tables, Visit&& visit) {
  using enum firmware::FitMode;
  const TableImage& usual = tables.usual;
  visit(Method{"ours: refined", false, 1}, [&](const Sample& s) { return fitOf(usual, kRefined, s); });
  visit(Method{"ours: refined with sigmas", false, 1},
        [&](const Sample& s) { return firmware::estimate(usual.constants, fitOf(usual, kRefined, s)); });
  visit(Method{"ours: three-point", false, 1}, [&](const Sample& s) { return fitOf(usual, kThreePoint, s); });
  visit(Method{"ours: refined in every window", false, 4},
        [&](const Sample& s) { return fitOf(tables.everyWindow, kRefined, s); });
  for (const Variant& variant : kVariants)
    visit(Method{variant.name, false, 1}, [&](const Sample& s) { return variant.fitOf(usual, s); });
}

/// Likewise for the others, all in float; f(sample) gives a Place<float>.
template <typename Visit>
void visitOthers(const Knowledge& known, Visit&& visit) {
  constexpr int kTextbookSteps = 5;
  visit(Method{"centroid", true, 1}, [](const Sample& s) { return centroid(s.strain); });
  visit(Method{"parabola", true, 1}, [](const Sample& s) { return parabola(s.strain); });
  visit(Method{"template correlation", true, 1},
        [&](const Sample& s) { return correlateTemplates(known.templates, s.strain); });
  visit(Method{"perceptron 7-16-16-3", true, 1}, [&](const Sample& s) { return known.perceptron(s.strain); });
  visit(Method{"Gauss-Newton from centroid", true, 1}, [&](const Sample& s) {
    const auto start = startAtCentroid(known.response, s.strain);
    return gaussNewton<kWindow>(known.response, s.strain, start, kTextbookSteps).place;
  });
  visit(Method{"Levenberg-Marquardt from centroid", true, 16}, [&](const Sample& s) {
    return levenbergMarquardt(known.response, s.strain, startAtCentroid(known.response, s.strain));
  });
  visit(Method{"scan + Gauss-Newton", true, 1}, [&](const Sample& s) {
    const auto start = startsOfScan(known.scan, s.strain)[0];
    return gaussNewton<kWindow>(known.response, s.strain, start, kTextbookSteps).place;
  });
  visit(Method{"scan + Gauss-Newton on both sides", true, 1},
        [&](const Sample& s) { return scanAndStep(known.response, known.scan, s.strain).place; });
  visit(Method{"scan + Gauss-Newton + global in doubt", true, 1},
        [&](const Sample& s) { return scanOrSearch(known.response, known.scan, known.global, s.strain); });
  visit(Method{"scan + Levenberg-Marquardt", true, 16}, [&](const Sample& s) {
    return levenbergMarquardt(known.response, s.strain, startsOfScan(known.scan, s.strain)[0]);
  });
  visit(Method{"global search", true, 32},
        [&](const Sample& s) { return GlobalSearch(known.response, known.global)(s.strain); });
}

}  // namespace strainfinger::bench
