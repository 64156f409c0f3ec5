#pragma once
// The integrators (docs/physics.md, I1–I3). One pass moves the grains, clears their force rows and finds the fastest.
//
//   I1  symplectic Euler   v ← v + a Δt,  x ← x + v Δt;                 contacts see v
//   I2  velocity Verlet    u ← u + a Δt,  x ← x + u Δt;                 contacts see v = u + ½ a Δt
//
// u is the velocity at half steps. The velocity of the same instant as x is u + ½ a Δt with the acceleration of that instant, which
// is not known before the force that needs it; with the last one the error is of second order in Δt, and the dashpot keeps the order
// of the scheme (with u alone, as is common, it would be first). Both schemes conserve momentum; along the normal, without
// damping, they are symplectic (across it, see T6).
// Rotation is the same for L = I ω; a sphere's inertia is a number, so that r ω is advanced: d(r ω)/dt = −(5/2) Q/m.
//   I3  orientation        q ← exp(½ ∫ω dt) q, with ω at half steps summed over `turnEvery` steps; where magnets read it, over one.

#include "sim/neighbours/slabs.h"
#include "sim/state.h"

namespace tsubu::sim {

/// What a pass over grains finds.
struct Motion {
  double fastest2 = 0;  ///< (m/s)²: the largest squared speed
  double travel2 = 0;   ///< largest (distance moved in the step / radius)²; NaN counts as infinite
};

/// Steps from one update of the orientations to the next. Fixed, so that looking at them changes nothing.
inline constexpr std::uint64_t turnEvery = 32;

/// Moves grains [first, last) by one step and clears their forces. `turn`: also bring their orientations up to date.
Motion integrate(State& state, std::int32_t first, std::int32_t last, const Vec3& gravity, double dt, bool turn);

/// Sets the half-step velocities of grains from this id on from the velocities of the rows and the present forces: what velocity Verlet
/// starts with.
void startVerlet(State& state, std::uint32_t firstId, const Vec3& gravity, double dt);

/// The velocities of the present instant, forces known: v and r ω.
struct Velocities {
  Vec3 v, s;
};
Velocities velocitiesNow(const State& state, std::size_t grain, const Vec3& gravity, double dt);

/// The rotation by the angle |a| (rad) about a.
Quat rotationBy(const Vec3& angle);

/// Orientation of the present instant.
Quat orientationNow(const State& state, std::size_t grain);

}  // namespace tsubu::sim
