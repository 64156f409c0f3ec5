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
  template <bool growing, class Real>
  using MemoryIn = std::conditional_t<growing, GrowingVectorMemoryIn<Real>, VectorMemoryIn<Real>>;

  template <class Real>
  struct PairIn {
    Real rollingFriction;  // μ_r
    Real stiffnessRatio;   // k_r/(k_n R*²)
    Real dampingRatio;     // ζ_r
  };
  using Pair = PairIn<double>;

  static Pair prepare(const PairValues& values) {
    const double mu = values[Property::rollingFriction];
    return {mu, 2.25 * mu * mu, values.pair.valueOr(Property::rollingDamping, 0.3)};
  }

  /// At most: k_r (1/I_i + 1/I_j) with R* below both radii, which a wall reaches.
  static ContactMode mode(const Pair& p, double normalStiffness, double inverseMass) {
    const double stiffness = 2.5 * p.stiffnessRatio * normalStiffness * inverseMass;
    return {stiffness, 2 * p.dampingRatio * std::sqrt(3.5 * stiffness)};
  }

  template <class Real>
  TSUBU_LAW Real stiffness(const PairIn<Real>& p, const ContactIn<Real>& c, Real normalStiffness) {
    return p.stiffnessRatio * normalStiffness * c.effectiveRadius * c.effectiveRadius;
  }

  /// Energy that a memory holds, J.
  template <class Real>
  TSUBU_LAW Real stored(const PairIn<Real>& p, const ContactIn<Real>& c, Real normalStiffness, const VectorMemoryIn<Real>& memory) {
    return Real(0.5) / larger(stiffness(p, c, normalStiffness), tinyIn<Real>) * norm2(memory.spring);
  }
  template <class Real>
  TSUBU_LAW Real stored(const PairIn<Real>&, const ContactIn<Real>&, Real, const GrowingVectorMemoryIn<Real>& memory) {
    return Real(0.5) / larger(memory.stiffness, tinyIn<Real>) * norm2(memory.spring);
  }

  template <class Real, class M>
  TSUBU_LAW RollingMomentIn<Real> moment(const PairIn<Real>& p, const ContactIn<Real>& c, const NormalForceIn<Real>& normal,
                                         StepIn<Real> step, M& memory) {
    const Real k = stiffness(p, c, normal.stiffness);
    const Real inertia = Real(3.5) / c.inverseSpinInertia;
    const Real damping = larger(2 * p.dampingRatio * std::sqrt(inertia * k), k * quieting(k * c.inverseSpinInertia, step));
    const V3In<Real> rolling = c.relativeSpin - dot(c.relativeSpin, c.n) * c.n;
    const Eased<Real> ease = eased(memory, k, Real(1));
    const V3In<Real> before = ease.factor * memory.spring;
    const V3In<Real> gain = (k * step.dt) * rolling;
    const V3In<Real> trial = before + step.lead * gain;
    const Real limit = p.rollingFriction * c.effectiveRadius * std::abs(normal.force);
    const Real size2 = norm2(trial);
    const bool yields = size2 > limit * limit;
    const Real keep = yields ? shareOf(limit, size2) : Real(1);
    memory.spring = keep * (before + gain);
    setStiffness(memory, k);
    const Real active = yields ? Real(0) : damping, storedAfter = Real(0.5) / larger(k, tinyIn<Real>) * norm2(memory.spring);
    const Real work = (keep * dot(before + step.mean * gain, rolling) + active * norm2(rolling)) * step.dt;
    return {-keep * trial - active * rolling, ease.before, storedAfter, work - (storedAfter - ease.before)};
  }
};

}  // namespace tsubu::sim
