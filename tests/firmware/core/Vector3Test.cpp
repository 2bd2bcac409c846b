#include "firmware/core/vector3.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <random>

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::firmware;

TEST_GROUP(Vector3){/// Of a gauge at a signed distance from the middle, of 16 bits.
                    static int unfolded(const FoldedWeights& folded, int distance){
                        const auto at = static_cast<std::size_t>(std::abs(distance));
const int odd = distance == 0 ? 0 : folded[at + kWindowReach];
return std::clamp(folded[at] + (distance < 0 ? -odd : odd), -32768, 32767);
}
}
;

// The proof of ranges takes their length from the table's.
TEST(Vector3, ColumnsAreTheWeightsBeforeTheyWereFolded) {
  std::printf("seed 9 ");
  std::mt19937 random(9);
  std::uniform_int_distribution<int> any(-32768, 32767);
  FitRow row{};
  for (FoldedWeights* weights : {&row.basis[0], &row.basis[1], &row.gradient[0], &row.gradient[1]})
    for (std::int16_t& weight : *weights) weight = static_cast<std::int16_t>(any(random));
  for (const GaugeTriple& gauges : kTripleList) {
    const Columns columns = columnsOf(row, gauges);
    for (std::size_t i = 0; i < gauges.size(); ++i)
      for (std::size_t j = 0; j < 2; ++j) {
        LONGS_EQUAL(unfolded(row.basis[j], gauges[i]), columns.basis[j][i]);
        LONGS_EQUAL(unfolded(row.gradient[j], gauges[i]), columns.gradient[j][i]);
      }
  }
}
