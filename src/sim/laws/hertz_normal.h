#pragma once
// Hertz normal contact with a dashpot.
//
//   N6   F_n = 4/3 E* √R* δ^{3/2} − η_n v_n
//   N7   η_n = 2 √(5/6) ζ(e) √(S m*),   S = dF/dδ = 2 E* √(R* δ),   ζ as for the linear contact (N3)
//   N8   1/E* = (1−ν_i²)/E_i + (1−ν_j²)/E_j
//   N2   F_n ≥ 0 unless tension is allowed
//
//   E   Young's modulus, Pa     ν  Poisson's ratio     R*  effective radius, m     m*  effective mass, kg
//
// Why ζ is the same: with y = (2/√5) δ^{5/4} (in units where 4/3 E* √R* and m* are 1) the motion v dv/dδ = −δ^{3/2} − √5 ζ δ^{1/4} v
// becomes v dv/dy = −y − 2ζ v, the damped linear oscillator, and the end of the contact F = 0 becomes its end y = −2ζ v. So the
// restitution does not depend on speed, and N3 holds word for word, with tension and without.
//
// Source: Hertz 1882; Tsuji, Tanaka & Ishida, Powder Technology 71 (1992) 239; the exact relation: Antypov & Elliott, EPL 94 (2011)
// 50004, for contacts with tension. Holds for δ ≪ R*. Proven by tests/sim/laws/hertz_normal_test.cpp and
// tests/verification/hertz_test.cpp.

#include <array>
#include <cmath>
#include <limits>
#include <string_view>

#include "sim/laws/damping_from_restitution.h"
#include "sim/laws/normal.h"
#include "sim/properties.h"

namespace tsubu::sim {

/// N8, Pa.
inline double effectiveModulus(const PairValues& values) {
  const auto compliance = [](double young, double poisson) { return (1 - poisson * poisson) / young; };
  return 1 / (compliance(values.first[Property::youngModulus], values.first[Property::poissonRatio]) +
              compliance(values.second[Property::youngModulus], values.second[Property::poissonRatio]));
}

struct HertzNormal {
  static constexpr std::string_view name = "hertz";
  static constexpr std::string_view sentence =
      "Hertz contact with a dashpot (N6–N8): stiffness from elastic moduli, growing with the overlap.";
  static constexpr std::array reads{need(Property::youngModulus), need(Property::poissonRatio), need(Property::restitution)};
  static constexpr bool growing = true;
  static constexpr bool common = true;

  template <class Real>
  struct PairIn {
    Real twiceModulus;  // 2 E*
    Real damping;       // 2 √(5/6) ζ
    Real least;         // smallest force: 0, or −∞ with tension
  };
  using Pair = PairIn<double>;

  static Pair prepare(const PairValues& values, bool tension) {
    return {2 * effectiveModulus(values), 2 * std::sqrt(5.0 / 6.0) * dampingRatio(values[Property::restitution], tension),
            tension ? -std::numeric_limits<double>::infinity() : 0.0};
  }

  static double stiffness(const Pair& p, double overlap, double effectiveRadius) {
    return p.twiceModulus * std::sqrt(effectiveRadius * overlap);
  }
  static double damping(const Pair& p, double effectiveMass, double stiffness) { return p.damping * std::sqrt(stiffness * effectiveMass); }

  template <class Real>
  static bool readsRootMass(const PairIn<Real>&) {
    return true;
  }

  template <class Real>
  TSUBU_LAW NormalForceIn<Real> force(const PairIn<Real>& p, const ContactIn<Real>& c, StepIn<Real>) {
    const Real stiffness = p.twiceModulus * std::sqrt(c.effectiveRadius * larger(c.overlap, Real(0)));
    const Real perRoot = p.damping * c.rootMass, damping = perRoot * std::sqrt(stiffness);
    const Real elastic = Real(2.0 / 3.0) * stiffness * c.overlap;
    return {larger(elastic - damping * c.separationSpeed, p.least), elastic, Real(0.4) * elastic * c.overlap, stiffness, damping, perRoot};
  }
};

}  // namespace tsubu::sim
