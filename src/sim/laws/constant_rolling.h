#pragma once
// Rolling resistance of constant torque.
//
//   R1   M = −μ_r R* |F_n| ω_rel/|ω_rel|,   ω_rel = ω_i − ω_j
//   R2   |M| ≤ |ω_rel| / (16 (1/I_i + 1/I_j) Δt): at most a sixteenth of what would stop the relative spin within a step
//
//   μ_r  rolling friction      R*  effective radius, m      I  moment of inertia, kg m²
//
// R* and not r_i: with r_i two spheres of different size would not get opposite moments. It resists spin about n like rolling. It has
// no memory and so cannot hold a pile at rest: the torque dies with the spin (for teaching; see elastic_plastic_rolling.h).
//
// Source: Zhou et al., Physica A 269 (1999) 536, model A. Proven by tests/sim/laws/rolling_test.cpp.

#include "sim/laws/rolling.h"

namespace tsubu::sim {

struct ConstantRolling {
  static constexpr std::string_view name = "constant";
  static constexpr std::string_view sentence = "Constant torque against the relative spin (R1, R2); no memory, so a pile creeps.";
  static constexpr std::array reads{need(Property::rollingFriction)};
  static constexpr bool acts = true, common = false;
  template <bool growing, class Real>
  using MemoryIn = NoMemory<Family::rolling>;

  template <class Real>
  struct PairIn {
    Real rollingFriction;  // μ_r
  };
  using Pair = PairIn<double>;
  static Pair prepare(const PairValues& values) { return {values[Property::rollingFriction]}; }
  /// Bounded by R2 in any step.
  static ContactMode mode(const Pair&, double, double) { return {}; }

  template <class Real>
  TSUBU_LAW RollingMomentIn<Real> moment(const PairIn<Real>& p, const ContactIn<Real>& c, const NormalForceIn<Real>& normal,
                                         StepIn<Real> step, NoMemory<Family::rolling>&) {
    const Real spin = norm(c.relativeSpin);
    const Real limit = p.rollingFriction * c.effectiveRadius * std::abs(normal.force);
    const Real stop = shareOfStop<Real> * spin / (c.inverseSpinInertia * step.dt);
    const V3In<Real> resistance = (smaller(limit, stop) / larger(spin, tinyIn<Real>)) * c.relativeSpin;
    return {-resistance, 0, 0, dot(resistance, c.relativeSpin) * step.dt};
  }
};

}  // namespace tsubu::sim
