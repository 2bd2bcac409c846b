#pragma once
// The disturbance matrix as a page and as a table to compute with.

#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "host/bench/matrix/tally.hpp"

namespace strainfinger::bench {

struct MatrixRow {
  std::string name;
  Tally tally;
};

/// Markdown, the worst rows, worst first: by silent wrong places, then by answers beyond six sigmas, healthy
/// gauges blamed, ghosts, and touches missed.
std::string matrixPage(std::vector<MatrixRow> rows, int touches, std::uint64_t seed);

/// CSV: one row a disturbance, in the order given.
void writeMatrixCsv(std::FILE* stream, const std::vector<MatrixRow>& rows);

}  // namespace strainfinger::bench
