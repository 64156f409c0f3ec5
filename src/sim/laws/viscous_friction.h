#pragma once
// Friction from a dashpot alone.
//
//   T9   F_t = −η_t v_t,  |F_t| ≤ μ |F_n|,   η_t = m* γ_t
//   T10  |F_t| ≤ (2/7) m* |v_t|/(16 Δt): at most a sixteenth of what would stop the slip of two spheres within a step
//
// No memory: it slows sliding and holds nothing at rest, so a heap flows away like honey.
//
// Source: Haff & Werner 1986. Proven by tests/sim/laws/other_friction_test.cpp.

#include "sim/laws/tangential.h"

namespace tsubu::sim {

struct ViscousFriction {
  static constexpr std::string_view name = "viscous";
  static constexpr std::string_view sentence = "A dashpot against the slip, within the Coulomb limit (T9); no memory, so nothing rests on it.";
  static constexpr std::array reads{need(Property::friction), need(Property::tangentialDampingRate)};
  static constexpr bool acts = true, needsGrowing = false, passive = true, withinLimit = true, common = false;
  template <bool growing>
  using Memory = NoMemory<Family::tangential>;

  struct Pair {
    double friction;        // μ
    double dampingPerMass;  // γ_t
  };
  static Pair prepare(const PairValues& values, double, bool) { return {values[Property::friction], values[Property::tangentialDampingRate]}; }
  /// Bounded by T10 in any step.
  static ContactMode mode(const Pair&, double, double, double) { return {}; }

  TSUBU_LAW TangentialForce force(const Pair& p, const Contact& c, const NormalForce& normal, StepOf step, NoMemory<Family::tangential>&) {
    const double speed = norm(c.slip);
    const double damping = smaller(p.dampingPerMass, shareOfStop * (2.0 / 7.0) * step.perSecond) * c.effectiveMass;
    const double limit = p.friction * std::abs(normal.force);
    const double keep = damping * speed > limit ? limit / larger(damping * speed, tiny) : 1.0;
    const double work = keep * damping * speed * speed * step.dt;
    return {(-keep * damping) * c.slip, 0, 0, keep < 1 ? 0 : work, keep < 1 ? work : 0};
  }
};

}  // namespace tsubu::sim
