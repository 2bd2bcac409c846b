#pragma once
// What bench_model found, for people and for programs.

#include <string>
#include <vector>

#include "host/bench/model/measured_case.hpp"
#include "host/plot/picture.hpp"

namespace strainfinger::bench {

/// Cases of one task of which no other is both faster and closer, fastest first.
std::vector<MeasuredCase> paretoOf(const std::vector<MeasuredCase>& cases, const std::string& task);

/// A row a case: task, method, knob, value, error, time_s.
std::string modelCsv(const std::vector<MeasuredCase>& cases);

/// A row a saving: what, needed_s, all_s, ratio.
std::string savingsCsv(const std::vector<Saving>& savings);

/// Both as a page: by task what is on the Pareto front, the times that have bars, and the savings.
std::string modelMarkdown(const std::vector<MeasuredCase>& cases, const std::vector<Saving>& savings);

/// Error against time, a panel a task, the front as a line.
plot::Picture paretoPicture(const std::vector<MeasuredCase>& cases);

}  // namespace strainfinger::bench
