#include "firmware/core/response.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "tests/firmware/core/model_ring.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::firmware;

namespace {
constexpr std::uint32_t kHalfTurn = std::uint32_t{1} << 31;
constexpr Number kEnd = 1 << 15;
}  // namespace

TEST_GROUP(DepthShape) {};

TEST(DepthShape, IsStraightBetweenItsPointsAndTheSameOnEitherSide) {
  GaugeDepths::Shape shape;
  for (std::size_t i = 0; i < kDepthShapePoints; ++i)
    shape[i] = static_cast<std::int8_t>(i % 3 == 0 ? -128 : i % 3 == 1 ? 127 : 5 * static_cast<int>(i));
  for (std::uint64_t distance = 0; distance < std::uint64_t{1} << 32; distance += 12'345'677) {
    const double size = std::abs(std::remainder(std::ldexp(static_cast<double>(distance), -32), 1));
    const double position = 2 * (kDepthShapePoints - 1) * size;
    const auto part = static_cast<std::size_t>(std::min<double>(position, kDepthShapePoints - 2));
    const double expected = std::lerp(shape[part], shape[part + 1], position - static_cast<double>(part));
    const Number value = shapeAt(shape, 4, shapePoint(static_cast<std::uint32_t>(distance)));
    DOUBLES_EQUAL(16 * expected, value, 1.2);
  }
}

TEST(DepthShape, EndsAtTheContactAndHalfWayRound) {
  GaugeDepths::Shape shape{};
  shape.front() = 100;
  shape.back() = -128;
  LONGS_EQUAL(100, shapeAt(shape, 0, shapePoint(0)));
  LONGS_EQUAL(-128 * 256, shapeAt(shape, 8, shapePoint(kHalfTurn)));
}

TEST_GROUP(AngleNode) {
  TableConstants constants{};

  void setup() override { constants.node_count = 96; }
  /// The distance that a node and what is beside it stand for [turns * 2^32].
  double distanceOf(const AngleNode& node) const {
    const double nodes = node.node + (node.t_q15 + kEnd) / 65536.0;
    const double size = nodes / constants.node_count * kHalfTurn;
    return node.mirrored ? std::ldexp(1, 32) - size : size;
  }
};

TEST(AngleNode, EveryDistanceIsBesideItsNode) {
  std::printf("seed 103 ");
  std::mt19937 random(103);
  for (const int nodes : {kLeastNodes, 96, 244, kMostPatches}) {
    constants.node_count = static_cast<std::uint16_t>(nodes);
    for (int i = 0; i < 10'000; ++i) {
      const auto distance = static_cast<std::uint32_t>(random());
      const AngleNode node = angleNode(constants, distance);
      CHECK(node.node >= 0 && node.node < nodes && node.t_q15 >= -kEnd && node.t_q15 < kEnd);
      DOUBLES_EQUAL(distance, distanceOf(node), std::ldexp(1, 16) / nodes);
    }
  }
}

TEST(AngleNode, TheClockwiseSideIsMirrored) {
  for (const std::uint32_t distance : {1u, 12345678u, kHalfTurn - 1}) {
    const AngleNode ahead = angleNode(constants, distance), behind = angleNode(constants, 0 - distance);
    CHECK_FALSE(ahead.mirrored);
    CHECK_TRUE(behind.mirrored);
    LONGS_EQUAL(ahead.node, behind.node);
    LONGS_EQUAL(ahead.t_q15, behind.t_q15);
  }
}

TEST(AngleNode, TheFarSideIsTheEndOfTheLastNode) {
  for (const std::uint32_t distance : {kHalfTurn - 1, kHalfTurn, kHalfTurn + 1}) {
    LONGS_EQUAL(95, angleNode(constants, distance).node);
    LONGS_EQUAL(kEnd - 1, angleNode(constants, distance).t_q15);
  }
}

TEST(AngleNode, AtTheContactTheFirstNodeBegins) {
  LONGS_EQUAL(0, angleNode(constants, 0).node);
  LONGS_EQUAL(-kEnd, angleNode(constants, 0).t_q15);
  LONGS_EQUAL(0, angleNode(constants, 0xFFFF'FFFF).node);
  LONGS_EQUAL(-kEnd, angleNode(constants, 0xFFFF'FFFF).t_q15);
}

TEST_GROUP(MomentCell) {
  const ModelRing ring{ModelRing::asDrawn()};
  const TableConstants& constants = ring.constants();

  Number edge_q20(int cell) const {
    return constants.cell_edge_q15[static_cast<std::size_t>(cell)] << (kMomentBits - 15);
  }
};

TEST(MomentCell, CellsBeginAtTheirEdges) {
  for (int cell = 0; cell < constants.cell_count; ++cell) {
    const MomentCell first = momentCell(constants, edge_q20(cell));
    LONGS_EQUAL(cell, first.cell);
    DOUBLES_EQUAL(-kEnd, first.s_q15, kEnd / 256);
    const MomentCell last = momentCell(constants, edge_q20(cell + 1) - 1);
    LONGS_EQUAL(cell, last.cell);
    DOUBLES_EQUAL(kEnd, last.s_q15, kEnd / 256);
  }
}

TEST(MomentCell, TheWidestIsTheEndOfTheLastCell) {
  const MomentCell widest = momentCell(constants, 1 << kMomentBits);
  LONGS_EQUAL(constants.cell_count - 1, widest.cell);
  DOUBLES_EQUAL(kEnd, widest.s_q15, kEnd / 256);
}

TEST(MomentCell, TheRateIsWhatTheMomentMovesThePlaceBy) {
  for (int cell = 0; cell < constants.cell_count; ++cell) {
    const Number from = edge_q20(cell) + 100, to = edge_q20(cell + 1) - 100;
    const MomentCell one = momentCell(constants, from), other = momentCell(constants, to);
    const double moved = std::ldexp(other.s_q15 - one.s_q15, -15);
    DOUBLES_EQUAL(std::ldexp(one.rate_q8, -8), moved / std::ldexp(to - from, -kMomentBits),
                  std::ldexp(one.rate_q8, -8) / 200);
  }
}

TEST_GROUP(Response) {
  std::mt19937 random{104};

  void setup() override { std::printf("seed 104 "); }
  double uniform(double least, double most) { return std::uniform_real_distribution<>(least, most)(random); }

  /// What a gauge reads of a normal load of 1 N/m, and of a tangential one in full sliding, whose second
  /// moment is the pressure's own.
  static double exact(const ModelRing& ring, bool isNormal, double distance_pitch, double width_mm) {
    const Press pressed{-distance_pitch, 1, 0, width_mm}, slid{-distance_pitch, 1, 1, width_mm};
    const double normal = ring.strains(pressed)[0];
    return isNormal ? normal : ring.strains(slid)[0] - normal;
  }
  /// The same by the tables.
  static double tabled(const ModelRing& ring, bool isNormal, double distance_pitch, double width_mm) {
    const TableConstants& constants = ring.constants();
    const ContactState state = ring.stateOf({-distance_pitch, 1, 0, width_mm}, 0);
    const AngleNode node = angleNode(constants, 0 - state.angle_q32);
    const MomentCell cell = momentCell(constants, isNormal ? state.moment_q20 : state.moment_q20 / 2);
    const PatchPair& pair = ring.tables().patch(node.node, cell.cell);
    const int sign = isNormal ? constants.mirror_sign : -constants.mirror_sign;
    return (node.mirrored ? sign : 1) *
           std::ldexp(responseOf(isNormal ? pair.normal : pair.tangential, cell.s_q15, node.t_q15).value_q30,
                      -15);
  }
  /// Strain that a value of 1 is, per N/m: an amplitude of 1 reads 2^-16 of it.
  static double strainOfOne(const ModelRing& ring) {
    return std::ldexp(1 / ring.pressOf({0, 1 << 20, 0, 0}, 0).normal, 20 - 16 - 32);
  }
  /// A patch is off by 5.2e-4 of the largest response at most, and rounded.
  void checkEverywhere(const config::FingerConfig& config) {
    const ModelRing ring(config);
    const double one = strainOfOne(ring), widest_mm = config.contact.width_m.value_or(8e-3) * 1e3;
    for (int i = 0; i < 2000; ++i) {
      const double away = uniform(-8, 8),
                   width_mm = config.contact.width_m ? widest_mm : uniform(0, widest_mm);
      for (const bool isNormal : {true, false})
        DOUBLES_EQUAL(exact(ring, isNormal, away, width_mm) / one, tabled(ring, isNormal, away, width_mm),
                      5.5e-4 * 32768 + 2);
    }
  }
  ResponsePatch anyPatch() {
    ResponsePatch patch{};
    for (std::int16_t& weight : patch) weight = static_cast<std::int16_t>(uniform(-5000, 5000));
    return patch;
  }
};

TEST(Response, EveryPlaceIsWithinTheTablesErrorOfTheElasticModel) { checkEverywhere(ModelRing::asDrawn()); }

TEST(Response, SoItIsForHoopAndShearStrain) {
  checkEverywhere(ModelRing::asDrawn(16, StrainComponent::kHoop));
  checkEverywhere(ModelRing::asDrawn(16, StrainComponent::kShear));
}

TEST(Response, SoItIsForContactsOfAKnownWidth) {
  for (const double width_mm : {0.0, 2.0, 5.0}) checkEverywhere(ModelRing::ofKnownWidth(width_mm));
}

TEST(Response, ThePatchIsAQuadraticInBoth) {
  for (int i = 0; i < 1000; ++i) {
    const ResponsePatch patch = anyPatch();
    const double s = uniform(-1, 1), t = uniform(-1, 1);
    const double value =
        patch[0] + patch[1] * s + patch[2] * t + patch[3] * t * t + patch[4] * s * t + patch[5] * s * s;
    const auto fixed = [](double part) { return static_cast<Number>(std::lround(std::ldexp(part, 15))); };
    const Response response = responseOf(patch, fixed(s), fixed(t));
    DOUBLES_EQUAL(value, std::ldexp(response.value_q30, -15), 2);
    DOUBLES_EQUAL(patch[2] + 2 * patch[3] * t + patch[4] * s, std::ldexp(response.slope_q30, -15), 2);
    DOUBLES_EQUAL(patch[1] + 2 * patch[5] * s + patch[4] * t, std::ldexp(response.widening_q30, -15), 2);
  }
}

TEST(Response, WeightsAsLargeAsTablesMayHaveThemStayWithinTheirWords) {
  for (std::size_t i = 0; i < 6; ++i)
    for (const std::int16_t weight : {std::int16_t{32767}, std::int16_t{-32767}})
      for (const Number s : {-kEnd, 0, kEnd})
        for (const Number t : {-kEnd, 0, kEnd}) {
          ResponsePatch patch{};
          patch[i] = weight;
          const Response response = responseOf(patch, s, t);
          const auto size = [](Number sum_q30) { return std::abs(std::ldexp(sum_q30, -15)); };
          CHECK(size(response.value_q30) <= kEnd);
          CHECK(size(response.slope_q30) <= 2 * kEnd && size(response.widening_q30) <= 2 * kEnd);
        }
}
