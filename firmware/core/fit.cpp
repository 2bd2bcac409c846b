#include "firmware/core/fit.hpp"

#include <algorithm>
#include <bit>

#include "firmware/core/response.hpp"

namespace strainfinger::firmware {
namespace {

/// A step turns a contact by at most 2.8 degrees, where the responses are still nearly linear.
constexpr Number kMostTurn_q32 = 1 << 25;
/// A step changes the second moment by at most 1/16 of the largest one and 5/16 of its own value.
constexpr Number kMostWidening_q20 = 1 << (kMomentBits - 4);

constexpr int kLoadExponent = 3;  ///< of the loads' columns: responses of 15 bits become entries of 12
constexpr int kLoadStepBits = kLoadExponent + kStepBits - 16;  ///< a step of a load is an amplitude * 2^this
/// Limit of a residual energy, so that thresholds and other energies can be added to it.
constexpr int kMostEnergyBits = 48;

/// |tangential| / (friction * normal) [* 2^15], at most 1: how much of the contact slips (Mindlin).
Number slip_q15(const TableConstants& constants, const ContactState& contact) {
  const Number most = contact.normal > 0 ? scaled<8>(contact.normal, constants.friction_q8) : 0;
  const Number pull = magnitude(contact.tangential);
  const int down = std::max(bitWidth(most) - 15, 0);
  if (pull >= most) return 1 << 15;
  return ((pull >> down) << 15) / (most >> down);
}

/// A contact, with what its lookups at all gauges share. The pressure's second moment is m, the tangential
/// traction's m (2 - slip), kept as a fraction of twice the largest m.
class ContactModel {
 public:
  struct Loads {
    Number normal, tangential;
  };
  struct Reading {
    Loads loads_q30;   ///< responses
    Number predicted;  ///< [readings]
    Number angle;      ///< slope over the contact's angle: readings per half node * 2^-kAngleExponent
    Number moment;     ///< slope over its second moment: readings per unit * 2^-momentExponent()
  };

  ContactModel(const TableImage& tables, const ContactState& contact, Number slip_q15)
      : tables_(tables),
        angle_q32_(contact.angle_q32),
        normalCell_(momentCell(tables.constants, contact.moment_q20)) {
    const Number part_q16 = (1 << 16) - slip_q15;
    const Number tangentialMoment_q20 = scaled<16>(contact.moment_q20, part_q16);
    tangentialCell_ = momentCell(tables.constants, tangentialMoment_q20);
    if (tables.depths.areKnown()) {
      asNormal_ = momentCell(tables.constants, contact.moment_q20 / 2);
      asTangential_ = momentCell(tables.constants, 2 * tangentialMoment_q20);
    }
    const Wide wider = Wide{contact.normal} * normalCell_.rate_q8,
               widerTangential = Wide{contact.tangential} * scaled<16>(tangentialCell_.rate_q8, part_q16);
    Wide bits = magnitude(wider);
    bits |= magnitude(widerTangential);
    const int down = std::max(bitWidth(bits) - kFactorBits, 0);
    momentExponent_ = down - 7;
    const Loads moment{static_cast<Number>(wider >> down), static_cast<Number>(widerTangential >> down)};
    const Loads angle{contact.normal * (1 << kAngleBits), contact.tangential * (1 << kAngleBits)};
    const Loads seen{2 * contact.normal, 2 * contact.tangential};
    const int sign = tables.constants.mirror_sign;
    side_[0] = {seen, {-angle.normal, -angle.tangential}, moment, 1, 1};
    side_[1] = {mirrored(seen), mirrored(angle), mirrored(moment), sign, -sign};
  }

  static constexpr int kAngleBits = 10;  ///< spare bits of the loads, by which columns get more digits
  static constexpr int kAngleExponent = 1 - kAngleBits;
  int momentExponent() const { return momentExponent_; }

  Loads loadsAt_q30(int gauge) const {
    const AngleNode node = nodeOf(gauge);
    return oriented(node, {normalAt(node).value_q30, tangentialAt(node).value_q30});
  }

  Number predictedAt(int gauge) const {
    const AngleNode node = nodeOf(gauge);
    return together(side_[node.mirrored ? 1 : 0].loads, normalAt(node).value_q30,
                    tangentialAt(node).value_q30);
  }

  Reading at(int gauge) const {
    const AngleNode node = nodeOf(gauge);
    const Response normal = normalAt(node), tangential = tangentialAt(node);
    const Side& side = side_[node.mirrored ? 1 : 0];
    return {oriented(node, {normal.value_q30, tangential.value_q30}),
            together(side.loads, normal.value_q30, tangential.value_q30),
            together(side.angle, normal.slope_q30, tangential.slope_q30),
            together(side.moment, normal.widening_q30, tangential.widening_q30)};
  }

  struct Depth {
    Loads loads;
    Number predicted;
  };
  /// What a gauge adds because it lies deeper, or less deep, than in the drawing.
  Depth depthAt(int gauge) const {
    const GaugeDepths& depths = tables_.depths;
    const AngleNode node = nodeOf(gauge);
    const PatchPair* const patches = patchesOf(node);
    const ShapePoint point = shapePoint(distance_q32(gauge));
    const Number normalSlope = responseOf(patches[asTangential_.cell].normal, asTangential_.s_q15, node.t_q15)
                                   .slope_q30,
                 tangentialSlope =
                     responseOf(patches[asNormal_.cell].tangential, asNormal_.s_q15, node.t_q15).slope_q30;
    const Number normal = scaled<GaugeDepths::kTurnBits + 15>(tangentialSlope, depths.normal_turn_q11) +
                          shapeAt(depths.normal_shape, depths.shape_shift, point);
    const Number tangential =
        scaled<GaugeDepths::kTurnBits + 15>(normalSlope, depths.tangential_turn_q11) +
        scaled<GaugeDepths::kFactorBits>(tangentialAt(node).value_q30 >> 15, depths.tangential_q15) +
        shapeAt(depths.tangential_shape, depths.shape_shift, point);
    const Number depth = depths.steps[index(gauge)];
    const Loads added{limited(scaled<GaugeDepths::kStepsBits>(normal, depth), kMostValue),
                      limited(scaled<GaugeDepths::kStepsBits>(tangential, depth), kMostValue)};
    return {oriented(node, added), together(side_[node.mirrored ? 1 : 0].loads, added.normal * (1 << 15),
                                            added.tangential * (1 << 15))};
  }

 private:
  static constexpr int kFactorBits = 30;  ///< of the factors of slopes
  static constexpr Number kMostValue = (1 << 15) - 1;

  /// Factors of the tables' responses for gauges on one side of the contact. The tables have the responses of
  /// the side that isn't mirrored.
  struct Side {
    Loads loads;   ///< * 2
    Loads angle;   ///< of slopes; negative where turning the contact forward brings it nearer to the gauge
    Loads moment;  ///< of slopes; they include ds / d(moment)
    int normalSign, tangentialSign;  ///< of responses on this side
  };

  std::uint32_t distance_q32(int gauge) const { return tables_.gauge_angle_q32[index(gauge)] - angle_q32_; }
  AngleNode nodeOf(int gauge) const { return angleNode(tables_.constants, distance_q32(gauge)); }
  /// The patches of all cells at a node.
  const PatchPair* patchesOf(const AngleNode& node) const { return &tables_.patch(node.node, 0); }
  Response normalAt(const AngleNode& node) const {
    return responseOf(patchesOf(node)[normalCell_.cell].normal, normalCell_.s_q15, node.t_q15);
  }
  Response tangentialAt(const AngleNode& node) const {
    return responseOf(patchesOf(node)[tangentialCell_.cell].tangential, tangentialCell_.s_q15, node.t_q15);
  }
  static Number together(const Loads& loads, Number normal_q30, Number tangential_q30) {
    return static_cast<Number>((Wide{loads.normal} * normal_q30 + Wide{loads.tangential} * tangential_q30) >>
                               32);
  }
  /// On the mirrored side the response to one of the two loads has the opposite sign.
  Loads mirrored(const Loads& loads) const {
    const int sign = tables_.constants.mirror_sign;
    return {sign * loads.normal, -sign * loads.tangential};
  }
  Loads oriented(const AngleNode& node, const Loads& responses) const {
    const Side& side = side_[node.mirrored ? 1 : 0];
    return {side.normalSign * responses.normal, side.tangentialSign * responses.tangential};
  }

  const TableImage& tables_;
  std::uint32_t angle_q32_;
  MomentCell normalCell_;
  MomentCell tangentialCell_;
  MomentCell asNormal_{};      ///< to look up tangential responses at the pressure's second moment
  MomentCell asTangential_{};  ///< to look up normal responses at the traction's second moment
  int momentExponent_;
  std::array<Side, 2> side_;
};

GaugeSet fittedGauges(const Hypothesis& hypothesis) {
  return hypothesis.exact != 0 ? hypothesis.exact : hypothesis.gauges;
}

using WideColumn = std::array<Number, kMaxGauges>;

/// Scales a column by a power of two to entries of kColumnBits. `exponent`: that of `entries`.
void setColumn(const WideColumn& entries, int gauges, int exponent, Rows& column, std::int8_t& scaledBy) {
  Number bits = 1;
  for (int gauge = 0; gauge < gauges; ++gauge) bits |= signlessBits(entries[index(gauge)]);
  const int down = std::max(bitWidth(bits) - kColumnBits, 0);
  scaledBy = static_cast<std::int8_t>(exponent + down);
  for (int gauge = 0; gauge < gauges; ++gauge)
    column[index(gauge)] = static_cast<Short>(saturated<kColumnBits>(entries[index(gauge)] >> down));
}

/// Zeroes the rows of gauges that are not fitted, and those that fill columns up to a multiple of 4.
void clearRows(const Hypothesis& hypothesis, int unknowns, int gauges,
               std::array<Rows, kMostUnknowns>& column) {
  const GaugeSet out = ~fittedGauges(hypothesis) & allGauges(rowsOf(gauges));
  for (GaugeSet left = out; left != 0; left &= left - 1)
    for (int i = 0; i < unknowns; ++i) column[index(i)][index(std::countr_zero(left))] = 0;
}

/// `columns`: those of the normal and the tangential load, one behind the other.
void setLoads(const ContactModel::Loads& responses_q30, Number weight_q14, int gauge, Rows* columns) {
  constexpr int kDown = 15 + kLoadExponent, kHalf = 1 << (kDown - 1);
  const auto entry = [&](Number response_q30) {
    return static_cast<Short>(scaled<kDown + kWeightBits>(response_q30 + kHalf, weight_q14));
  };
  columns[0][index(gauge)] = entry(responses_q30.normal);
  columns[1][index(gauge)] = entry(responses_q30.tangential);
}

/// A pass of its own, so that fingers without calibrated depths don't pay for it.
void addDepths(const TableImage& tables, const ContactModel& model, int contact, const Weights& weight_q14,
               Linearisation& linearisation) {
  for (int gauge = 0; gauge < tables.constants.gauge_count; ++gauge) {
    if (tables.depths.steps[index(gauge)] == 0) continue;
    const ContactModel::Depth depth = model.depthAt(gauge);
    linearisation.predicted[index(gauge)] += depth.predicted;
    const auto add = [&](Rows& column, Number response) {
      Short& entry = column[index(gauge)];
      const Number weighted = scaled<kLoadExponent + kWeightBits>(response, weight_q14[index(gauge)]);
      entry = static_cast<Short>(saturated<kColumnBits>(entry + weighted));
    };
    add(linearisation.column[index(loadsOf(contact))], depth.loads.normal);
    add(linearisation.column[index(loadsOf(contact) + 1)], depth.loads.tangential);
  }
}

void lineariseContact(const TableImage& tables, int contact, const Weights& weight_q14,
                      Linearisation& linearisation) {
  const Hypothesis& hypothesis = linearisation.hypothesis;
  const ContactState& state = linearisation.at[index(contact)];
  const ContactModel model(tables, state, slip_q15(tables.constants, state));
  const int gauges = tables.constants.gauge_count;
  Rows* const loads = &linearisation.column[index(loadsOf(contact))];
  WideColumn angle, moment;
  for (int gauge = 0; gauge < gauges; ++gauge) {
    const ContactModel::Reading reading = model.at(gauge);
    const Number weight = weight_q14[index(gauge)];
    setLoads(reading.loads_q30, weight, gauge, loads);
    angle[index(gauge)] = scaled<kWeightBits>(reading.angle, weight);
    moment[index(gauge)] = scaled<kWeightBits>(reading.moment, weight);
    Number& predicted = linearisation.predicted[index(gauge)];
    predicted = reading.predicted + (contact == 0 ? 0 : predicted);
  }
  if (tables.depths.areKnown()) addDepths(tables, model, contact, weight_q14, linearisation);
  const auto set = [&](int unknown, const WideColumn& entries, int exponent) {
    setColumn(entries, gauges, exponent, linearisation.column[index(unknown)],
              linearisation.exponent[index(unknown)]);
  };
  linearisation.exponent[index(loadsOf(contact))] = linearisation.exponent[index(loadsOf(contact) + 1)] =
      kLoadExponent;
  set(angleOf(hypothesis, contact), angle, ContactModel::kAngleExponent);
  if (hypothesis.widthIsFree) set(momentOf(hypothesis, contact), moment, model.momentExponent());
}

/// Weighted residuals; 0 for gauges that don't count. `expectedShift`: if the residuals need another shift,
/// they are computed a second time.
template <typename Left>
Residual residualOf(int gauges, GaugeSet counted, int expectedShift, Left leftOf) {
  Residual residual;
  const auto gather = [&](int shift) {
    residual.shift = shift;
    const Number half = (1 << shift) / 2;
    Number bits = 0;
    for (int gauge = 0; gauge < gauges; ++gauge) {
      const Number left = leftOf(index(gauge)) * static_cast<Number>(counted >> gauge & 1);
      residual.value[index(gauge)] = static_cast<Short>(saturated<kColumnBits>((left + half) >> shift));
      bits |= signlessBits(Number{left});  // a copy: the overflow proof would keep the address of `left`
    }
    return std::clamp(bitWidth(bits) - kColumnBits, 0, kMostResidualShift);
  };
  if (const int shift = gather(expectedShift); shift != expectedShift) gather(shift);
  for (int row = gauges; row < rowsOf(gauges); ++row) residual.value[index(row)] = 0;
  return residual;
}

Residual residualOf(int gauges, const Linearisation& linearisation, const ScaledReadings& readings) {
  return residualOf(gauges, linearisation.hypothesis.gauges, 0,
                    [&](std::size_t gauge) { return readings.left(gauge, linearisation.predicted[gauge]); });
}

/// A change of an unknown, in its own units, as a step in units of its column.
Number stepOf(Number units, int exponent, int unitBits) {
  return shifted(units, exponent + kStepBits - unitBits, 1 << kStepLimitBits);
}

void setLimits(const TableConstants& constants, const Linearisation& linearisation, Vector& low,
               Vector& high) {
  const Hypothesis& hypothesis = linearisation.hypothesis;
  for (int i = 0; i < angleOf(hypothesis, 0); ++i) {
    low[index(i)] = -(1 << kStepLimitBits);
    high[index(i)] = 1 << kStepLimitBits;
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

/// The residual energy after a step, by the linear model.
Wide leftOf(Wide energy, Wide reduction) {
  return lesser(std::max<Wide>(energy - reduction, 0), Wide{1} << kMostEnergyBits);
}

void take(const TableConstants& constants, const Linearisation& linearisation, const Step& step,
          ContactStates& contacts) {
  const Hypothesis& hypothesis = linearisation.hypothesis;
  const auto units = [&](int unknown, int unitBits) {
    return shifted(step.x_q14[index(unknown)], unitBits - kStepBits - linearisation.exponent[index(unknown)],
                   1 << kStepLimitBits);
  };
  for (int k = 0; k < hypothesis.contacts; ++k) {
    ContactState& contact = contacts[index(k)];
    const auto load = [&](Number from, int unknown) {
      return limited(from + (step.x_q14[index(unknown)] >> kLoadStepBits), kMostLoad);
    };
    contact.normal = load(contact.normal, loadsOf(k));
    contact.tangential = load(contact.tangential, loadsOf(k) + 1);
    contact.angle_q32 += wrapped(scaled<15>(units(angleOf(hypothesis, k), 15), halfNode_q32(constants)));
    if (hypothesis.widthIsFree)
      contact.moment_q20 =
          clamped(contact.moment_q20 + units(momentOf(hypothesis, k), kMomentBits), 0, 1 << kMomentBits);
  }
}

/// [log2] A step is short, so that the linear model holds, if it turns a contact by at most this part of a
/// pitch, changes its loads by at most this part of the larger one, and its second moment by at most these
/// parts of itself and of the largest one. The error of the model grows with the step's square: on the
/// default finger at 30 N/m it is 0.06 of sigma RMS, at most 0.9 (FitTest, AShortStepIsAlmostTheLast).
constexpr int kShortTurnBits = 8, kShortLoadBits = 7, kShortWideningBits = 6, kShortMomentBits = 8;
/// [log2] Columns are kept for steps so many times longer: answers to a sliding touch are within 0.13 of
/// sigma RMS of those by new columns (LocatorTest, FollowsAMovingTouchWithTheAnswersOfOneSetAlone).
constexpr int kSlopesHoldBits = 3;

/// `farther`: [log2] of a factor on the limits.
bool isShort(const TableConstants& constants, const ContactState& from, const ContactState& to,
             int farther = 0) {
  const Number load = larger(from.normal, magnitude(from.tangential)) >> (kShortLoadBits - farther);
  const Number moment =
      (from.moment_q20 >> (kShortWideningBits - farther)) + (1 << (kMomentBits - kShortMomentBits + farther));
  return isShortTurn(constants, to.angle_q32 - from.angle_q32, farther) &&
         magnitude(to.normal - from.normal) <= load && magnitude(to.tangential - from.tangential) <= load &&
         magnitude(to.moment_q20 - from.moment_q20) <= moment;
}

/// A step reduces the sum of squares so little that another would not matter: by less than 64 squared units
/// of weighted readings, or by at most 64 units times the noise's standard deviation. Three readings may
/// depend so little on an unknown that a small residual makes a long step: for them 16, and 6 times.
bool changesLittle(Wide reduction, const Hypothesis& hypothesis, const ScaledReadings& readings) {
  const Wide most = hypothesis.exact == 0 ? 256 : 2;
  return reduction < (hypothesis.exact == 0 ? 64 : 16) ||
         (reduction < Wide{1} << 31 && reduction * reduction <= most * readings.variances.noise_q4);
}

/// Another step would not matter. For three readings only the change of the energy says so.
bool isConverged(const TableConstants& constants, const Linearisation& linearisation, const Step& step,
                 const ContactStates& to, const ScaledReadings& readings) {
  const Hypothesis& hypothesis = linearisation.hypothesis;
  if (changesLittle(step.reduction, hypothesis, readings)) return true;
  for (int k = 0; k < hypothesis.contacts; ++k)
    if (!isShort(constants, linearisation.at[index(k)], to[index(k)])) return false;
  return hypothesis.exact == 0;
}

}  // namespace

bool isShortTurn(const TableConstants& constants, std::uint32_t turned_q32, int farther) {
  return areWithin_q32(turned_q32, 0,
                       (std::uint32_t{1} << (32 - kShortTurnBits)) / constants.gauge_count << farther);
}

bool isInReach(const TableImage& tables, const ContactState& contact, int gauge) {
  return areWithin_q32(tables.gauge_angle_q32[index(gauge)], contact.angle_q32, tables.constants.reach_q32);
}

void linearise(const TableImage& tables, const Hypothesis& hypothesis, const ContactStates& contacts,
               Linearisation& linearisation, const Weights& weight_q14) {
  const int gauges = tables.constants.gauge_count, unknowns = hypothesis.unknowns();
  linearisation.hypothesis = hypothesis;
  linearisation.at = linearisation.slopesAt = contacts;
  for (int k = 0; k < hypothesis.contacts; ++k) lineariseContact(tables, k, weight_q14, linearisation);
  clearRows(hypothesis, unknowns, gauges, linearisation.column);
  decompose(linearisation.column, rowsOf(gauges), unknowns, linearisation.decomposition);
}

void move(const TableImage& tables, const ContactStates& contacts, Linearisation& linearisation,
          const Weights& weight_q14) {
  const Hypothesis& hypothesis = linearisation.hypothesis;
  for (int k = 0; k < hypothesis.contacts; ++k)
    if (!isShort(tables.constants, linearisation.slopesAt[index(k)], contacts[index(k)], kSlopesHoldBits))
      return linearise(tables, hypothesis, contacts, linearisation, weight_q14);
  linearisation.at = contacts;
  for (int k = 0; k < hypothesis.contacts; ++k) {
    const ContactState& state = contacts[index(k)];
    const ContactModel model(tables, state, slip_q15(tables.constants, state));
    for (int gauge = 0; gauge < tables.constants.gauge_count; ++gauge) {
      Number& predicted = linearisation.predicted[index(gauge)];
      predicted = model.predictedAt(gauge) + (k == 0 ? 0 : predicted);
      if (tables.depths.steps[index(gauge)] != 0) predicted += model.depthAt(gauge).predicted;
    }
  }
}

Solution step(const TableImage& tables, const Linearisation& linearisation, const ScaledReadings& readings) {
  const Hypothesis& hypothesis = linearisation.hypothesis;
  const int gauges = tables.constants.gauge_count, rows = rowsOf(gauges);
  const Residual residual = residualOf(gauges, linearisation, readings);
  Vector low, high;
  setLimits(tables.constants, linearisation, low, high);
  const Step best = solve(linearisation.decomposition, linearisation.column, rows, residual, low, high);
  Solution solution{hypothesis, linearisation.at, false, leftOf(residual.energy(rows), best.reduction)};
  take(tables.constants, linearisation, best, solution.contact);
  solution.converged = isConverged(tables.constants, linearisation, best, solution.contact, readings);
  return solution;
}

Wide energyLeft(const TableImage& tables, const Linearisation& linearisation,
                const ScaledReadings& readings) {
  const int gauges = tables.constants.gauge_count;
  return residualOf(gauges, linearisation, readings).energy(rowsOf(gauges));
}

ContactStates partway(const ContactStates& from, const ContactStates& to, Wide promised, Wide missed) {
  constexpr int kPartBits = 8;
  const Wide both = promised + missed;
  const Wide part_q8 = both > 0 ? (std::max<Wide>(promised, 0) << kPartBits) / both : 0;
  const auto partOf = [&](Number way) { return static_cast<Number>((way * part_q8) >> kPartBits); };
  ContactStates between = from;
  for (std::size_t k = 0; k < between.size(); ++k) {
    between[k].angle_q32 += wrapped(partOf(static_cast<Number>(to[k].angle_q32 - from[k].angle_q32)));
    between[k].normal += partOf(to[k].normal - from[k].normal);
    between[k].tangential += partOf(to[k].tangential - from[k].tangential);
    between[k].moment_q20 += partOf(to[k].moment_q20 - from[k].moment_q20);
  }
  return between;
}

int descend(const TableImage& tables, const ScaledReadings& readings, Linearisation& linearisation,
            Solution& solution) {
  const auto left = [&] { return energyLeft(tables, linearisation, readings); };
  const ContactStates from = linearisation.at;
  const bool isExact = linearisation.slopesAt == from;
  const Wide before = left(), promised = solution.residualEnergy;
  move(tables, solution.contact, linearisation, readings.weight_q14);
  solution.residualEnergy = left();
  if (solution.residualEnergy < before) return 1;
  solution.contact = partway(from, solution.contact, before - promised, solution.residualEnergy - promised);
  move(tables, solution.contact, linearisation, readings.weight_q14);
  solution.residualEnergy = left();
  if (solution.residualEnergy < before) return 2;
  linearise(tables, solution.hypothesis, from, linearisation, readings.weight_q14);
  solution.contact = from;
  solution.residualEnergy = before;
  solution.converged = isExact;
  return kDescentMoves;
}

Residual allOf(const TableImage& tables, const Hypothesis& hypothesis, const ScaledReadings& readings) {
  return residualOf(tables.constants.gauge_count, hypothesis.gauges, 15 - kColumnBits,
                    [&](std::size_t gauge) { return readings.weighted(gauge); });
}

Solution fitLoads(const TableImage& tables, const Hypothesis& hypothesis, const ContactStates& contacts,
                  const Residual& readings, const Weights& weight_q14, Linearisation& scratch) {
  constexpr Number kHalfSlips_q15 = 1 << 14;
  const int gauges = tables.constants.gauge_count, rows = rowsOf(gauges), unknowns = 2 * hypothesis.contacts;
  for (int k = 0; k < hypothesis.contacts; ++k) {
    const ContactModel model(tables, contacts[index(k)], kHalfSlips_q15);
    for (int gauge = 0; gauge < gauges; ++gauge) {
      ContactModel::Loads loads_q30{0, 0};
      if (isInReach(tables, contacts[index(k)], gauge)) loads_q30 = model.loadsAt_q30(gauge);
      setLoads(loads_q30, weight_q14[index(gauge)], gauge, &scratch.column[index(loadsOf(k))]);
    }
  }
  clearRows(hypothesis, unknowns, gauges, scratch.column);
  decompose(scratch.column, rows, unknowns, scratch.decomposition);
  Vector low, high;
  low.fill(-(kMostLoad << kLoadStepBits));
  high.fill(kMostLoad << kLoadStepBits);
  const Step best = solve(scratch.decomposition, scratch.column, rows, readings, low, high);
  Solution solution{hypothesis, contacts, false, leftOf(readings.energy(rows), best.reduction)};
  for (int k = 0; k < hypothesis.contacts; ++k) {
    solution.contact[index(k)].normal = best.x_q14[index(loadsOf(k))] >> kLoadStepBits;
    solution.contact[index(k)].tangential = best.x_q14[index(loadsOf(k) + 1)] >> kLoadStepBits;
  }
  return solution;
}

Solution fit(const TableImage& tables, const Hypothesis& hypothesis, const ContactStates& start,
             const ScaledReadings& readings, int mostSteps, Linearisation& linearisation) {
  Solution solution{hypothesis, start};
  for (int i = 0; i < mostSteps && !solution.converged; ++i) {
    linearise(tables, hypothesis, solution.contact, linearisation, readings.weight_q14);
    solution = step(tables, linearisation, readings);
  }
  return solution;
}

}  // namespace strainfinger::firmware
