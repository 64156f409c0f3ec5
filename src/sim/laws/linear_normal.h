#pragma once
// Linear Kelvin–Voigt normal contact.
//
//   N1   F_n = k_n δ − η_n v_n                      (the force on i is F_n n)
//   N2   F_n ≥ 0 unless tension is allowed
//
//   k_n  normal stiffness, N/m              δ    overlap, m
//   η_n  damping, kg/s                      v_n  separation speed, m/s
//
// Damping from the restitution coefficient e (damping_from_restitution.h):
//   N3   η_n = 2 ζ(e) √(m* k_n)    with ζ the damping ratio that gives e, with tension or without
// or from a rate: N4  η_n = m* γ_n. In the steps in which a contact begins or ends the dashpot sees N5 (normal.h).
//
// Source: Cundall & Strack 1979; the damped oscillator of a contact, with N3 inverted for both ends of a contact.
// Holds for any overlap; stiffness does not depend on radius. Proven by tests/sim/laws/linear_normal_test.cpp.

#include <array>
#include <cmath>
#include <limits>
#include <string_view>

#include "sim/laws/damping_from_restitution.h"
#include "sim/laws/normal.h"
#include "sim/properties.h"

namespace tsubu::sim {

struct LinearNormal {
  static constexpr std::string_view name = "linear";
  static constexpr std::string_view sentence = "Linear spring and dashpot (N1): stiffness independent of overlap and radius.";
  static constexpr std::array reads{need(Property::normalStiffness), needEither(Property::restitution, Property::normalDampingRate)};
  static constexpr bool growing = false;  ///< see normal.h
  static constexpr bool common = true;

  template <class Real>
  struct PairIn {
    Real stiffness;           // k_n
    Real perRootStiffness;    // 1/√k_n
    Real dampingPerRootMass;  // η_n/√m*, from restitution
    Real dampingPerMass;      // η_n/m*, from a rate
    Real least;               // smallest force: 0, or −∞ with tension
  };
  using Pair = PairIn<double>;

  static Pair prepare(const PairValues& values, bool tension) {
    Pair p{};
    p.stiffness = values[Property::normalStiffness];
    p.perRootStiffness = 1 / std::sqrt(p.stiffness);
    if (values.has(Property::normalDampingRate))
      p.dampingPerMass = values[Property::normalDampingRate];
    else
      p.dampingPerRootMass = 2 * dampingRatio(values[Property::restitution], tension) * std::sqrt(p.stiffness);
    p.least = tension ? -std::numeric_limits<double>::infinity() : 0.0;
    return p;
  }

  /// For the time step: stiffness, N/m, and damping, kg/s, at an overlap (m) of grains with R* and m*.
  static double stiffness(const Pair& p, double, double) { return p.stiffness; }
  static double damping(const Pair& p, double effectiveMass, double) {
    return p.dampingPerRootMass * std::sqrt(effectiveMass) + p.dampingPerMass * effectiveMass;
  }

  template <class Real>
  static bool readsRootMass(const PairIn<Real>& p) {
    return p.dampingPerRootMass != 0;
  }

  template <class Real>
  TSUBU_LAW NormalForceIn<Real> force(const PairIn<Real>& p, const ContactIn<Real>& c, StepIn<Real> step) {
    const Real damping = p.dampingPerRootMass * c.rootMass + p.dampingPerMass * c.effectiveMass;
    const Real elastic = p.stiffness * c.overlap;
    const Real force = larger(elastic - damping * sampledSpeed(c, step), p.least);
    return {force, elastic, Real(0.5) * elastic * c.overlap, p.stiffness, damping, damping * p.perRootStiffness};
  }
};

}  // namespace tsubu::sim
