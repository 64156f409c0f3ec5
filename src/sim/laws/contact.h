#pragma once
// One contact as a law sees it. A law never sees the grains, the lists or the world: it gets this, by value, and returns a force.

#include "sim/laws/arithmetic.h"

namespace tsubu::sim {

/// Geometry and kinematics of a contact between i and j, with n from j to i (docs/physics.md, notation). A wall is a body with
/// 1/m = 0 and 1/R = 0: the pair formulas are the wall formulas.
template <class Real>
struct ContactIn {
  V3In<Real> n;               ///< unit normal, from j to i
  Real overlap;               ///< δ = r_i + r_j − |x_ij|, m; positive when touching
  Real separationSpeed;       ///< v_n = v_ij·n, m/s; negative while approaching
  V3In<Real> slip;            ///< v_t, velocity of i's surface over j's at the contact point, m/s; only set for laws with friction
  V3In<Real> relativeSpin;    ///< ω_i − ω_j, rad/s; only set for laws that resist rolling
  Real effectiveMass;         ///< m*, kg
  Real inverseEffectiveMass;  ///< 1/m*, 1/kg
  Real rootMass;              ///< √m*, √kg; 0 where the normal law does not read it
  Real effectiveRadius;       ///< R*, m; only set for laws that read it
  Real inverseSpinInertia;    ///< 1/I_i + 1/I_j, 1/(kg m²); only set for laws that resist rolling
  Real frameAngle;  ///< ω̄·n Δt, rad: how far the contact turns about n in a step, ω̄ a mean of ω_i and ω_j; for `carry` alone,
                    ///< which the kernels call before a law with an angle of their own: 0 there
};
using Contact = ContactIn<double>;

/// The step as a law sees it. Memory is kept at half steps: it is advanced by a whole step, and the force is taken `lead` of a step
/// beyond the old memory (½ for velocity Verlet, 1 for symplectic Euler, where memory and position belong to the same instant, 0 where
/// it belongs to the present one and is advanced for the next).
template <class Real>
struct StepIn {
  Real dt;  ///< s
  Real lead;
  Real perSecond = 1 / dt;  ///< kernels multiply rather than divide
  Real turning = dt;        ///< s: for how long memories turn about n (0 where the integrator turns them itself)
  Real mean = Real(0.5);    ///< share of a step's stretching in the spring force that its work is taken with (0: the force as it is)
  Real cubed = lead > 0 && lead < 1 ? dt* dt* dt : 0;  ///< s³, for `quieting`; 0 where nothing needs it. A choice made here: inside
                                                       ///< the loop over contacts a condition of the step alone keeps g++ from vectors
};
using StepOf = StepIn<double>;

template <class Real>
TSUBU_INLINE StepIn<Real> stepIn(const StepOf& s) {
  return {Real(s.dt), Real(s.lead), Real(s.perSecond), Real(s.turning), Real(s.mean), Real(s.cubed)};
}

/// T10, R2: a law without memory takes at most this share of a slip or a spin in a step. A grain has several contacts (eight count as the
/// worst, S3), which may resist both its slip and its spin: together they must not turn round what they resist.
template <class Real>
inline constexpr Real shareOfStop = Real(1.0 / 16);

/// T6: a dashpot of this ratio c/k (s) keeps the tangential and rolling springs of velocity Verlet from gaining energy. They are
/// stretched by velocities carried on by half a step (I2) and lag a little behind, and a lag gives an oscillation W⁴/4 of its energy
/// per step, W = ω Δt. The dashpot takes away W_c² W², with W_c = Δt √(k/m) of the contact alone. Of third order in Δt.
template <class Real>
TSUBU_INLINE Real quieting(Real stiffnessOverMass, StepIn<Real> step) {
  return stiffnessOverMass * step.cubed;
}

/// One way in which a contact can swing, for the time step: ω² in 1/s², and what its dashpot does, 2ζω in 1/s.
struct ContactMode {
  double stiffness = 0, damping = 0;
};

}  // namespace tsubu::sim
