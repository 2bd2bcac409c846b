#pragma once
// Every method of the benchmark by its name: the one list for this machine and the emulated processors.

#include <string_view>

#include "firmware/core/estimate.hpp"
#include "firmware/core/locator.hpp"
#include "host/bench/methods/bundle.hpp"
#include "host/bench/methods/levenberg_marquardt.hpp"
#include "host/bench/methods/scan_and_step.hpp"

namespace strainfinger::bench {

struct Method {
  std::string_view name;
  bool usesFloat;
  /// Of the samples for counting on the emulated processors, every how many-th: slow methods count fewer.
  int stride;
};

/// The firmware's locator with tables of one kind. It is large and lives where it is made, as in a pipeline.
class OwnLocator {
 public:
  OwnLocator(const TableImage& tables, firmware::FitMode mode) : tables_(tables), locator_(mode) {}

  /// From conditioned strains of a touch of which nothing is known yet, to the end of the search.
  const OwnLocator& locate(const Sample& sample) {
    firmware::locateOnce(tables_, sample.strain_q32, firmware::allGauges(kGauges), locator_);
    return *this;
  }
  /// The answer in units, with its standard errors.
  Contact contact() const {
    return firmware::estimate(tables_.constants, locator_.answer(),
                              firmware::unitErrors(locator_.linearisation()), 0);
  }

 private:
  const TableImage& tables_;
  firmware::Locator locator_;
};

/// Calls visit(Method, f) for each of ours; f(sample) gives an OwnLocator that has the answer, or a Contact.
template <typename Visit>
void visitOurs(const NoiseTables& tables, Visit&& visit) {
  using enum firmware::FitMode;
  OwnLocator line(tables.line, kRefined), three(tables.line, kThreePoint),
      anyWidth(tables.anyWidth, kRefined);
  visit(
      Method{"ours: width known", false, 1}, [&](const Sample& s) -> const auto& { return line.locate(s); });
  visit(Method{"ours: width known with sigmas", false, 1},
        [&](const Sample& s) { return line.locate(s).contact(); });
  visit(
      Method{"ours: three-point", false, 1}, [&](const Sample& s) -> const auto& { return three.locate(s); });
  visit(
      Method{"ours: width fitted", false, 1}, [&](const Sample& s) -> const auto& {
        return anyWidth.locate(s);
      });
  visit(Method{"ours: width fitted with sigmas", false, 1},
        [&](const Sample& s) { return anyWidth.locate(s).contact(); });
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
  visit(Method{"scan + Gauss-Newton with the width", true, 1},
        [&](const Sample& s) { return scanAndFitWidth(known.patches, known.scan, s.strain); });
  visit(Method{"scan + Levenberg-Marquardt with the width", true, 16}, [&](const Sample& s) {
    return levenbergMarquardtOfWidth(known.patches, s.strain, startsOfScan(known.scan, s.strain)[0]);
  });
  visit(Method{"global search with the width", true, 32},
        [&](const Sample& s) { return GlobalWidthSearch(known.patches, known.widths)(s.strain); });
}

}  // namespace strainfinger::bench
