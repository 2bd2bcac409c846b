#include "firmware/core/fit.hpp"

#include <algorithm>
#include <bit>

#include "firmware/core/response.hpp"

namespace strainfinger::firmware {
namespace {

/// A step turns a contact by at most 2.8 degrees, where the responses are still nearly linear.
constexpr Number kMostTurn_q32 = 1 << 25;
/// A step changes the second moment by at most 1/16 + 5/16 of it.
constexpr Number kMostWidening_q20 = 1 << (kMomentBits - 4);

constexpr int kLoadExponent = 2;  ///< of the loads' columns, whose entries have 15 bits
constexpr int kMostEntry = (1 << (15 - kLoadExponent)) - 1;

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// |tangential| / (friction * normal) [* 2^15], at most 1: how much of the contact slips (Mindlin).
Number slip_q15(const TableConstants& constants, const ContactState& contact) {
  const Number most = contact.normal > 0 ? scaled<8>(contact.normal, constants.friction_q8) : 0;
  const Number pull = magnitude(contact.tangential);
  const int down = std::max(bitWidth(most) - 15, 0);
  if (pull >= most) return 1 << 15;
  return ((pull >> down) << 15) / (most >> down);
}

/// A contact with what its lookups share. The pressure's second moment is m, that of the tangential traction
/// m (2 - slip), here as a fraction of twice the largest m.
class ContactModel {
 public:
  struct Loads {
    Number normal, tangential;
  };
  struct Reading {
    Loads loads;           ///< responses
    Number angle, moment;  ///< slopes: readings per half node and per unit of second moment
    Number predicted;
  };

  ContactModel(const TableImage& tables, const ContactState& contact, Number slip_q15)
      : tables_(tables), contact_(contact), normalCell_(momentCell(tables.constants, contact.moment_q20)) {
    const Number part_q16 = (1 << 16) - slip_q15;
    const Number tangentialMoment_q20 = scaled<16>(contact.moment_q20, part_q16);
    tangentialCell_ = momentCell(tables.constants, tangentialMoment_q20);
    tangentialRate_q8_ = scaled<16>(tangentialCell_.rate_q8, part_q16);
    if (tables.depths.areKnown()) {
      asNormal_ = momentCell(tables.constants, contact.moment_q20 / 2);
      asTangential_ = momentCell(tables.constants, 2 * tangentialMoment_q20);
    }
    const Loads loads{contact.normal, contact.tangential};
    seen_ = {loads, mirrored(loads)};
  }

  /// Responses.
  Loads loadsAt(int gauge) const {
    const AngleNode node = nodeOf(gauge);
    return oriented(node, valuesAt(node));
  }
  Number predictedAt(int gauge) const {
    const AngleNode node = nodeOf(gauge);
    return static_cast<Number>(readingOf(node, valuesAt(node)) >> kReadingBits);
  }

  Reading at(int gauge) const {
    const AngleNode node = nodeOf(gauge);
    const Response normal = responseOf(normalPatch(node, normalCell_), normalCell_.s_q15, node.t_q15);
    const Response tangential =
        responseOf(tangentialPatch(node, tangentialCell_), tangentialCell_.s_q15, node.t_q15);
    const Loads values{normal.value, tangential.value};
    // Turning the contact forward brings a gauge beyond it nearer, one behind it farther away.
    const Wide farther = readingOf(node, {normal.slope, tangential.slope});
    const Wide wider = readingOf(node, {widening(normal.widening, normalCell_.rate_q8),
                                        widening(tangential.widening, tangentialRate_q8_)});
    return {oriented(node, values),
            -static_cast<Number>((node.mirrored ? -farther : farther) >> kReadingBits),
            static_cast<Number>(wider >> kReadingBits),
            static_cast<Number>(readingOf(node, values) >> kReadingBits)};
  }

  struct Depth {
    Loads loads;
    Number predicted;
  };
  /// What a gauge's own depth adds.
  Depth depthAt(int gauge) const {
    const GaugeDepths& depths = tables_.depths;
    const AngleNode node = nodeOf(gauge);
    const ShapePoint point = shapePoint(distance_q32(gauge));
    const Number normalSlope = slopeOf(normalPatch(node, asTangential_), asTangential_.s_q15, node.t_q15),
                 tangentialSlope = slopeOf(tangentialPatch(node, asNormal_), asNormal_.s_q15, node.t_q15);
    const Number normal = scaled<11>(tangentialSlope, depths.normal_turn_q11) +
                          shapeAt(depths.normal_shape, depths.shape_shift, point);
    const Number tangential = scaled<11>(normalSlope, depths.tangential_turn_q11) +
                              scaled<15>(tangentialAt(node), depths.tangential_q15) +
                              shapeAt(depths.tangential_shape, depths.shape_shift, point);
    const Number depth = depths.steps[index(gauge)];
    const Loads added{limited(scaled<kDepthBits>(normal, depth), kMostValue),
                      limited(scaled<kDepthBits>(tangential, depth), kMostValue)};
    return {oriented(node, added), static_cast<Number>(readingOf(node, added) >> kReadingBits)};
  }

 private:
  static constexpr int kReadingBits = 16;
  static constexpr int kDepthBits = 7;
  static constexpr Number kMostValue = (1 << 15) - 1;

  std::uint32_t distance_q32(int gauge) const {
    return tables_.gauge_angle_q32[index(gauge)] - contact_.angle_q32;
  }
  AngleNode nodeOf(int gauge) const { return angleNode(tables_.constants, distance_q32(gauge)); }
  const ResponsePatch& normalPatch(const AngleNode& node, const MomentCell& moment) const {
    return tables_.patch(node.node, moment.cell).normal;
  }
  const ResponsePatch& tangentialPatch(const AngleNode& node, const MomentCell& moment) const {
    return tables_.patch(node.node, moment.cell).tangential;
  }
  Loads valuesAt(const AngleNode& node) const {
    return {valueOf(normalPatch(node, normalCell_), normalCell_.s_q15, node.t_q15), tangentialAt(node)};
  }
  Number tangentialAt(const AngleNode& node) const {
    return valueOf(tangentialPatch(node, tangentialCell_), tangentialCell_.s_q15, node.t_q15);
  }
  /// value * rate / 2^8, of which both have less than 18 bits.
  static Number widening(Number value, Number rate_q8) {
    return mulHigh(value * (1 << 12), rate_q8 * (1 << 12));
  }

  /// On the mirrored side one of the two has the other sign.
  Loads mirrored(const Loads& loads) const {
    const int sign = tables_.constants.mirror_sign;
    return {sign * loads.normal, -sign * loads.tangential};
  }
  Loads oriented(const AngleNode& node, const Loads& responses) const {
    return node.mirrored ? mirrored(responses) : responses;
  }
  /// [* 2^kReadingBits] of responses as they are on the side that isn't mirrored.
  Wide readingOf(const AngleNode& node, const Loads& responses) const {
    const Loads& loads = seen_[node.mirrored ? 1 : 0];
    return Wide{loads.normal} * responses.normal + Wide{loads.tangential} * responses.tangential;
  }

  const TableImage& tables_;
  const ContactState& contact_;
  MomentCell normalCell_;
  MomentCell tangentialCell_;
  MomentCell asNormal_{};      ///< of a tangential load, at the pressure's second moment
  MomentCell asTangential_{};  ///< of a normal load, at the tangential one's
  Number tangentialRate_q8_;
  std::array<Loads, 2> seen_;  ///< the contact's loads from its either side
};

int loadsOf(int contact) { return 2 * contact; }
int angleOf(const Hypothesis& hypothesis, int contact) { return 2 * hypothesis.contacts + contact; }
int momentOf(const Hypothesis& hypothesis, int contact) { return 3 * hypothesis.contacts + contact; }

bool isInReach(const TableConstants& constants, std::uint32_t distance_q32) {
  return distance_q32 + constants.reach_q32 <= 2 * constants.reach_q32;
}

/// Gauges of the hypothesis whose readings change with a contact.
GaugeSet gaugesInReach(const TableImage& tables, const Hypothesis& hypothesis, const ContactStates& contacts,
                       GaugeSet gauges) {
  GaugeSet inReach = 0;
  for (int k = 0; k < hypothesis.contacts; ++k)
    for (int gauge = 0; gauge < tables.constants.gauge_count; ++gauge)
      if (isInReach(tables.constants, tables.gauge_angle_q32[index(gauge)] - contacts[index(k)].angle_q32))
        inReach |= GaugeSet{1} << gauge;
  return inReach & gauges;
}

void chooseRows(const TableImage& tables, Linearisation& linearisation) {
  const Hypothesis& hypothesis = linearisation.hypothesis;
  GaugeSet left = gaugesInReach(tables, hypothesis, linearisation.at,
                                hypothesis.exact != 0 ? hypothesis.exact : hypothesis.gauges);
  int rows = 0;
  for (; left != 0 && rows < kMostRows; left &= left - 1)
    linearisation.gauge[index(rows++)] = static_cast<std::uint8_t>(std::countr_zero(left));
  linearisation.usedRows = static_cast<std::uint8_t>(rows);
  if (rows % 2 != 0)
    for (int i = 0; i < hypothesis.unknowns(); ++i) linearisation.column[index(i)][index(rows)] = 0;
  linearisation.rows = static_cast<std::uint8_t>((rows + 1) & ~1);
}

using WideColumn = std::array<Number, kMostRows>;

/// A column as numbers below 2^13, scaled by a power of two.
void setColumn(Linearisation& linearisation, int unknown, const WideColumn& entries) {
  Number bits = 1;
  for (int row = 0; row < linearisation.usedRows; ++row) bits |= magnitude(entries[index(row)]);
  const int exponent = std::max(bitWidth(bits) - kColumnBits, -8);
  linearisation.exponent[index(unknown)] = static_cast<std::int8_t>(exponent);
  Rows& column = linearisation.column[index(unknown)];
  for (int row = 0; row < linearisation.usedRows; ++row)
    column[index(row)] = static_cast<Short>(exponent >= 0 ? entries[index(row)] >> exponent
                                                          : entries[index(row)] << -exponent);
}

/// Another pass, which fingers without a calibration don't pay for.
void addDepths(const TableImage& tables, const ContactModel& model, int contact,
               Linearisation& linearisation) {
  const auto add = [](Short& entry, Number response) {
    entry = static_cast<Short>(limited(Number{entry} + (response >> kLoadExponent), kMostEntry));
  };
  for (int gauge = 0, row = 0; gauge < tables.constants.gauge_count; ++gauge) {
    const bool isRow = row < linearisation.usedRows && linearisation.gauge[index(row)] == gauge;
    if (tables.depths.steps[index(gauge)] != 0) {
      const ContactModel::Depth depth = model.depthAt(gauge);
      linearisation.predicted[index(gauge)] += depth.predicted;
      if (isRow) {
        add(linearisation.column[index(loadsOf(contact))][index(row)], depth.loads.normal);
        add(linearisation.column[index(loadsOf(contact) + 1)][index(row)], depth.loads.tangential);
      }
    }
    row += isRow ? 1 : 0;
  }
}

void lineariseContact(const TableImage& tables, int contact, Linearisation& linearisation) {
  const Hypothesis& hypothesis = linearisation.hypothesis;
  const ContactState& state = linearisation.at[index(contact)];
  const ContactModel model(tables, state, slip_q15(tables.constants, state));
  Rows& normal = linearisation.column[index(loadsOf(contact))];
  Rows& tangential = linearisation.column[index(loadsOf(contact) + 1)];
  WideColumn angle, moment;
  for (int gauge = 0, row = 0; gauge < tables.constants.gauge_count; ++gauge) {
    Number& predicted = linearisation.predicted[index(gauge)];
    if (contact == 0) predicted = 0;
    if (row >= linearisation.usedRows || linearisation.gauge[index(row)] != gauge) {
      predicted += model.predictedAt(gauge);
      continue;
    }
    const ContactModel::Reading reading = model.at(gauge);
    normal[index(row)] = static_cast<Short>(reading.loads.normal >> kLoadExponent);
    tangential[index(row)] = static_cast<Short>(reading.loads.tangential >> kLoadExponent);
    angle[index(row)] = reading.angle;
    moment[index(row)] = reading.moment;
    predicted += reading.predicted;
    ++row;
  }
  if (tables.depths.areKnown()) addDepths(tables, model, contact, linearisation);
  linearisation.exponent[index(loadsOf(contact))] = linearisation.exponent[index(loadsOf(contact) + 1)] =
      kLoadExponent;
  setColumn(linearisation, angleOf(hypothesis, contact), angle);
  if (hypothesis.widthIsFree) setColumn(linearisation, momentOf(hypothesis, contact), moment);
}

/// [units of an unknown] as a step of its column.
Number stepOf(Number units, int exponent, int unitBits) {
  return shifted(units, exponent + kStepBits - unitBits, 1 << 28);
}

void setLimits(const TableConstants& constants, const Linearisation& linearisation, Vector& low,
               Vector& high) {
  const Hypothesis& hypothesis = linearisation.hypothesis;
  for (int i = 0; i < angleOf(hypothesis, 0); ++i) {
    low[index(i)] = -(1 << 28);
    high[index(i)] = 1 << 28;
  }
  for (int k = 0; k < hypothesis.contacts; ++k) {
    const int angle = angleOf(hypothesis, k);
    high[index(angle)] =
        stepOf((kMostTurn_q32 >> 15) * constants.node_count, linearisation.exponent[index(angle)], 15);
    low[index(angle)] = -high[index(angle)];
    if (!hypothesis.widthIsFree) continue;
    const int moment = momentOf(hypothesis, k), exponent = linearisation.exponent[index(moment)];
    const Number now = linearisation.at[index(k)].moment_q20;
    const Number most = kMostWidening_q20 + 5 * (now >> 4);
    high[index(moment)] = stepOf(std::min<Number>(most, (1 << kMomentBits) - now), exponent, kMomentBits);
    low[index(moment)] = stepOf(-std::min(most, now), exponent, kMomentBits);
  }
}

/// A step of a column in units of its unknown.
Number unitsOf(Number x_q14, int exponent, int unitBits, Number limit) {
  return shifted(x_q14, unitBits - kStepBits - exponent, limit);
}

void take(const TableConstants& constants, const Linearisation& linearisation, const Step& step,
          ContactStates& contacts) {
  const Hypothesis& hypothesis = linearisation.hypothesis;
  const auto units = [&](int unknown, int unitBits) {
    return unitsOf(step.x_q14[index(unknown)], linearisation.exponent[index(unknown)], unitBits, 1 << 28);
  };
  for (int k = 0; k < hypothesis.contacts; ++k) {
    ContactState& contact = contacts[index(k)];
    contact.normal = limited(contact.normal + units(loadsOf(k), 16), kMostLoad);
    contact.tangential = limited(contact.tangential + units(loadsOf(k) + 1, 16), kMostLoad);
    contact.angle_q32 += wrapped(scaled<15>(units(angleOf(hypothesis, k), 15), halfNode_q32(constants)));
    if (hypothesis.widthIsFree)
      contact.moment_q20 =
          clamped(contact.moment_q20 + units(momentOf(hypothesis, k), kMomentBits), 0, 1 << kMomentBits);
  }
}

/// The linear model holds for a step that turns a contact by at most this part of a pitch, changes its loads
/// by at most this part of the larger one, and its second moment by at most this part of it and of the
/// largest [log2]. What the model neglects grows with the step's square. On the default finger at 30 N/m it
/// is 0.06 of sigma RMS, at most 0.9 (FitTest, AShortStepIsAlmostTheLast).
constexpr int kShortTurnBits = 8, kShortLoadBits = 7, kShortWideningBits = 6, kShortMomentBits = 8;

bool isShort(const TableConstants& constants, const ContactState& from, const ContactState& to) {
  const std::uint32_t turned_q32 = to.angle_q32 - from.angle_q32;
  const std::uint32_t short_q32 = (std::uint32_t{1} << (32 - kShortTurnBits)) / constants.gauge_count;
  const Number load = larger(from.normal, magnitude(from.tangential)) >> kShortLoadBits;
  const Number moment = (from.moment_q20 >> kShortWideningBits) + (1 << (kMomentBits - kShortMomentBits));
  return turned_q32 + short_q32 <= 2 * short_q32 && magnitude(to.normal - from.normal) <= load &&
         magnitude(to.tangential - from.tangential) <= load &&
         magnitude(to.moment_q20 - from.moment_q20) <= moment;
}

/// Largest reduction of the residuals' squares by a step after which another would not matter: its square
/// over a reading's variance. A 64th of it makes no answer better, but of three readings, which may tell so
/// little that a small residual is a long step.
bool changesLittle(Wide reduction, const Hypothesis& hypothesis, const ScaledReadings& readings) {
  const Wide most = hypothesis.exact == 0 ? 256 : 32;
  return reduction < 64 ||
         (reduction < Wide{1} << 31 && reduction * reduction <= most * readings.noiseVariance_q4);
}

/// A step after which another would not matter. That of three readings is long where they tell little.
bool isConverged(const TableConstants& constants, const Linearisation& linearisation, const Step& step,
                 const ContactStates& to, const ScaledReadings& readings) {
  const Hypothesis& hypothesis = linearisation.hypothesis;
  if (changesLittle(step.reduction, hypothesis, readings)) return true;
  for (int k = 0; k < hypothesis.contacts; ++k)
    if (!isShort(constants, linearisation.at[index(k)], to[index(k)])) return false;
  return hypothesis.exact == 0;
}

}  // namespace

void linearise(const TableImage& tables, const Hypothesis& hypothesis, const ContactStates& contacts,
               Linearisation& linearisation) {
  linearisation.hypothesis = hypothesis;
  linearisation.at = contacts;
  chooseRows(tables, linearisation);
  for (int k = 0; k < hypothesis.contacts; ++k) lineariseContact(tables, k, linearisation);
  decompose(linearisation.column, linearisation.rows, hypothesis.unknowns(), linearisation.decomposition);
}

Solution step(const TableImage& tables, const Linearisation& linearisation, const ScaledReadings& readings) {
  const Hypothesis& hypothesis = linearisation.hypothesis;
  Rows residual;
  residual[index(linearisation.rows - (linearisation.rows > 0 ? 1 : 0))] = 0;
  Wide energy = 0;
  std::array<Short, kMaxGauges> rest;
  for (int gauge = 0; gauge < tables.constants.gauge_count; ++gauge) {
    const Short each = shortened(readings.value[index(gauge)] - linearisation.predicted[index(gauge)]);
    rest[index(gauge)] = each;
    if (contains(hypothesis.gauges, gauge)) energy += Wide{each} * each;
  }
  for (int row = 0; row < linearisation.usedRows; ++row)
    residual[index(row)] = rest[linearisation.gauge[index(row)]];
  Vector low, high;
  setLimits(tables.constants, linearisation, low, high);
  const Step best =
      solve(linearisation.decomposition, linearisation.column, linearisation.rows, residual, low, high);
  Solution solution{hypothesis, linearisation.at, false, std::max<Wide>(energy - best.reduction, 0)};
  take(tables.constants, linearisation, best, solution.contact);
  solution.converged = isConverged(tables.constants, linearisation, best, solution.contact, readings);
  return solution;
}

Solution fitLoads(const TableImage& tables, const Hypothesis& hypothesis, const ContactStates& contacts,
                  const ScaledReadings& readings, Linearisation& scratch) {
  constexpr Number kHalfSlips_q15 = 1 << 14;
  auto& columns = scratch.column;
  alignas(4) Rows residual;
  const GaugeSet inReach = gaugesInReach(tables, hypothesis, contacts, hypothesis.gauges);
  int rows = 0;
  Wide energy = 0;
  for (int k = 0; k < hypothesis.contacts; ++k) {
    const ContactModel model(tables, contacts[index(k)], kHalfSlips_q15);
    rows = 0;
    for (int gauge = 0; gauge < tables.constants.gauge_count && rows < kMostRows; ++gauge) {
      if (!contains(hypothesis.gauges, gauge)) continue;
      const Number reading = readings.value[index(gauge)];
      if (k == 0) energy += Wide{reading} * reading;
      if (!contains(inReach, gauge)) continue;
      const ContactModel::Loads loads = model.loadsAt(gauge);
      columns[index(loadsOf(k))][index(rows)] = static_cast<Short>(loads.normal >> kLoadExponent);
      columns[index(loadsOf(k) + 1)][index(rows)] = static_cast<Short>(loads.tangential >> kLoadExponent);
      residual[index(rows++)] = static_cast<Short>(reading);
    }
  }
  const int unknowns = 2 * hypothesis.contacts;
  if (rows % 2 != 0) {
    for (int i = 0; i < unknowns; ++i) columns[index(i)][index(rows)] = 0;
    residual[index(rows++)] = 0;
  }
  decompose(columns, rows, unknowns, scratch.decomposition);
  Vector low, high;
  low.fill(-kMostLoad);
  high.fill(kMostLoad);
  const Step best = solve(scratch.decomposition, columns, rows, residual, low, high);
  Solution solution{hypothesis, contacts, false, std::max<Wide>(energy - best.reduction, 0)};
  for (int k = 0; k < hypothesis.contacts; ++k) {
    solution.contact[index(k)].normal = best.x_q14[index(loadsOf(k))];
    solution.contact[index(k)].tangential = best.x_q14[index(loadsOf(k) + 1)];
  }
  return solution;
}

Solution fit(const TableImage& tables, const Hypothesis& hypothesis, const ContactStates& start,
             const ScaledReadings& readings, int mostSteps, Linearisation& linearisation) {
  Solution solution{hypothesis, start};
  for (int i = 0; i < mostSteps && !solution.converged; ++i) {
    linearise(tables, hypothesis, solution.contact, linearisation);
    solution = step(tables, linearisation, readings);
  }
  return solution;
}

}  // namespace strainfinger::firmware
