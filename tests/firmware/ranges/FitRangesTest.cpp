// The fit's own code with bounds for numbers: any tables, contacts and readings of their formats.
#include "firmware/core/fit.cpp"  // NOLINT: its arithmetic is what is proved

#include "tests/firmware/ranges/any_tables.hpp"
#include "tests/firmware/ranges/ranges_group.hpp"

using namespace strainfinger;
using namespace strainfinger::firmware;

TEST_GROUP_BASE(FitRanges, RangesGroup) {
  static constexpr std::int64_t kMostResponse = (1 << 15) - 1, kMostResponse_q30 = kMostResponse << 15;
  static constexpr std::int64_t kMostMoment = 1 << kMomentBits;
  static constexpr std::int64_t kMostPredicted = 1 << 20;  ///< of one contact
  static constexpr std::int64_t kMostSlope = 1 << 30;  ///< of a prediction with an angle or a second moment
  static constexpr int kLeastExponent = -30, kMostExponent = 31 - kColumnBits + 5;

  static ContactState anyContact(std::int64_t load = 1 << 20) {
    return {0, within(load), within(load), {0, kMostMoment}};
  }
  /// Bounds forget that less is pulled than would slip: twice as much as there is.
  static Number anySlip() { return {0, 1 << 16}; }
  /// Calls visit for tables of which each response is as large as it may be at some place.
  template <typename Visit>
  static void forEachTables(Visit visit) {
    forEachPatch([&](const ResponsePatch& normal) {
      forEachPatch([&](const ResponsePatch& tangential) {
        const auto tables = tablesOf({normal, tangential});
        CHECK_TRUE(checkTableImage(*tables) == TableFault::kNone);
        visit(*tables);
      });
    });
  }
  /// Calls visit for gauges on either side of a contact at 0, at both ends of a node's angles and at the node
  /// itself: between these a response only grows or falls where the patch has one weight.
  template <typename Visit>
  static void forEachDistance(const TableImage& tables, Visit visit) {
    const auto half_q32 = static_cast<std::uint32_t>(halfNode_q32(tables.constants).least());
    for (const std::uint32_t distance_q32 : {0u, half_q32, 2 * half_q32 - 1}) {
      visit(distance_q32);
      visit(0 - distance_q32);
    }
  }
  /// Depths as large as their words hold them, each of either sign.
  template <typename Visit>
  static void forEachDepths(TableImage & tables, Visit visit) {
    GaugeDepths& depths = tables.depths;
    visit();
    depths.step_nm = 1;
    depths.shape_shift = kMostDepthShapeShift;
    for (const int slope : {-0x8000, 0x7FFF})
      for (const int shape : {-128, 127}) {
        depths.steps.fill(-128);
        depths.normal_turn_q11 = depths.tangential_turn_q11 = depths.tangential_q15 =
            static_cast<std::int16_t>(slope);
        depths.normal_shape.fill(static_cast<std::int8_t>(shape));
        depths.tangential_shape = depths.normal_shape;
        depths.tangential_shape[0] = static_cast<std::int8_t>(-1 - shape);
        CHECK_TRUE(usable(depths));
        visit();
      }
  }
  /// Of the first gauge.
  static void checkReading(const ContactModel& model) {
    const ContactModel::Reading reading = model.at(0);
    checkWithin(reading.loads_q30.normal, -kMostResponse_q30, kMostResponse_q30);
    checkWithin(reading.loads_q30.tangential, -kMostResponse_q30, kMostResponse_q30);
    checkWithin(reading.predicted, -kMostPredicted, kMostPredicted);
    checkWithin(model.predictedAt(0), -kMostPredicted, kMostPredicted);
    const ContactModel::Depth depth = model.depthAt(0);
    checkWithin(depth.loads.normal, -kMostResponse, kMostResponse);
    checkWithin(depth.loads.tangential, -kMostResponse, kMostResponse);
    checkWithin(depth.predicted, -kMostPredicted, kMostPredicted);
    checkWithin(reading.angle, -kMostSlope, kMostSlope);
    checkWithin(reading.moment, -kMostSlope, kMostSlope);
  }
  /// Both contacts, of any width, with columns of any entries at these exponents.
  static Linearisation anyLinearisation(int exponent) {
    Linearisation any;
    any.hypothesis = {kMostContacts, true, 0xFFFFFFFF};
    any.at.fill(anyContact());
    any.exponent.fill(static_cast<std::int8_t>(exponent));
    for (int k = 0; k < kMostContacts; ++k)
      any.exponent[index(loadsOf(k))] = any.exponent[index(loadsOf(k) + 1)] = kLoadExponent;
    return any;
  }
  /// Any that setLimits() lets through.
  static void takeAnyStep(const TableConstants& constants, const Linearisation& linearisation) {
    Vector low, high;
    setLimits(constants, linearisation, low, high);
    Step any;
    for (std::size_t i = 0; i < kMostUnknowns; ++i) any.x_q14[i] = {low[i].least(), high[i].most()};
    ContactStates contacts = linearisation.at;
    take(constants, linearisation, any, contacts);
    for (const ContactState& contact : contacts) {
      checkWithin(contact.normal, -(1 << 20), 1 << 20);
      checkWithin(contact.tangential, -(1 << 20), 1 << 20);
      checkWithin(contact.moment_q20, 0, kMostMoment);
    }
  }
  static Short anyWeight() { return Short(0, 1 << kWeightBits); }
  static ScaledReadings anyReadings() {
    ScaledReadings any;
    any.value.fill(Short::any());
    any.weight_q14.fill(anyWeight());
    any.variances.reading_q4 = 0x7FFFFFFF;
    return any;
  }
};

TEST(FitRanges, SlipOverflowsNothing) {
  TableConstants constants{};
  for (const int friction_q8 : {0, 1, 256, 0xFFFF}) {
    constants.friction_q8 = static_cast<std::uint16_t>(friction_q8);
    forEachWay([&] {
      const Number slip = slip_q15(constants, anyContact());
      checkWithin(slip, anySlip().least(), anySlip().most());
    });
  }
  checkNone();
}

TEST(FitRanges, ReadingsOfAContactOverflowNothing) {
  const ContactState contact = anyContact();
  forEachTables([&](TableImage& tables) {
    forEachDepths(tables, [&] {
      forEachDistance(tables, [&](std::uint32_t distance_q32) {
        tables.gauge_angle_q32[0] = distance_q32;
        forEachWay([&] {
          const ContactState any = contact;  // that knows its way only from here on
          checkReading(ContactModel(tables, any, anySlip()));
        });
      });
    });
  });
  checkNone();
}

TEST(FitRanges, ReadingsOfLoadsBeyondTheLimitWouldOverflow) {
  const auto tables = tablesOf({{0, 32767}, {0, 32767}});
  const ContactState contact = anyContact(std::int64_t{1} << 30);
  forEachWay([&] {
    const ContactState any = contact;
    ContactModel(*tables, any, anySlip()).at(0);
  });
  checkSome();
}

TEST(FitRanges, AColumnOfAnySlopesOverflowsNothing) {
  const auto ways = forEachWay([] {
    WideColumn entries;
    entries.fill(within(kMostSlope));
    Rows column;
    std::int8_t exponent = 0;
    setColumn(entries, 3, 0, column, exponent);
    CHECK_TRUE(exponent >= 0 && exponent <= 31 - kColumnBits);
    for (const Short& entry : std::span(column).first(3))
      checkWithin(entry, -(1 << kColumnBits), (1 << kColumnBits) - 1);
  });
  CHECK_TRUE(ways > 15);
  checkNone();
}

TEST(FitRanges, LoadsOfAnyResponsesAndWeightsOverflowNothing) {
  forEachWay([&] {
    std::array<Rows, 2> columns;
    const Number weight_q14 = anyWeight();
    setLoads({within(1 << 30), within(1 << 30)}, weight_q14, 0, columns.data());
    for (const Rows& column : columns) checkWithin(column[0], -(1 << kColumnBits), 1 << kColumnBits);
  });
  checkNone();
}

TEST(FitRanges, LimitsOfAStepOverflowNothing) {
  for (const int nodes : {kLeastNodes, kMostPatches})
    for (int exponent = kLeastExponent; exponent <= kMostExponent; ++exponent) {
      TableConstants constants{};
      constants.node_count = static_cast<std::uint16_t>(nodes);
      forEachWay([&] {
        Vector low, high;
        setLimits(constants, anyLinearisation(exponent), low, high);
        for (const Number& most : high) checkWithin(most, 0, 1 << 28);
        for (const Number& least : low) checkWithin(least, -(1 << 28), 0);
      });
    }
  checkNone();
}

TEST(FitRanges, AStepThatIsTakenOverflowsNothing) {
  for (const int nodes : {kLeastNodes, kMostPatches})
    for (int exponent = kLeastExponent; exponent <= kMostExponent; ++exponent) {
      TableConstants constants{};
      constants.node_count = static_cast<std::uint16_t>(nodes);
      forEachWay([&] { takeAnyStep(constants, anyLinearisation(exponent)); });
    }
  checkNone();
}

TEST(FitRanges, ConvergenceOfAnyReductionOverflowsNothing) {
  forEachWay([] { changesLittle(Wide(-kMostReduction, kMostReduction), Hypothesis{}, anyReadings()); });
  checkNone();
}

TEST(FitRanges, ConvergenceOfAnyStepOverflowsNothing) {
  TableConstants constants{};
  for (const int gauges : {1, kMaxGauges}) {
    constants.gauge_count = static_cast<decltype(constants.gauge_count)>(gauges);
    for (const int farther : {0, kSlopesHoldBits})
      forEachWay([&] { isShort(constants, anyContact(), anyContact(), farther); });
  }
  checkNone();
}

TEST(FitRanges, AWholeStepOverflowsNothing) {
  const auto tables = tablesOf({});
  Linearisation linearisation = anyLinearisation(0);
  linearisation.hypothesis = {1, false, 0xFFFFFFFF};
  linearisation.predicted.fill(within(4 * kMostPredicted));  // of both contacts and their gauges' depths
  for (Rows& column : linearisation.column) column.fill(within<Short>(1 << kColumnBits));
  forEachWay([&] {
    decompose(linearisation.column, kMaxGauges, linearisation.hypothesis.unknowns(),
              linearisation.decomposition);
    const Solution solution = step(*tables, linearisation, anyReadings());
    checkWithin(solution.residualEnergy, 0, kMostLeft);
  });
  checkNone();
}

TEST(FitRanges, LoadsOfTwoContactsOverflowNothing) {
  const auto tables = tablesOf({{0, 0, 32767, 0, 0, 0}, {0, 0, 0, 0, 0, 32767}});
  const ContactStates contacts{ContactState{0, 0, 0, 300'000}, ContactState{1u << 30, 0, 0, 20}};
  const ScaledReadings readings = anyReadings();
  Linearisation scratch;
  forEachWay([&] {
    const Hypothesis two{2, false, 0xFFFFFFFF};
    const Solution solution =
        fitLoads(*tables, two, contacts, allOf(*tables, two, readings), readings.weight_q14, scratch);
    for (const ContactState& contact : solution.contact) checkWithin(contact.normal, -(1 << 20), 1 << 20);
    checkWithin(solution.residualEnergy, 0, kMostLeft);
  });
  checkNone();
}
