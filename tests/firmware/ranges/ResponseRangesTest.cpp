// Table lookups with bounds for numbers: any tables, distances and second moments.
#include <algorithm>

#include "firmware/core/response.hpp"
#include "tests/firmware/ranges/any_tables.hpp"
#include "tests/firmware/ranges/ranges_group.hpp"

using namespace strainfinger;
using namespace strainfinger::firmware;

TEST_GROUP_BASE(ResponseRanges, RangesGroup) {
  static constexpr std::int64_t kOne = 1 << 15;

  static void checkResponse(const ResponsePatch& patch, const Number& s, const Number& t) {
    const Response response = responseOf(patch, s, t);
    checkWithin(response.value_q30, -kOne * (kOne - 1), kOne * (kOne - 1));
    checkWithin(response.slope_q30, -2 * kOne * (kOne - 1), 2 * kOne * (kOne - 1));
    checkWithin(response.widening_q30, -2 * kOne * (kOne - 1), 2 * kOne * (kOne - 1));
  }
  /// Cells 0 .. first .. first + width .. 1, each of the highest rate.
  static TableConstants cellsAround(int first, int width) {
    TableConstants constants{};
    auto& edge = constants.cell_edge_q15;
    const auto add = [&](int end) {
      if (end > edge[constants.cell_count]) edge[++constants.cell_count] = static_cast<std::uint16_t>(end);
    };
    add(first);
    add(first + width);
    add(1 << 15);
    for (std::size_t i = 0; i < constants.cell_count; ++i)
      constants.cell_rate_q8[i] =
          static_cast<std::uint16_t>(std::min((2 << 23) / (edge[i + 1] - edge[i]) + 1, 0xFFFF));
    CHECK_TRUE(usableCells(constants));
    return constants;
  }
  static void checkCells(const TableConstants& constants) {
    forEachWay([&] {
      const MomentCell cell = momentCell(constants, Number(0, 1 << kMomentBits));
      CHECK_TRUE(cell.cell >= 0 && cell.cell < constants.cell_count);
      checkWithin(cell.s_q15, -kOne, kOne);
      checkWithin(cell.rate_q8, 0, 0xFFFF);
    });
  }
};

TEST(ResponseRanges, APatchOverflowsNothing) {
  forEachPatch([](const ResponsePatch& patch) {
    CHECK_TRUE(usable(patch));
    checkResponse(patch, within(kOne), within(kOne));
  });
  checkNone();
}

TEST(ResponseRanges, APatchOfTwoFullWeightsWouldOverflow) {
  responseOf({32767, 32767, 32767, 0, 0, 0}, within(kOne), within(kOne));
  checkSome();
}

TEST(ResponseRanges, AShapeOfAnyPointsOverflowsNothing) {
  for (const int first : {-128, 127})
    for (const int second : {-128, 127}) {
      GaugeDepths::Shape shape{};
      shape[0] = static_cast<std::int8_t>(first);
      shape[1] = static_cast<std::int8_t>(second);
      const ShapePoint anywhere{0, Number(0, kOne)};
      checkWithin(shapeAt(shape, kMostDepthShapeShift, anywhere), -3 * kOne, 3 * kOne);
    }
  checkNone();
}

TEST(ResponseRanges, CellsOfAnyWidthOverflowNothing) {
  for (int width = 1; width < 1 << 15; width += width < 64 ? 1 : width / 64)
    for (const int first : {0, (1 << 15) - width}) checkCells(cellsAround(first, width));
  checkNone();
}

TEST(ResponseRanges, ASecondMomentOfAnyNumberWouldOverflowAtTheHighestRate) {
  TableConstants constants = cellsAround(0, 1 << 15);
  constants.cell_rate_q8[0] = 0xFFFF;
  momentCell(constants, Number(0, 0x7FFFFFFF));
  checkSome();
}

TEST(ResponseRanges, EveryDistanceHasANodeOfTheTable) {
  for (int nodes = kLeastNodes; nodes <= kMostPatches; ++nodes) {
    TableConstants constants{};
    constants.node_count = static_cast<std::uint16_t>(nodes);
    for (const std::uint32_t distance_q32 :
         {0u, 1u, 0x3FFFFFFFu, 0x7FFFFFFFu, 0x80000000u, 0x80000001u, 0xFFFFFFFFu}) {
      const AngleNode node = angleNode(constants, distance_q32);
      CHECK_TRUE(node.node >= 0 && node.node < nodes);
      checkWithin(node.t_q15, -kOne, kOne - 1);
    }
    checkWithin(halfNode_q32(constants), 1, 1 << 27);
  }
  checkNone();
}
