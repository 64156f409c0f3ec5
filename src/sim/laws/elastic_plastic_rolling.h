#pragma once
// Rolling resistance with an elastic–plastic spring and a dashpot ("type C").
//
//   R3   M = M_k + M_d,   dM_k/dt = −k_r ω_r,   |M_k| ≤ M_max = μ_r R* |F_n|
//   R4   M_d = −2 ζ_r √(I_r k_r) ω_r while |M_k| < M_max, and 0 beyond
//   R5   k_r = 2.25 k_n (μ_r R*)²,   1/I_r = (1/I_i + 1/I_j)/(1 + 5/2)
//
//   ω_r  relative spin without its part about n, rad/s      μ_r  rolling friction      ζ_r  rolling damping ratio (0.3 when absent)
//   I_r  inertia of rolling about the contact point, kg m²: I + m r² = 7/2 I for a sphere
//
// It holds a pile at rest: M_k balances a moment at zero spin. The memory is −M_k, carried with the contact like the tangential one.
// On a Hertz contact k_n is the present stiffness, and the spring follows it as Mindlin's does (T8).
//
// Source: Ai et al., Powder Technology 206 (2011) 269, model C. Proven by tests/sim/laws/rolling_test.cpp.

#include "sim/laws/rolling.h"

namespace tsubu::sim {

struct ElasticPlasticRolling {
  static constexpr std::string_view name = "elastic_plastic";
  static constexpr std::string_view sentence = "Elastic–plastic spring and dashpot (type C, R3–R5): a pile stands still.";
  static constexpr std::array reads{need(Property::rollingFriction), mayRead(Property::rollingDamping)};
  static constexpr bool acts = true, common = true;
  template <bool growing>
  using Memory = std::conditional_t<growing, GrowingVectorMemory, VectorMemory>;

  struct Pair {
    double rollingFriction;  // μ_r
    double stiffnessRatio;   // k_r/(k_n R*²)
    double dampingRatio;     // ζ_r
  };

  static Pair prepare(const PairValues& values) {
    const double mu = values[Property::rollingFriction];
    return {mu, 2.25 * mu * mu, values.pair.valueOr(Property::rollingDamping, 0.3)};
  }

  /// At most: k_r (1/I_i + 1/I_j) with R* below both radii, which a wall reaches.
  static ContactMode mode(const Pair& p, double normalStiffness, double inverseMass) {
    const double stiffness = 2.5 * p.stiffnessRatio * normalStiffness * inverseMass;
    return {stiffness, 2 * p.dampingRatio * std::sqrt(3.5 * stiffness)};
  }

  TSUBU_LAW double stiffness(const Pair& p, const Contact& c, double normalStiffness) {
    return p.stiffnessRatio * normalStiffness * c.effectiveRadius * c.effectiveRadius;
  }

  /// Energy that a memory holds, J.
  TSUBU_LAW double stored(const Pair& p, const Contact& c, double normalStiffness, const VectorMemory& memory) {
    return 0.5 / larger(stiffness(p, c, normalStiffness), tiny) * norm2(memory.spring);
  }
  TSUBU_LAW double stored(const Pair&, const Contact&, double, const GrowingVectorMemory& memory) {
    return 0.5 / larger(memory.stiffness, tiny) * norm2(memory.spring);
  }

  template <class M>
  TSUBU_LAW RollingMoment moment(const Pair& p, const Contact& c, const NormalForce& normal, StepOf step, M& memory) {
    const double k = stiffness(p, c, normal.stiffness);
    const double inertia = 3.5 / c.inverseSpinInertia;
    const double damping = larger(2 * p.dampingRatio * std::sqrt(inertia * k), k * quieting(k * c.inverseSpinInertia, step));
    const V3 rolling = c.relativeSpin - dot(c.relativeSpin, c.n) * c.n;
    const Eased ease = eased(memory, k, 1.0);
    const V3 before = ease.factor * memory.spring;
    const V3 gain = (k * step.dt) * rolling;
    const V3 trial = before + step.lead * gain;
    const double limit = p.rollingFriction * c.effectiveRadius * std::abs(normal.force);
    const double size2 = norm2(trial);
    const bool yields = size2 > limit * limit;
    const double keep = yields ? shareOf(limit, size2) : 1.0;
    memory.spring = keep * (before + gain);
    setStiffness(memory, k);
    const double active = yields ? 0.0 : damping, storedAfter = 0.5 / larger(k, tiny) * norm2(memory.spring);
    const double work = (keep * dot(before + step.mean * gain, rolling) + active * norm2(rolling)) * step.dt;
    return {-keep * trial - active * rolling, ease.before, storedAfter, work - (storedAfter - ease.before)};
  }
};

}  // namespace tsubu::sim
