#pragma once
// What bench_model measures: ways to an answer, each with its error, its time and what it is a part of.

#include <functional>
#include <string>
#include <vector>

namespace strainfinger::bench {

/// One way to an answer.
struct MeasuredCase {
  std::string task, method;
  std::string knob;             ///< what was turned, with its unit
  double value;                 ///< of the knob
  double error;                 ///< worst, per peak; NaN where only the time is of interest
  std::function<double()> run;  ///< all of the work; returns a number of the answer, so that none is left out
  double time_s = 0;            ///< filled in by measuring

  std::string name() const;
};

/// Something that isn't computed unless it is asked for: two cases whose times compare.
struct Saving {
  std::string what;
  MeasuredCase needed, all;

  double ratio() const { return all.time_s / needed.time_s; }
};

// The default finger's. Errors are against 50 digits: sums, contacts and singular values of their own.
std::vector<MeasuredCase> tableCases();    // 1024 angles of e_rr per N/m, normal and tangential
std::vector<MeasuredCase> fieldCases();    // eight rows at 360 angles at the gauges
std::vector<MeasuredCase> contactCases();  // flat, frictionless, 2 mm; every kind by its time alone
std::vector<MeasuredCase> svdCases();      // 2 mm, n_c = 300, the first fourteen values
std::vector<MeasuredCase> paperCases();    // the data of the figures, and the claims

std::vector<Saving> fieldSavings();
std::vector<Saving> svdSavings();

}  // namespace strainfinger::bench
