#pragma once
// The integrators (docs/physics.md, I1–I6). One pass (kernel/grain_passes.h) moves the grains, clears their force rows and finds the
// fastest.
//
//   I1  symplectic Euler     v ← v + a Δt,  x ← x + v Δt;                 contacts see v
//   I2  velocity Verlet      u ← u + a Δt,  x ← x + u Δt;                 contacts see v = u + ½ a Δt
//   I4  explicit Euler       x ← x + v Δt,  v ← v + a Δt;                 contacts see v
//   I5  leapfrog             u ← u + a Δt,  x ← x + u Δt;                 contacts see u
//   I6  central differences  x' = 2x − x_before + a Δt²;                  contacts see (x − x_before)/Δt
//
// u is the velocity at half steps. The velocity of the same instant as x is u + ½ a Δt with the acceleration of that instant, which
// is not known before the force that needs it; with the last one the error is of second order in Δt, and the dashpot keeps the order
// of the scheme (I2). With u alone, as is common (I5), it is of first. All of these conserve momentum; along the normal, without
// damping, I1, I2, I5 and I6 are symplectic (across it, see T6), and I4 gains energy in every step.
// Rotation is the same for L = I ω; a sphere's inertia is a number, so that r ω is advanced: d(r ω)/dt = −(5/2) Q/m.
//   I3  orientation          q ← exp(½ ∫ω dt) q, with the ω that the step goes by, summed over `turnEvery` steps. It only shows;
//                            where magnets read it, over one.
// The Runge–Kutta method has a file of its own (runge_kutta.h).

#include "sim/kernel/grain_kernels.h"
#include "sim/kernel/kernels.h"
#include "sim/state.h"

namespace tsubu::sim {

/// dv/dt and d(rω)/dt
struct Acceleration {
  V3 linear, surface;
};
TSUBU_INLINE Acceleration accelerationOf(const GrainRow& row, const ForceRow& force, V3 gravity) {
  return {row.inverseMass * V3{force.fx, force.fy, force.fz} + gravity, (-2.5 * row.inverseMass) * V3{force.qx, force.qy, force.qz}};
}

/// Steps from one update of the orientations to the next. Fixed, so that looking at them changes nothing.
inline constexpr std::uint64_t turnEvery = 32;

/// Moves grains [first, last) by one step and clears their forces. `turn`: also bring their orientations up to date. `bySingle`: with mixed
/// precision, forces have not been folded (State::foldSingleForces).
Motion integrate(State& state, std::int32_t first, std::int32_t last, const Vec3& gravity, double dt, bool turn, bool bySingle = false);

/// What schemes with half steps start with, for grains from this id on: the present forces take velocities back by half a step.
void startHalfSteps(State& state, std::uint32_t firstId, const Vec3& gravity, double dt);

/// The velocities of the present instant, forces known: v and r ω.
struct Velocities {
  Vec3 v, s;
};
Velocities velocitiesNow(const State& state, std::size_t grain, const Vec3& gravity, double dt);

/// Orientation of the present instant.
Quat orientationNow(const State& state, std::size_t grain);

}  // namespace tsubu::sim
