#pragma once
// Gauss-Newton: the contacts of a hypothesis that fit the readings best, near an initial guess.

#include <array>
#include <cstdint>
#include <span>

#include "common/table_image.hpp"
#include "firmware/core/hypothesis.hpp"
#include "firmware/core/normal_equations.hpp"

namespace strainfinger::firmware {

/// Order of the unknowns: normal and tangential load of each contact, then the angles, then second moments.
constexpr int loadsOf(int contact) { return 2 * contact; }
constexpr int angleOf(const Hypothesis& hypothesis, int contact) { return 2 * hypothesis.contacts + contact; }
constexpr int momentOf(const Hypothesis& hypothesis, int contact) {
  return 3 * hypothesis.contacts + contact;
}

/// A hypothesis linearised at some contacts: the readings that they predict, and the derivatives of these by
/// each unknown (the columns), which may be those of contacts near by.
struct Linearisation {
  Hypothesis hypothesis;
  ContactStates at;                                   ///< what is predicted from
  ContactStates slopesAt;                             ///< where the columns were computed
  alignas(4) std::array<Rows, kMostUnknowns> column;  ///< * 2^exponent: weighted readings per unit of unknown
  std::array<std::int8_t, kMostUnknowns> exponent;
  std::array<Number, kMaxGauges> predicted;  ///< of every gauge of the ring, beyond the rails as well
  Decomposition decomposition;
};

/// Entries of a column: one for each gauge, filled up to a multiple of 4.
constexpr int rowsOf(int gauges) { return (gauges + 3) & ~3; }

/// The state of a fit.
struct Solution {
  Hypothesis hypothesis;
  ContactStates contact;
  bool converged = false;
  Wide residualEnergy = 0;  ///< sum of squares of the weighted residuals of all gauges that count

  std::span<const ContactState> contacts() const { return std::span(contact).first(hypothesis.contacts); }
};

/// The gauge is near enough to feel the contact. Grids and the fit of three readings look at such gauges
/// only, common drift at the others only.
bool isInReach(const TableImage& tables, const ContactState& contact, int gauge);

/// `weight_q14`: that of the residuals. Cost: two table lookups for each gauge and contact, decomposition.
void linearise(const TableImage& tables, const Hypothesis& hypothesis, const ContactStates& contacts,
               Linearisation& linearisation, const Weights& weight_q14 = kAllAlike);

/// Moves the predictions to other contacts. If the columns still hold there they are kept, with the weights
/// that they were made with, at a third of the cost of linearise(); else all is linearised anew.
void move(const TableImage& tables, const ContactStates& contacts, Linearisation& linearisation,
          const Weights& weight_q14 = kAllAlike);

/// The linear model holds for a contact that turns by this; `farther`: [log2] of a factor on the limit.
bool isShortTurn(const TableConstants& constants, std::uint32_t turned_q32, int farther = 0);

/// One step towards these readings. `solution.converged`: another step would not matter; `residualEnergy`:
/// what the linear model expects after the step.
Solution step(const TableImage& tables, const Linearisation& linearisation, const ScaledReadings& readings);

/// Sum of squares of the weighted residuals of the gauges that count.
Wide energyLeft(const TableImage& tables, const Linearisation& linearisation, const ScaledReadings& readings);

/// The minimum, between `from` and `to`, of a parabola through the energies at both, with the linear model's
/// slope at `from`. `promised`: by how much that model lowers the energy at `to`; `missed`: by how much the
/// true energy there exceeds the model's.
ContactStates partway(const ContactStates& from, const ContactStates& to, Wide promised, Wide missed);

/// Moves a linearisation to where a step led, if the energy is lower there; else to partway(), if it is lower
/// there; else back, with columns of the starting point. `solution` becomes the point reached and its energy;
/// it is converged if neither helped although the columns had been those of the starting point. Returns how
/// many predictions were computed.
int descend(const TableImage& tables, const ScaledReadings& readings, Linearisation& linearisation,
            Solution& solution);
inline constexpr int kDescentMoves = 3;  ///< at most

/// The residual of a prediction of 0: the weighted readings themselves.
Residual allOf(const TableImage& tables, const Hypothesis& hypothesis, const ScaledReadings& readings);

/// The best loads of contacts of these places and widths, and the residual energy. `readings`: of allOf().
/// Half of each contact is assumed to slip. `scratch` is overwritten. Cost: a table lookup without slopes for
/// each gauge in reach and each load.
Solution fitLoads(const TableImage& tables, const Hypothesis& hypothesis, const ContactStates& contacts,
                  const Residual& readings, const Weights& weight_q14, Linearisation& scratch);

/// Gauss-Newton steps until they converge, at most `mostSteps`.
Solution fit(const TableImage& tables, const Hypothesis& hypothesis, const ContactStates& start,
             const ScaledReadings& readings, int mostSteps, Linearisation& linearisation);

}  // namespace strainfinger::firmware
