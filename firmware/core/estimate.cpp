#include "firmware/core/estimate.hpp"

#include <algorithm>
#include <bit>
#include <limits>

#include "firmware/core/response.hpp"
#include "firmware/core/units.hpp"

namespace strainfinger::firmware {
namespace {

constexpr std::int64_t kHalfTurn_q32 = std::int64_t{1} << 31;
/// Half nodes [* 2^kAngleBits] that are half a turn or more, whatever the number of nodes.
constexpr int kAngleBits = 15 + 8;
constexpr std::int64_t kMostHalfNodes = std::int64_t{1} << (kAngleBits + 11);
static_assert(kMostPatches <= 1 << 10);

/// Width [um] of the uniform pressure with this second moment [um^2].
std::uint32_t widthOf_um(std::uint64_t moment_um2) {
  return integerRoot(static_cast<std::uint32_t>(std::min<std::uint64_t>(12 * moment_um2, 0xFFFFFFFF)));
}

std::uint64_t moment_um2(const TableConstants& constants, std::int64_t moment_q20) {
  return static_cast<std::uint64_t>(std::max<std::int64_t>(moment_q20, 0)) * constants.largest_moment_um2 >>
         kMomentBits;
}

/// [Percent] What the gate allows over what is left; above kMostUncertainQuality if accepted, else not.
std::uint8_t qualityOf(const Answer& answer, int freedoms) {
  const std::int64_t allowed =
      energyOf(answer.variances, threshold::kGatePerFreedom * freedoms + threshold::kGate);
  const std::int64_t energy = answer.solution.residualEnergy;
  const auto quality = energy <= allowed ? 100 : std::max<std::int64_t>(100 * allowed / energy, 1);
  if (!answer.accepted)
    return static_cast<std::uint8_t>(std::min<std::int64_t>(quality, kMostUncertainQuality));
  return static_cast<std::uint8_t>(std::max<std::int64_t>(quality, kMostUncertainQuality + 1));
}

/// Square root of chi-squared per degree of freedom [* 2^4].
std::uint16_t chiOf_q4(const Answer& answer, int freedoms) {
  if (answer.solution.residualEnergy == 0) return 0;
  const Floating energy = floatingOf(static_cast<std::uint64_t>(answer.solution.residualEnergy));
  const Floating allowed =
      floatingOf(std::uint64_t{answer.variances.reading_q4} * static_cast<std::uint32_t>(freedoms));
  Floating ratio = floatingOf(energy.mantissa / (allowed.mantissa >> 16));  // * 2^16, to 2^-15
  ratio.exponent += energy.exponent - allowed.exponent - 16 + 4;
  const Root chi = rootOf(ratio);
  return static_cast<std::uint16_t>(integerOf(chi.mantissa, chi.exponent + 4, kNoChi - 1));
}

/// The standard error of a sum of two independent errors. Their sizes: up to 2^31 and 2^30, or 2^31 - 1 each.
Wide together(Wide one, Wide other) {
  if (other == 0) return one;
  const Root sum = rootOf(floatingOf(static_cast<std::uint64_t>(one * one + other * other)));
  return integerOf(sum.mantissa, sum.exponent, Wide{1} << 31);
}

/// If a moment m has the standard error s, its root is too low in the mean by the fraction s^2/(8m^2)
/// (Taylor). This corrects that, and gives a line, whose moment is 0, a width with an equal standard error.
void setWidth(const TableConstants& constants, Number moment_q20, Wide sigma_q20, Contact& contact) {
  const Wide mean_q20 = (moment_q20 + together(moment_q20, sigma_q20)) / 2;
  contact.width_um = std::max<std::uint32_t>(widthOf_um(moment_um2(constants, mean_q20)), 1);
  const auto sigma_um2 =
      static_cast<std::uint32_t>(std::min<std::uint64_t>(6 * moment_um2(constants, sigma_q20), 1u << 31));
  contact.sigmaWidth_um = std::max<std::uint32_t>((sigma_um2 + contact.width_um / 2) / contact.width_um, 1);
}

/// A load's standard error together with two that no residual shows: of the scale of all loads, and what the
/// calibration leaves.
LineLoadQ12 withCalibrationError(const TableConstants& constants, LineLoadQ12 sigma, LineLoadQ12 load,
                                 LineLoadQ12 normal) {
  constexpr Wide kMost = std::numeric_limits<Number>::max();
  const auto share = [](LineLoadQ12 of, std::uint16_t error_q16) {
    return lesser(magnitude(of.raw() * Wide{error_q16}) >> 16, kMost);
  };
  const Wide unseen =
      together(share(load, constants.load_scale_error_q16), share(normal, constants.load_error_q16));
  return LineLoadQ12::fromRaw(
      static_cast<Number>(lesser(together(sigma.raw(), lesser(unseen, kMost)), kMost)));
}

/// Adds the error that all places share, which tells nothing of which of two answers is right.
TurnQ32 withPlaceError(const TableConstants& constants, TurnQ32 sigma) {
  const Wide both = together(sigma.raw(), constants.place_error_q32);
  return TurnQ32::fromRaw(static_cast<std::uint32_t>(lesser(both, Wide{kHalfTurn_q32})));
}

LineLoadQ12 loadOf(const TableConstants& constants, const Answer& answer, std::int64_t amplitude) {
  return LineLoadQ12::fromRaw(
      lineLoad(static_cast<Number>(amplitude), constants.load_scale, constants.load_exponent + answer.shift));
}

/// The standard error, raised if need be so that three of it cover `far`.
constexpr Wide reaching(Wide sigma, Wide far) { return std::max(sigma, magnitude(far) / 3); }

/// Raises the errors to cover a rival that the readings hardly tell from the answer. Ambiguous: it is
/// kNamed_16 away or farther, whatever the errors; or nearer, but beyond three of the answer's own errors,
/// and noise alone may have favoured the wrong one.
void coverRival(const TableConstants& constants, const Answer& answer, int contact, Contact& estimated) {
  if (!answer.rival.isAsLikely) return;
  const ContactState& rival = answer.rival.contact[index(contact)];
  const Wide turned_q32 = static_cast<std::int32_t>(rival.angle_q32 - estimated.angle.raw());
  const Wide own_q32 = estimated.sigmaAngle.raw(), sigma_q32 = reaching(own_q32, turned_q32);
  estimated.ambiguous = magnitude(turned_q32) * constants.gauge_count >> 28 >= threshold::kNamed_16 ||
                        (answer.rival.isWithinNoise && sigma_q32 > own_q32);
  estimated.sigmaAngle = TurnQ32::fromRaw(static_cast<std::uint32_t>(sigma_q32));
  const auto cover = [&](LineLoadQ12& sigma, LineLoadQ12 told, Number amplitude) {
    const Wide off = Wide{loadOf(constants, answer, amplitude).raw()} - told.raw();
    sigma = LineLoadQ12::fromRaw(static_cast<Number>(reaching(sigma.raw(), off)));
  };
  cover(estimated.sigmaNormal, estimated.normal, rival.normal);
  cover(estimated.sigmaTangential, estimated.tangential, rival.tangential);
  if (!answer.solution.hypothesis.widthIsFree) return;
  const Wide wider_um = Wide{widthOf_um(moment_um2(constants, rival.moment_q20))} - estimated.width_um;
  estimated.sigmaWidth_um = static_cast<std::uint32_t>(reaching(estimated.sigmaWidth_um, wider_um));
}

}  // namespace

UnitErrors unitErrors(const Linearisation& linearisation) {
  UnitErrors errors{linearisation.hypothesis, linearisation.slopesAt};
  const auto variance_q50 = variances(linearisation.decomposition);
  for (int i = 0; i < linearisation.decomposition.unknowns; ++i) {
    Floating variance = floatingOf(static_cast<std::uint64_t>(variance_q50[index(i)]));
    variance.exponent -= 50 + 2 * linearisation.exponent[index(i)];
    if (linearisation.decomposition.isDetermined(i)) errors.sigma[index(i)] = rootOf(variance);
  }
  return errors;
}

Contact estimate(const TableConstants& constants, const Answer& answer, const UnitErrors& errors, int told) {
  const int contact = answer.indexOf(told);
  const Hypothesis& hypothesis = answer.solution.hypothesis;
  const ContactState& state = answer.solution.contact[index(contact)];
  const Root reading = rootOf(floatingOf(answer.variances.reading_q4));  // [* 2^2]
  const auto sigma = [&](int unknown, int unitBits, std::int64_t most) {
    const Root& unit = errors.sigma[index(unknown)];
    if (unit.mantissa == 0) return most;
    return integerOf(std::uint32_t{reading.mantissa} * unit.mantissa,
                     reading.exponent + unit.exponent - 2 + unitBits, most);
  };
  const auto isOpen = [&](int unknown) { return errors.sigma[index(unknown)].mantissa == 0; };
  const auto load = [&](std::int64_t amplitude) { return loadOf(constants, answer, amplitude); };
  Contact estimated;
  estimated.angle = TurnQ32::fromRaw(state.angle_q32);
  const std::int64_t turn =
      sigma(angleOf(hypothesis, contact), kAngleBits, kMostHalfNodes) * halfNode_q32(constants) >> kAngleBits;
  estimated.sigmaAngle = TurnQ32::fromRaw(static_cast<std::uint32_t>(std::min(turn, kHalfTurn_q32)));
  estimated.normal = load(state.normal);
  estimated.tangential = load(state.tangential);
  estimated.sigmaNormal = load(sigma(loadsOf(contact), 16, kMostLoad));
  estimated.sigmaTangential = load(sigma(loadsOf(contact) + 1, 16, kMostLoad));
  // If one unknown is undetermined, the others' errors are those for a known value of it.
  bool isUndetermined =
      isOpen(angleOf(hypothesis, contact)) || isOpen(loadsOf(contact)) || isOpen(loadsOf(contact) + 1);
  bool tooWide = false;
  if (hypothesis.widthIsFree) {
    const std::int64_t sigma_q20 =
        together(sigma(momentOf(hypothesis, contact), kMomentBits, 1 << kMomentBits),
                 Wide{constants.moment_error_q16} << (kMomentBits - 16));
    setWidth(constants, state.moment_q20, sigma_q20, estimated);
    isUndetermined |= isOpen(momentOf(hypothesis, contact));
    tooWide = isWidest(state) || (answer.rival.isAsLikely && isWidest(answer.rival.contact[index(contact)]));
  }
  const bool faint =
      hypothesis.contacts > 1 &&
      estimated.normal.raw() < threshold::kFewestSigmas * std::int64_t{estimated.sigmaNormal.raw()};
  estimated.sigmaNormal =
      withCalibrationError(constants, estimated.sigmaNormal, estimated.normal, estimated.normal);
  estimated.sigmaTangential =
      withCalibrationError(constants, estimated.sigmaTangential, estimated.tangential, estimated.normal);
  const int left = freedoms(hypothesis);
  if (left > 0) estimated.chi_q4 = chiOf_q4(answer, left);
  estimated.quality = qualityOf(answer, left);
  coverRival(constants, answer, contact, estimated);
  estimated.sigmaAngle = withPlaceError(constants, estimated.sigmaAngle);
  estimated.alternative = TurnQ32::fromRaw(answer.rival.contact[index(contact)].angle_q32);
  estimated.uncertain = estimated.ambiguous || !answer.accepted || answer.searching || answer.doubtful ||
                        areTooNear(constants, answer.solution) || isUndetermined || tooWide || faint ||
                        answer.weak || isLimited(state);
  if (estimated.uncertain) estimated.quality = std::min(estimated.quality, kMostUncertainQuality);
  return estimated;
}

}  // namespace strainfinger::firmware
