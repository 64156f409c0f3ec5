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
  static constexpr std::string_view sentence =
      "A dashpot against the slip, within the Coulomb limit (T9); no memory, so nothing rests on it.";
  static constexpr std::array reads{need(Property::friction), need(Property::tangentialDampingRate)};
  static constexpr bool acts = true, needsGrowing = false, passive = true, withinLimit = true, common = false;
  template <bool growing, class Real>
  using MemoryIn = NoMemory<Family::tangential>;

  template <class Real>
  struct PairIn {
    Real friction;        // μ
    Real dampingPerMass;  // γ_t
  };
  using Pair = PairIn<double>;
  static Pair prepare(const PairValues& values, double, bool) {
    return {values[Property::friction], values[Property::tangentialDampingRate]};
  }
  /// Bounded by T10 in any step.
  static ContactMode mode(const Pair&, double, double, double) { return {}; }

  template <class Real>
  TSUBU_LAW TangentialForceIn<Real> force(const PairIn<Real>& p, const ContactIn<Real>& c, const NormalForceIn<Real>& normal,
                                          StepIn<Real> step, NoMemory<Family::tangential>&) {
    const Real speed = norm(c.slip);
    const Real damping = smaller(p.dampingPerMass, shareOfStop<Real> * Real(2.0 / 7.0) * step.perSecond) * c.effectiveMass;
    const Real limit = p.friction * std::abs(normal.force);
    const Real keep = damping * speed > limit ? limit / larger(damping * speed, tinyIn<Real>) : Real(1);
    const Real work = keep * damping * speed * speed * step.dt;
    return {(-keep * damping) * c.slip, 0, 0, keep < 1 ? 0 : work, keep < 1 ? work : 0};
  }
};

}  // namespace tsubu::sim
