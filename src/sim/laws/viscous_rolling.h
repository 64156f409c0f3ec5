#pragma once
// Viscous rolling resistance.
//
//   R6   M = −μ_v R*² |F_n| ω_r      ω_r  relative spin without its part about n, rad/s
//   R2   |M| ≤ |ω_r| / (16 (1/I_i + 1/I_j) Δt)
//
//   μ_v  rolling viscosity, s/m: the lever of the normal force is R* times μ_v times the rolling speed R* ω_r
//
// Source: Zhou et al., Physica A 269 (1999) 536, model B, with R* for both lengths so that the two moments are opposite.
// Proven by tests/sim/laws/rolling_test.cpp.

#include "sim/laws/rolling.h"

namespace tsubu::sim {

struct ViscousRolling {
  static constexpr std::string_view name = "viscous";
  static constexpr std::string_view sentence =
      "Torque proportional to rolling speed and load (R6); no memory: slows rolling, holds nothing.";
  static constexpr std::array reads{need(Property::rollingViscosity)};
  static constexpr bool acts = true, common = false;
  template <bool growing, class Real>
  using MemoryIn = NoMemory<Family::rolling>;

  template <class Real>
  struct PairIn {
    Real viscosity;  // μ_v
  };
  using Pair = PairIn<double>;
  static Pair prepare(const PairValues& values) { return {values[Property::rollingViscosity]}; }
  /// Bounded by R2 in any step.
  static ContactMode mode(const Pair&, double, double) { return {}; }

  template <class Real>
  TSUBU_LAW RollingMomentIn<Real> moment(const PairIn<Real>& p, const ContactIn<Real>& c, const NormalForceIn<Real>& normal,
                                         StepIn<Real> step, NoMemory<Family::rolling>&) {
    const V3In<Real> rolling = c.relativeSpin - dot(c.relativeSpin, c.n) * c.n;
    const Real wanted = p.viscosity * c.effectiveRadius * c.effectiveRadius * std::abs(normal.force);
    const V3In<Real> resistance = smaller(wanted, shareOfStop<Real> / (c.inverseSpinInertia * step.dt)) * rolling;
    return {-resistance, 0, 0, dot(resistance, rolling) * step.dt};
  }
};

}  // namespace tsubu::sim
