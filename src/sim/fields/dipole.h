#pragma once
// Two magnetic dipoles (docs/physics.md, F5, F6). SI; n points from j to i, R is their distance, κ = μ₀/4π.
//
//   F5   B_i = κ/R³ (3 (m_j·n) n − m_j),  U = −m_i·B_i
//        F_i = 3κ/R⁴ ((m_i·n) m_j + (m_j·n) m_i + (m_i·m_j) n − 5 (m_i·n)(m_j·n) n)
//   F6   cut off smoothly: S U with S = 1 up to R₁ = 0.8 R_c, then 1 − t³(10 − 15t + 6t²), t = (R − R₁)/(R_c − R₁)
//
// The force of S U is S F − S′ U n. The torque p × S B of the moments that are fixed in the grains together with this force keeps angular
// momentum: p_i × B_i + p_j × B_j + (x_i − x_j) × F_i = 0. Source: Jackson, Classical Electrodynamics, 5.6 and 5.7.

#include "sim/laws/arithmetic.h"

namespace tsubu::sim {

inline constexpr double magneticConstant = 1e-7;  ///< μ₀/4π, T m/A (exact to 1e-9 since 2019)

/// What j does to i: field and energy are what S makes of them.
struct DipolePair {
  V3 field;       ///< T, at i
  V3 force;       ///< N, on i
  double energy;  ///< J, of the pair
};

/// Where a pair interaction ends.
struct CutOff {
  double outer = 0, inner = 0, inverseWidth = 0;

  CutOff() = default;
  explicit CutOff(double distance) : outer(distance), inner(0.8 * distance), inverseWidth(1 / (0.2 * distance)) {}
};

TSUBU_INLINE DipolePair dipolePair(V3 d, V3 mi, V3 mj, const CutOff& cut) {
  const double distance2 = norm2(d);
  if (!(distance2 < cut.outer * cut.outer)) return {{0, 0, 0}, {0, 0, 0}, 0};
  const double distance = std::sqrt(distance2), inverse = 1 / distance;
  const V3 n = inverse * d;
  const double strength = magneticConstant * inverse * inverse * inverse, ai = dot(mi, n), aj = dot(mj, n);
  V3 field = strength * ((3 * aj) * n - mj);
  V3 force = (3 * strength * inverse) * (ai * mj + aj * mi + (dot(mi, mj) - 5 * ai * aj) * n);
  double energy = -dot(mi, field);
  if (distance > cut.inner) {
    const double t = (distance - cut.inner) * cut.inverseWidth;
    const double share = 1 - t * t * t * (10 - t * (15 - 6 * t)), slope = -30 * cut.inverseWidth * t * t * (1 - t) * (1 - t);
    force = share * force - (slope * energy) * n;
    field = share * field;
    energy *= share;
  }
  return {field, force, energy};
}

}  // namespace tsubu::sim
