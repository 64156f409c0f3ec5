#pragma once
// Friction with a scalar memory laid along the present slip: for teaching.
//
//   T11  F_t = −(k_t s + η_t |v_t|) t,   t = v_t/|v_t|,   s = Σ |v_t| Δt     (Note 1.14, 1.15)
//   T12  |F_t| ≤ μ |F_n|; while it slides, s stays as it is                  (Note 1.17 as in its second scan, 1.18)
//
// The displacement is a path length that only grows, and its force always opposes the slip of the moment: it can never push back. A
// grain that swings on its tangential spring does not swing, and what the spring took is gone: all of it counts as friction. That is
// why nothing else uses it (docs/physics.md, T11; the test shows it).
//
// Without slip the last direction stays (Note 1.16). Proven by tests/sim/laws/other_friction_test.cpp.

#include "sim/laws/tangential.h"

namespace tsubu::sim {

struct ProjectedFriction {
  static constexpr std::string_view name = "projected";
  static constexpr std::string_view sentence =
      "The path length of the slip as a spring along the present slip (T11, T12): cannot push back; for teaching.";
  static constexpr std::array reads{need(Property::friction), mayRead(Property::tangentialStiffness),
                                    mayReadEither(Property::tangentialDampingRate, Property::tangentialDampingFactor)};
  static constexpr bool acts = true, needsGrowing = false, passive = true, withinLimit = true, common = false;
  template <bool growing, class Real>
  using MemoryIn = VectorMemoryIn<Real>;

  template <class Real>
  struct PairIn {
    Real stiffness;       // k_t
    Real friction;        // μ
    Real damping;         // η_t √k_n/η_n
    Real dampingPerMass;  // η_t/m*
  };
  using Pair = PairIn<double>;

  static Pair prepare(const PairValues& values, double normalStiffness, bool) {
    Pair p{};
    p.stiffness = values.pair.valueOr(Property::tangentialStiffness, 2.0 / 7.0 * normalStiffness);
    p.friction = values[Property::friction];
    if (values.has(Property::tangentialDampingRate))
      p.dampingPerMass = values[Property::tangentialDampingRate];
    else
      p.damping = values.pair.valueOr(Property::tangentialDampingFactor, std::sqrt(2.0 / 7.0)) * std::sqrt(p.stiffness);
    return p;
  }

  static ContactMode mode(const Pair& p, double normalStiffness, double normalDamping, double inverseMass) {
    const double damping = p.damping * normalDamping / std::sqrt(normalStiffness);
    return {3.5 * p.stiffness * inverseMass, 3.5 * (damping * inverseMass + p.dampingPerMass)};
  }

  /// Nothing comes back.
  template <class Real>
  TSUBU_LAW Real stored(const PairIn<Real>&, const VectorMemoryIn<Real>&) {
    return 0;
  }

  template <class Real>
  TSUBU_LAW TangentialForceIn<Real> force(const PairIn<Real>& p, const ContactIn<Real>& c, const NormalForceIn<Real>& normal,
                                          StepIn<Real> step, VectorMemoryIn<Real>& memory) {
    const V3In<Real> before = memory.spring;
    const Real speed = norm(c.slip), length = norm(before), gain = p.stiffness * step.dt * speed;
    const V3In<Real> along = speed > 0 ? (1 / larger(speed, tinyIn<Real>)) * c.slip : (1 / larger(length, tinyIn<Real>)) * before;
    const Real damping = p.damping * normal.dampingPerRootStiffness + p.dampingPerMass * c.effectiveMass;
    const Real trial = length + step.lead * gain + damping * speed, limit = p.friction * std::abs(normal.force);
    const bool slides = trial > limit;
    const Real size = slides ? limit : trial;
    memory.spring = (length + (slides ? 0 : gain)) * along;
    const Real work = size * speed * step.dt, dashpot = slides ? 0 : damping * speed * speed * step.dt;
    return {-size * along, 0, 0, dashpot, work - dashpot};
  }
};

}  // namespace tsubu::sim
