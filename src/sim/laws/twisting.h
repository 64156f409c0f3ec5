#pragma once
// Resistance against twisting, the relative spin about n.
//
//   R7   M = −(k_w θ + 2 ζ_w √(I_w k_w) ω_n) n,   dθ/dt = ω_n = ω_rel·n,   |k_w θ| ≤ μ_w R* |F_n|, the dashpot only below
//   R8   k_w = 2.25 k_n (μ_w R*)²,   1/I_w = 1/I_i + 1/I_j,   ζ_w = 0.3
//
//   μ_w  twisting friction: 2/3 of μ times the radius of the contact area over R*, for a Hertz contact
//
// The form of the rolling spring (R3–R5), about n. The memory is one number and the same for both orders of the partners. On a Hertz
// contact it follows the stiffness (T8).
//
// Source: after Marshall, J. Comput. Phys. 228 (2009) 1541, with the stiffness of Ai et al. 2011. Proven by
// tests/sim/laws/twisting_test.cpp.

#include "sim/laws/rolling.h"

namespace tsubu::sim {

struct FreeTwisting {
  static constexpr std::string_view name = "none";
  static constexpr std::string_view sentence = "Grains spin freely about the line of centres.";
  static constexpr std::array<Need, 0> reads{};
  static constexpr bool acts = false, common = true;
  template <bool growing, class Real>
  using MemoryIn = NoMemory<Family::twisting>;
  template <class>
  struct PairIn {};
  using Pair = PairIn<double>;
  static Pair prepare(const PairValues&) { return {}; }
  static ContactMode mode(const Pair&, double, double) { return {}; }
};

struct SpringTwisting {
  static constexpr std::string_view name = "spring";
  static constexpr std::string_view sentence = "Elastic–plastic spring and dashpot against the spin about the normal (R7, R8).";
  static constexpr std::array reads{need(Property::twistingFriction)};
  static constexpr bool acts = true, common = false;
  static constexpr double dampingRatio = 0.3;
  template <bool growing, class Real>
  using MemoryIn = std::conditional_t<growing, GrowingScalarMemoryIn<Real>, ScalarMemoryIn<Real>>;

  template <class Real>
  struct PairIn {
    Real friction;        // μ_w
    Real stiffnessRatio;  // k_w/(k_n R*²)
  };
  using Pair = PairIn<double>;
  static Pair prepare(const PairValues& values) {
    const double mu = values[Property::twistingFriction];
    return {mu, 2.25 * mu * mu};
  }
  static ContactMode mode(const Pair& p, double normalStiffness, double inverseMass) {
    const double stiffness = 2.5 * p.stiffnessRatio * normalStiffness * inverseMass;
    return {stiffness, 2 * dampingRatio * std::sqrt(stiffness)};
  }

  template <class Real>
  TSUBU_LAW Real stiffness(const PairIn<Real>& p, const ContactIn<Real>& c, Real normalStiffness) {
    return p.stiffnessRatio * normalStiffness * c.effectiveRadius * c.effectiveRadius;
  }
  template <class Real>
  TSUBU_LAW Real stored(const PairIn<Real>& p, const ContactIn<Real>& c, Real normalStiffness, const ScalarMemoryIn<Real>& memory) {
    return Real(0.5) / larger(stiffness(p, c, normalStiffness), tinyIn<Real>) * memory.spring * memory.spring;
  }
  template <class Real>
  TSUBU_LAW Real stored(const PairIn<Real>&, const ContactIn<Real>&, Real, const GrowingScalarMemoryIn<Real>& memory) {
    return Real(0.5) / larger(memory.stiffness, tinyIn<Real>) * memory.spring * memory.spring;
  }

  template <class Real, class M>
  TSUBU_LAW RollingMomentIn<Real> moment(const PairIn<Real>& p, const ContactIn<Real>& c, const NormalForceIn<Real>& normal,
                                         StepIn<Real> step, M& memory) {
    const Real k = stiffness(p, c, normal.stiffness), spin = dot(c.relativeSpin, c.n);
    const Real damping = larger(2 * dampingRatio * std::sqrt(k / c.inverseSpinInertia), k * quieting(k * c.inverseSpinInertia, step));
    const Eased<Real> ease = eased(memory, k, Real(1));
    const Real before = ease.factor * memory.spring, gain = k * step.dt * spin, trial = before + step.lead * gain;
    const Real limit = p.friction * c.effectiveRadius * std::abs(normal.force), size = std::abs(trial);
    const bool yields = size > limit;
    const Real keep = yields ? limit / larger(size, tinyIn<Real>) : Real(1);
    memory.spring = keep * (before + gain);
    setStiffness(memory, k);
    const Real active = yields ? Real(0) : damping, storedAfter = Real(0.5) / larger(k, tinyIn<Real>) * memory.spring * memory.spring;
    const Real work = (keep * (before + step.mean * gain) + active * spin) * spin * step.dt;
    return {(-keep * trial - active * spin) * c.n, ease.before, storedAfter, work - (storedAfter - ease.before)};
  }
};

}  // namespace tsubu::sim
