#pragma once
// Gauss-Newton: the contacts of a hypothesis that explain the readings best, near where one starts.

#include <array>
#include <cstdint>
#include <span>

#include "common/table_image.hpp"
#include "firmware/core/hypothesis.hpp"
#include "firmware/core/normal_equations.hpp"

namespace strainfinger::firmware {

/// Unknowns are ordered normal and tangential load of each contact, angles, second moments.
constexpr int loadsOf(int contact) { return 2 * contact; }
constexpr int angleOf(const Hypothesis& hypothesis, int contact) { return 2 * hypothesis.contacts + contact; }
constexpr int momentOf(const Hypothesis& hypothesis, int contact) {
  return 3 * hypothesis.contacts + contact;
}

/// A hypothesis linearised at some contacts: what the gauges should read, and how that changes with each
/// unknown, there or near by.
struct Linearisation {
  Hypothesis hypothesis;
  ContactStates at;        ///< where the predictions are of
  ContactStates slopesAt;  ///< where the columns are of
  alignas(
      4) std::array<Rows, kMostUnknowns> column;  ///< * 2^exponent: weighted readings per unit of the unknown
  std::array<std::int8_t, kMostUnknowns> exponent;
  std::array<Number, kMaxGauges> predicted;  ///< of every gauge of the ring, not limited to what can be read
  Decomposition decomposition;
};

/// Entries of a column: one a gauge, up to a multiple of 4.
constexpr int rowsOf(int gauges) { return (gauges + 3) & ~3; }

/// Where a fit stands.
struct Solution {
  Hypothesis hypothesis;
  ContactStates contact;
  bool converged = false;
  Wide residualEnergy = 0;  ///< sum of squares of the weighted residuals of all gauges that count

  std::span<const ContactState> contacts() const { return std::span(contact).first(hypothesis.contacts); }
};

/// The gauge is so near to the contact that it feels it: grids, three readings and drift go by that.
bool isInReach(const TableImage& tables, const ContactState& contact, int gauge);

/// `weight_q14`: that residuals will have. Cost: two table lookups a gauge and contact, and the
/// decomposition.
void linearise(const TableImage& tables, const Hypothesis& hypothesis, const ContactStates& contacts,
               Linearisation& linearisation, const Weights& weight_q14 = kAllAlike);

/// Predictions of contacts elsewhere; where its columns still hold, these stay as they are, with the weights
/// that they were made with. Cost: a third of linearise() then.
void move(const TableImage& tables, const ContactStates& contacts, Linearisation& linearisation,
          const Weights& weight_q14 = kAllAlike);

/// The linear model holds for a contact that turns by so much; `farther`: so many times as far [log2].
bool isShortTurn(const TableConstants& constants, std::uint32_t turned_q32, int farther = 0);

/// One step from a linearisation to these readings. `solution.converged`: the linear model holds that far.
Solution step(const TableImage& tables, const Linearisation& linearisation, const ScaledReadings& readings);

/// Sum of squares of what the predictions leave of the readings that count, by their weights.
Wide energyLeft(const TableImage& tables, const Linearisation& linearisation, const ScaledReadings& readings);

/// The point between `from` and `to` at which a parabola through the energies left at both is lowest.
/// `promised`: by how much the linear model said the step lowers the energy; `missed`: by how much what is
/// left at `to` exceeds that.
ContactStates partway(const ContactStates& from, const ContactStates& to, Wide promised, Wide missed);

/// Moves a linearisation to where a step led, if less is left there; else to partway(), if less is left
/// there; else back to where it was, with columns of that place. `solution`: where it is now, and what is
/// left there; converged where neither helped although the columns had been of the starting point. Returns
/// how many predictions it computed.
int descend(const TableImage& tables, const ScaledReadings& readings, Linearisation& linearisation,
            Solution& solution);
inline constexpr int kDescentMoves = 3;  ///< at most

/// What is left of the readings where nothing is predicted.
Residual allOf(const TableImage& tables, const Hypothesis& hypothesis, const ScaledReadings& readings);

/// The best loads of contacts at these places and of these widths, which leave least of these readings
/// [allOf()]; their residual energy. Half of each contact is taken to slip. `scratch` is overwritten. Cost: a
/// table lookup a gauge in reach and load, without slopes.
Solution fitLoads(const TableImage& tables, const Hypothesis& hypothesis, const ContactStates& contacts,
                  const Residual& readings, const Weights& weight_q14, Linearisation& scratch);

/// Steps until they converge, `mostSteps` at most.
Solution fit(const TableImage& tables, const Hypothesis& hypothesis, const ContactStates& start,
             const ScaledReadings& readings, int mostSteps, Linearisation& linearisation);

}  // namespace strainfinger::firmware
