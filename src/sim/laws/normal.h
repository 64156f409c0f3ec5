#pragma once
// What every normal law returns. A normal law has: name, sentence, reads; PairIn<Real> and prepare; stiffness and damping, for the time
// step; readsRootMass (where it says no, the contact's √m* is 0); force, which may read n, overlap, separationSpeed and masses; `common`
// (tangential.h); `growing`: does its stiffness depend on the contact, overlap or R*, and not on the materials alone? Only then is R* sure
// to be there.

#include "sim/laws/contact.h"

namespace tsubu::sim {

/// What the normal law hands to the laws after it.
template <class Real>
struct NormalForceIn {
  Real force;                    ///< F_n, N; positive pushes apart
  Real elastic;                  ///< the part that is stored, N
  Real energy;                   ///< stored, J
  Real stiffness;                ///< k_n = dF/dδ at this overlap, N/m
  Real damping;                  ///< η_n, kg/s
  Real dampingPerRootStiffness;  ///< η_n/√k_n, finite also where both vanish
};
using NormalForce = NormalForceIn<double>;

/// N5: the separation speed that a dashpot is to see in this step. A dashpot's force jumps when a contact begins (and, with tension,
/// when it ends) somewhere between two steps. The force of step n stands for the time from n − ½ to n + ½; when the contact began
/// within the last step, τ = δ/|v_n| ago, the dashpot acts for τ + ½ Δt of it, which η (½ |v_n| + δ/Δt) over Δt makes up for. Without
/// it the restitution coefficient would depend on where in the step the grains happen to meet, by 0.3 % at a hundredth of a contact.
template <class Real>
TSUBU_INLINE Real sampledSpeed(const ContactIn<Real>& c, StepIn<Real> step) {
  const Real v = c.separationSpeed, speed = std::abs(v), grown = c.overlap * step.perSecond;
  const Real weighed = Real(0.5) * speed + grown;
  return grown < speed ? (v < 0 ? -weighed : weighed) : v;
}

}  // namespace tsubu::sim
