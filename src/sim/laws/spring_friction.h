#pragma once
// Coulomb friction with a tangential spring that remembers.
//
//   T1   F_t = −k_t δ_t − η_t v_t
//   T2   |F_t| ≤ μ |F_n|; beyond it spring and dashpot are cut back by the same factor, so that together they are the limit
//   T3   δ_t is carried with the contact: turned with n and with a mean spin about n, kept tangential at unchanged length
//   T4   η_t = η_n √(2 k_t/(7 k_n)): the damping ratio of the normal contact, for a mass of 2/7 m* (a sphere turns as it slips);
//        or η_t = m* γ_t from a rate
//
//   k_t  tangential stiffness, N/m (2/7 k_n when absent)      v_t  slip velocity, m/s
//   μ    friction coefficient                                  δ_t  tangential displacement, m
//
// The memory is k_t δ_t in N. It is advanced with the slip of a whole step and read at `lead` of a step, so that in velocity Verlet
// the spring's work over a step is exactly the change of its energy: a sticking contact leaks nothing (docs/physics.md, T5). In
// symplectic Euler the account takes the spring's mean force over the step, for the same reason.
//   T6   η_t ≥ k_t (7/2 k_t/m*) Δt³ in velocity Verlet (contact.h, quieting): matters for nearly elastic contacts alone
//
// Cutting back is passive: what the spring loses beyond its work is friction, and never less than nothing. Luding (Granular Matter 10
// (2008) 235) keeps the dashpot whole and gives the spring the rest, limit − η_t v_t; where the dashpot alone exceeds the limit, that
// charges a spring that pushes along the slip, with energy that nobody spent. Steady sliding below it ends in the same state.
//
// Source: Cundall & Strack 1979; cutting back the spring at the limit after Luding. Proven by tests/sim/laws/spring_friction_test.cpp.

#include "sim/laws/tangential.h"

namespace tsubu::sim {

struct SpringFriction {
  static constexpr std::string_view name = "spring";
  static constexpr std::string_view sentence = "Coulomb friction with a spring that remembers (T1–T4): grains stick, then slide.";
  static constexpr std::array reads{need(Property::friction), mayRead(Property::tangentialStiffness),
                                    mayRead(Property::tangentialDampingRate)};
  static constexpr int stateSize = 3;
  static constexpr bool acts = true;

  struct Pair {
    double stiffness;         // k_t
    double half;              // 1/(2 k_t), or 0 without a spring
    double friction;          // μ
    double dampingOfNormal;   // η_t/η_n
    double dampingPerMass;    // η_t/m*
  };

  static Pair prepare(const PropertyValues& values, double normalStiffness) {
    Pair p{};
    p.stiffness = values.valueOr(Property::tangentialStiffness, 2.0 / 7.0 * normalStiffness);
    p.half = p.stiffness > 0 ? 0.5 / p.stiffness : 0;
    p.friction = values[Property::friction];
    if (values.has(Property::tangentialDampingRate))
      p.dampingPerMass = values[Property::tangentialDampingRate];
    else
      p.dampingOfNormal = std::sqrt(p.stiffness / (3.5 * normalStiffness));
    return p;
  }

  static double stiffness(const Pair& p) { return p.stiffness; }
  /// A sphere's rotation makes 7/2 of a tangential spring: 1/m + r²/I.
  static ContactMode mode(const Pair& p, double normalDamping, double inverseMass) {
    return {3.5 * p.stiffness * inverseMass, 3.5 * (p.dampingOfNormal * normalDamping * inverseMass + p.dampingPerMass)};
  }

  /// Energy that a memory holds, J.
  TSUBU_LAW double stored(const Pair& p, V3 memory) { return p.half * norm2(memory); }

  TSUBU_LAW TangentialForce force(const Pair& p, const Contact& c, const NormalForce& normal, StepOf step, V3& memory) {
    const double own = p.dampingOfNormal * normal.damping + p.dampingPerMass * c.effectiveMass;
    const double damping = larger(own, p.stiffness * quieting(3.5 * p.stiffness * c.inverseEffectiveMass, step));
    const V3 before = carried(memory, c.n, c.frameAngle);
    const V3 gain = (p.stiffness * step.dt) * c.slip;
    const V3 trial = before + step.lead * gain + damping * c.slip;
    const double limit = p.friction * std::abs(normal.force);
    const double size = norm(trial);
    const double keep = size > limit ? limit / larger(size, tiny) : 1.0;
    const V3 force = -keep * trial;
    memory = keep * (before + gain);
    const double storedBefore = stored(p, before), storedAfter = stored(p, memory);
    const double springWork = keep * dot(before + 0.5 * gain, c.slip) * step.dt;
    return {force, storedBefore, storedAfter, keep * damping * norm2(c.slip) * step.dt, springWork - (storedAfter - storedBefore)};
  }
};

}  // namespace tsubu::sim
