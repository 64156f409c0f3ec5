#pragma once
// One step of one bond: a linear, elastic, massless beam of circular section between two grains, clamped at both.
//
//   B1  r_b = λ min(R_i, R_j),  A = π r_b²,  J = ½ A r_b²,  I = ½ J
//   B2  F_n = k_n A (r_0 − r) along n;  F_t = −k_t A s, across;  M_n = −k_t J θ_n, torsion;  M_t = −k_n I θ_t, bending
//   B3  ṡ = v_t (T0, arms l_i + l_j = r),  θ̇ = ω_i − ω_j,  in a frame (n, t, b) that turns with the bond
//   B4  percent:      F ← F − η |F| sgn(v), component by component in that frame
//   B5  exponential:  Ḟ = −η F beside the springs, the rest length included: what they hold relaxes
//   B6  viscous:      F ← F − 2ζ √(k m) v, m the mass that the component moves
//
// The force on i is F, on j −F; the couple of F is that of a contact, T_i = −l_i n × F, T_j = −l_j n × F; M acts on i, −M on j.
//
// Springs are kept as numbers in the bond's own frame: carrying that frame is all that the turning of the bond takes, and nothing
// leaks from turning a vector. Memory lives at whole steps. From step to step it is advanced with the velocities of the half step that
// moved the grains, in geometry averaged over both ends of it, so that going back undoes it: without damping energy neither
// grows nor falls, in either integrator, and needs none of the least dashpot of T6. Dampers see the velocity of the instant.
//
// Source: "linear bond model" (Bond 1–14), corrected (docs/physics.md). Proven by tests/sim/bonds and tests/verification/bonds_test.cpp.

#include <cmath>

#include "sim/bonds/bonding.h"
#include "sim/laws/arithmetic.h"

namespace tsubu::sim {

/// What all bonds of a kind have in common.
struct BondKind {
  double shearOverNormal;  ///< k_t/k_n
  double eta[bondWays];    ///< B4: shares; B5: 1/s; B6: dashpots over critical ones, of BondBody
  double perTension, perCompression;  ///< 1/Pa: one over the strength, 0 for never
  double shear, pressureSlope;        ///< Pa: τ_max; tan φ
  double perStretch;                  ///< one over the stretch that breaks
};

inline BondKind kindOf(const Bonding& bonding) {
  BondKind kind{};
  kind.shearOverNormal = 1 / bonding.stiffnessRatio;
  for (int way = 0; way < bondWays; ++way) kind.eta[way] = bonding.dampingOf[static_cast<std::size_t>(way)];
  if (bonding.damping == BondDamping::viscous) {
    // Spheres that slip move 2/7 of their mass; k_t J = 2 (k_t/k_n) k_n I.
    kind.eta[across] *= std::sqrt(2.0 / 7.0 * kind.shearOverNormal);
    kind.eta[twisting] *= std::sqrt(2 * kind.shearOverNormal);
  }
  const BondStrength& strength = bonding.strength;
  kind.perTension = 1 / strength.tension;
  kind.perCompression = 1 / strength.compression;
  kind.shear = strength.shear;
  kind.pressureSlope = strength.pressureSlope;
  kind.perStretch = 1 / strength.stretch;
  return kind;
}

/// What is kept of a bond from step to step.
struct BondMemory {
  V3 t;                          ///< unit vector across, of the bond's frame (n, t, n × t)
  double shearT, shearB;         ///< s, m
  double twist, bendT, bendB;    ///< θ, rad
  double rest;                   ///< r_0, m
};

/// What does not change.
struct BondBody {
  double radius;       ///< r_b, m
  double stiffness;    ///< k_n, N/m³
  double length;       ///< m, when it was made
  double critical;     ///< B6: critical dashpot along the bond, 2 √(k_n A m*), kg/s
  double bendCritical; ///< B6: of bending, 2 √(k_n I I*), N m s
};

inline constexpr double bondPi = 3.141592653589793;

/// How the two grains move against each other: i − j, and sums i + j of r ω.
struct BondMotion {
  V3 velocity;   ///< m/s
  V3 spinSum;    ///< r_i ω_i + r_j ω_j, m/s
  V3 spin;       ///< ω_i − ω_j, rad/s
};

struct BondForce {
  V3 force;    ///< on i
  V3 couple;   ///< n × F
  V3 moment;   ///< on i
  double arm;  ///< l over R of the same end
  double loss;      ///< J: what dampers take in the step
  double relaxed;   ///< J: what B5 has taken since the step before
  bool holds;       ///< or breaks now
  double released;  ///< J: what the springs held half a step ago, when a bond that breaks now last pulled
};

TSUBU_INLINE double signOf(double v) { return v > 0 ? 1.0 : (v < 0 ? -1.0 : 0.0); }

/// The energy of the springs, given their elongation along n, times a second state of theirs: ½ Σ k a b. With a = b what is stored.
TSUBU_INLINE double springProduct(const BondBody& body, double shearOverNormal, double stretchA, double stretchB, const BondMemory& a,
                                  const BondMemory& b) {
  const double radius2 = body.radius * body.radius, area = bondPi * radius2;
  const double inertia = 0.25 * area * radius2;  // I; J = 2 I
  return 0.5 * body.stiffness *
         (area * (stretchA * stretchB + shearOverNormal * (a.shearT * b.shearT + a.shearB * b.shearB)) +
          inertia * (2 * shearOverNormal * (a.twist * b.twist) + (a.bendT * b.bendT + a.bendB * b.bendB)));
}

/// Stresses of a bond, Pa: along it (positive in compression), in the outermost fibre by bending, and across it with what torsion adds.
struct BondStress {
  double axial, fibre, shear;
};
TSUBU_INLINE BondStress bondStress(double radius, double normal, double shear2, double torsion, double bending2) {
  const double inverse = 1 / radius, perArea = (1 / bondPi) * inverse * inverse, section = 4 * perArea * inverse;  // r_b/I, twice r_b/J
  return {normal * perArea, std::sqrt(bending2) * section, std::sqrt(shear2) * perArea + 0.5 * std::abs(torsion) * section};
}
TSUBU_INLINE double shearStrength(const BondKind& kind, double axial) { return kind.shear + kind.pressureSlope * larger(axial, 0); }

/// B7–B10: the largest of the stresses over its strength; `stretch` is r over the first length. 1 breaks.
TSUBU_INLINE double bondLoad(const BondKind& kind, const BondStress& stress, double stretch) {
  const double pull = (stress.fibre - stress.axial) * kind.perTension, push = (stress.fibre + stress.axial) * kind.perCompression;
  return larger(larger(pull, push), larger(stress.shear / shearStrength(kind, stress.axial), stretch * kind.perStretch));
}
/// The same without a division, where it matters only whether the bond holds.
TSUBU_INLINE bool bondHolds(const BondKind& kind, const BondStress& stress, double r, double length) {
  const double pull = (stress.fibre - stress.axial) * kind.perTension, push = (stress.fibre + stress.axial) * kind.perCompression;
  return larger(larger(larger(pull, push) - 1, stress.shear - shearStrength(kind, stress.axial)), r * kind.perStretch - length) < 0;
}

/// \brief Advances the memory by a step and returns what the bond does.
/// \param d      x_i − x_j now
/// \param moved  motion in the half step that led here
/// \param now    motion of the instant; read by dampers only
template <BondDamping damping, bool breakable>
TSUBU_INLINE BondForce stepBond(const BondKind& kind, const BondBody& body, V3 d, double radiusSum, const BondMotion& moved,
                                const BondMotion& now, double dt, BondMemory& memory) {
  const BondMemory before = memory;
  const V3 d0 = d - dt * moved.velocity;
  const double r = norm(d), r0 = norm(d0);
  // One division for three reciprocals, here and below: divisions are what the loop waits for.
  const double all = 1 / (r * r0 * radiusSum), inverseRadiusSum = all * r * r0;
  const V3 n = (all * r0 * radiusSum) * d, n0 = (all * r * radiusSum) * d0;
  // The frame: the smallest rotation from n0 to n, then about n with the mean spin of the grains.
  const V3 mid = n0 + n;
  const double angle = 0.5 * dt * inverseRadiusSum * dot(moved.spinSum, mid), quarter = 0.25 * angle * angle;
  const double bend = 1 + dot(n0, n), both = 1 / (bend * (1 + quarter));
  V3 t = before.t - (dot(before.t, n) * (both * (1 + quarter))) * mid;
  t = (both * bend) * ((1 - quarter) * t + angle * cross(n, t));
  t = t - dot(t, n) * n;
  t = (1.5 - 0.5 * norm2(t)) * t;
  const V3 b = cross(n, t), b0 = cross(n0, before.t);
  // B3, with frame and arms half-way.
  const V3 halfN = 0.5 * mid, halfT = 0.5 * (before.t + t), halfB = 0.5 * (b0 + b);
  const double arm = r * inverseRadiusSum, halfArm = 0.5 * (r0 + r) * inverseRadiusSum;
  const double slipT = dt * (dot(moved.velocity, halfT) - halfArm * dot(moved.spinSum, halfB));
  const double slipB = dt * (dot(moved.velocity, halfB) + halfArm * dot(moved.spinSum, halfT));
  const double turnN = dt * dot(moved.spin, halfN), turnT = dt * dot(moved.spin, halfT), turnB = dt * dot(moved.spin, halfB);
  const double stretchBefore = before.rest - r0;
  double stretch = before.rest - r;
  memory.t = t;
  if constexpr (damping == BondDamping::exponential) {
    // (1 − ½ηΔt)/(1 + ½ηΔt) rather than 1 − ηΔt (Bond 11): second order, and the loss below is exact.
    const auto relax = [&](BondWay way, double spring, double gain) {
      const double half = 0.5 * kind.eta[way] * dt;
      return ((1 - half) * spring + gain) / (1 + half);
    };
    stretch = relax(along, stretchBefore, r0 - r);
    memory.rest = stretch + r;
    memory.shearT = relax(across, before.shearT, slipT);
    memory.shearB = relax(across, before.shearB, slipB);
    memory.twist = relax(twisting, before.twist, turnN);
    memory.bendT = relax(bending, before.bendT, turnT);
    memory.bendB = relax(bending, before.bendB, turnB);
  } else {
    memory.shearT = before.shearT + slipT;
    memory.shearB = before.shearB + slipB;
    memory.twist = before.twist + turnN;
    memory.bendT = before.bendT + turnT;
    memory.bendB = before.bendB + turnB;
  }
  // B2.
  const double radius2 = body.radius * body.radius;
  const double normalK = body.stiffness * bondPi * radius2, shearK = kind.shearOverNormal * normalK;
  const double bendK = 0.25 * normalK * radius2, twistK = 2 * kind.shearOverNormal * bendK;
  double fn = normalK * stretch, ft = -shearK * memory.shearT, fb = -shearK * memory.shearB;
  double mn = -twistK * memory.twist, mt = -bendK * memory.bendT, mb = -bendK * memory.bendB;
  BondForce result{};
  result.holds = true;
  if constexpr (breakable) {
    result.holds = bondHolds(kind, bondStress(body.radius, fn, ft * ft + fb * fb, mn, mt * mt + mb * mb), r, body.length);
    result.released = springProduct(body, kind.shearOverNormal, stretchBefore, stretch, before, memory);
  }
  if constexpr (damping == BondDamping::exponential) {
    const auto lost = [&](BondWay way, double stiffness, double a, double b1) {
      const double mean = 0.5 * (a + b1);
      return kind.eta[way] * stiffness * mean * mean;
    };
    result.relaxed = dt * (lost(along, normalK, stretchBefore, stretch) + lost(across, shearK, before.shearT, memory.shearT) +
                           lost(across, shearK, before.shearB, memory.shearB) + lost(twisting, twistK, before.twist, memory.twist) +
                           lost(bending, bendK, before.bendT, memory.bendT) + lost(bending, bendK, before.bendB, memory.bendB));
  }
  if constexpr (damping == BondDamping::percent || damping == BondDamping::viscous) {
    const double vn = dot(now.velocity, n);
    const double vt = dot(now.velocity, t) - arm * dot(now.spinSum, b), vb = dot(now.velocity, b) + arm * dot(now.spinSum, t);
    const double wn = dot(now.spin, n), wt = dot(now.spin, t), wb = dot(now.spin, b);
    const auto damp = [&](BondWay way, double& force, double v, double dashpot) {
      const double part = damping == BondDamping::percent ? kind.eta[way] * std::abs(force) * signOf(v) : kind.eta[way] * dashpot * v;
      force -= part;
      return part * v;
    };
    result.loss = dt * (damp(along, fn, vn, body.critical) + damp(across, ft, vt, body.critical) + damp(across, fb, vb, body.critical) +
                        damp(twisting, mn, wn, body.bendCritical) + damp(bending, mt, wt, body.bendCritical) +
                        damp(bending, mb, wb, body.bendCritical));
  }
  result.arm = arm;
  result.force = fn * n + ft * t + fb * b;
  result.couple = ft * b - fb * t;
  result.moment = mn * n + mt * t + mb * b;
  return result;
}

}  // namespace tsubu::sim
