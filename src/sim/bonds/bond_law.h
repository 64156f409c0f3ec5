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
  BondStrength strength;
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
  kind.strength = bonding.strength;
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
  V3 couple;   ///< Q = (l/R) n × F, the same at both ends: torques −R Q (grain_rows.h)
  V3 moment;   ///< on i
  double loss;      ///< J: what dampers take in the step
  double relaxed;   ///< J: what B5 has taken since the step before
  bool holds;       ///< or breaks now
};

/// How far the springs are stretched, in the bond's frame.
struct BondStrain {
  double stretch;         ///< r_0 − r, m
  double shearT, shearB;  ///< s, m
  double twist, bendT, bendB;  ///< θ, rad
};
TSUBU_INLINE BondStrain strainOf(const BondMemory& memory, double r) {
  return {memory.rest - r, memory.shearT, memory.shearB, memory.twist, memory.bendT, memory.bendB};
}

/// N/m and N m: k_n A, k_t A, k_t J, k_n I.
struct BondSprings {
  double along, across, twist, bend;
};
TSUBU_INLINE BondSprings springsOf(const BondBody& body, double shearOverNormal) {
  const double radius2 = body.radius * body.radius, along = body.stiffness * bondPi * radius2, bend = 0.25 * along * radius2;
  return {along, shearOverNormal * along, 2 * shearOverNormal * bend, bend};
}

/// The energy of the springs when both states are the same; otherwise between the two: ½ Σ k a b.
TSUBU_INLINE double springProduct(const BondSprings& k, const BondStrain& a, const BondStrain& b) {
  return 0.5 * (k.along * (a.stretch * b.stretch) + k.across * (a.shearT * b.shearT + a.shearB * b.shearB) + k.twist * (a.twist * b.twist) +
                k.bend * (a.bendT * b.bendT + a.bendB * b.bendB));
}

/// What springs and dampers do, in the bond's frame: force and moment on i.
struct BondPull {
  double fn, ft, fb, mn, mt, mb;
};
/// B2.
TSUBU_INLINE BondPull pullOf(const BondSprings& k, const BondStrain& strain) {
  return {k.along * strain.stretch, -(k.across * strain.shearT), -(k.across * strain.shearB),
          -(k.twist * strain.twist), -(k.bend * strain.bendT), -(k.bend * strain.bendB)};
}

/// B7–B10: the largest of the stresses over its strength, r its length over the first one. 1 breaks.
/// Stresses: along the bond (positive in compression), in the outermost fibre by bending, across it with what torsion adds.
TSUBU_INLINE double bondLoad(const BondStrength& strength, const BondBody& body, const BondPull& pull, double r) {
  const double area = bondPi * body.radius * body.radius, section = 0.25 * area * body.radius;  // I/r_b, half of J/r_b
  const double axial = pull.fn / area, fibre = std::sqrt(pull.mt * pull.mt + pull.mb * pull.mb) / section;
  const double shear = std::sqrt(pull.ft * pull.ft + pull.fb * pull.fb) / area + 0.5 * std::abs(pull.mn) / section;
  const double resistance = strength.shear + strength.pressureSlope * larger(axial, 0);
  return larger(larger((fibre - axial) / strength.tension, (fibre + axial) / strength.compression),
                larger(shear / resistance, r / (body.length * strength.stretch)));
}
/// Is that less than 1? Without quotients and roots, which a loop over bonds would wait for: both sides of each comparison times A r_b.
TSUBU_INLINE bool bondHolds(const BondStrength& strength, const BondBody& body, const BondPull& pull, double r) {
  const double volume = bondPi * body.radius * body.radius * body.radius, push = pull.fn * body.radius;
  const double fibre = smaller(strength.tension * volume + push, strength.compression * volume - push);  // left for 4 M
  const double shear = strength.shear * volume + strength.pressureSlope * larger(push, 0) - 2 * std::abs(pull.mn);  // left for r_b F
  const double bending2 = 16 * (pull.mt * pull.mt + pull.mb * pull.mb), shear2 = body.radius * body.radius * (pull.ft * pull.ft + pull.fb * pull.fb);
  // Of a limit that is below zero already, the square says nothing.
  const double over = larger(bending2 - fibre * larger(fibre, 0), shear2 - shear * larger(shear, 0));
  return larger(over, r - strength.stretch * body.length) < 0;
}

/// A bond at both ends of a step: unit vectors along it, its lengths, and 1/(R_i + R_j).
struct BondAxis {
  V3 n0, n;
  double r0, r;
  double perRadiusSum;
};
/// \param d         x_i − x_j now
/// \param velocity  with which it has come there
TSUBU_INLINE BondAxis axisOf(V3 d, double radiusSum, V3 velocity, double dt) {
  const V3 d0 = d - dt * velocity;
  const double r = norm(d), r0 = norm(d0);
  // One division for three reciprocals, here and below: divisions are what the loop waits for.
  const double all = 1 / (r * r0 * radiusSum);
  return {(all * r * radiusSum) * d0, (all * r0 * radiusSum) * d, r0, r, all * (r * r0)};
}

/// The rest of the frame (n, t, b) now, and of twice the mean of both ends of the step.
struct BondFrame {
  V3 t, b;
  V3 sumT, sumB;
};
/// The smallest rotation from n0 to n, then about n with the mean spin of the grains.
TSUBU_INLINE BondFrame turned(V3 t0, const BondAxis& axis, V3 spinSum, double dt) {
  const V3 n0 = axis.n0, n = axis.n, sumN = n0 + n;
  const double angle = 0.5 * dt * axis.perRadiusSum * dot(spinSum, sumN), quarter = 0.25 * angle * angle;
  const double bend = 1 + dot(n0, n), both = 1 / (bend * (1 + quarter));
  // At right angles to n, however exact t0 is; its length is held by a step of Newton's for 1/√.
  const V3 laid = t0 - (dot(t0, n) * (both * (1 + quarter))) * sumN;
  const double scale = both * bend * (1.5 - 0.5 * norm2(t0));
  const V3 t = (scale * (1 - quarter)) * laid + (scale * angle) * cross(n, laid), b = cross(n, t);
  return {t, b, t0 + t, cross(n0, t0) + b};
}

/// B3, with frame and arms half-way: by how much the springs are stretched further.
TSUBU_INLINE BondStrain strainBy(const BondMotion& moved, const BondAxis& axis, V3 sumT, V3 sumB, double dt) {
  const V3 sumN = axis.n0 + axis.n;
  const double half = 0.5 * dt, arm = 0.5 * (axis.r0 + axis.r) * axis.perRadiusSum;
  return {axis.r0 - axis.r,
          half * (dot(moved.velocity, sumT) - arm * dot(moved.spinSum, sumB)),
          half * (dot(moved.velocity, sumB) + arm * dot(moved.spinSum, sumT)),
          half * dot(moved.spin, sumN),
          half * dot(moved.spin, sumT),
          half * dot(moved.spin, sumB)};
}

/// The springs at the end of the step.
template <BondDamping damping>
TSUBU_INLINE BondStrain stretched(const BondKind& kind, const BondStrain& before, const BondStrain& by, double dt) {
  if constexpr (damping == BondDamping::exponential) {
    // (1 − ½ηΔt)/(1 + ½ηΔt) rather than 1 − ηΔt (Bond 11): second order, and what `relaxedIn` says is lost is exact.
    const auto relax = [&](BondWay way, double spring, double gain) {
      const double half = 0.5 * kind.eta[way] * dt;
      return ((1 - half) * spring + gain) / (1 + half);
    };
    return {relax(along, before.stretch, by.stretch), relax(across, before.shearT, by.shearT), relax(across, before.shearB, by.shearB),
            relax(twisting, before.twist, by.twist),  relax(bending, before.bendT, by.bendT),  relax(bending, before.bendB, by.bendB)};
  }
  return {before.stretch + by.stretch, before.shearT + by.shearT, before.shearB + by.shearB,
          before.twist + by.twist,     before.bendT + by.bendT,   before.bendB + by.bendB};
}

/// B5: what relaxation has taken between two states, J.
TSUBU_INLINE double relaxedIn(const BondKind& kind, const BondSprings& k, const BondStrain& a, const BondStrain& b, double dt) {
  const auto lost = [&](BondWay way, double stiffness, double a1, double b1) {
    const double mean = 0.5 * (a1 + b1);
    return kind.eta[way] * stiffness * mean * mean;
  };
  return dt * (lost(along, k.along, a.stretch, b.stretch) + lost(across, k.across, a.shearT, b.shearT) +
               lost(across, k.across, a.shearB, b.shearB) + lost(twisting, k.twist, a.twist, b.twist) +
               lost(bending, k.bend, a.bendT, b.bendT) + lost(bending, k.bend, a.bendB, b.bendB));
}

TSUBU_INLINE double signOf(double v) { return v > 0 ? 1.0 : (v < 0 ? -1.0 : 0.0); }

/// B4, B6: takes from the pull what dampers hold back, and returns what they take from the energy in the step, J.
template <BondDamping damping>
TSUBU_INLINE double dampPull(const BondKind& kind, const BondBody& body, const BondMotion& now, V3 n, V3 t, V3 b, double arm, double dt,
                             BondPull& pull) {
  const double vn = dot(now.velocity, n);
  const double vt = dot(now.velocity, t) - arm * dot(now.spinSum, b), vb = dot(now.velocity, b) + arm * dot(now.spinSum, t);
  const double wn = dot(now.spin, n), wt = dot(now.spin, t), wb = dot(now.spin, b);
  const auto damp = [&](BondWay way, double& force, double v, double dashpot) {
    const double part = damping == BondDamping::percent ? kind.eta[way] * std::abs(force) * signOf(v) : kind.eta[way] * dashpot * v;
    force -= part;
    return part * v;
  };
  return dt * (damp(along, pull.fn, vn, body.critical) + damp(across, pull.ft, vt, body.critical) +
               damp(across, pull.fb, vb, body.critical) + damp(twisting, pull.mn, wn, body.bendCritical) +
               damp(bending, pull.mt, wt, body.bendCritical) + damp(bending, pull.mb, wb, body.bendCritical));
}

/// The pull as vectors.
TSUBU_INLINE void resolve(const BondPull& pull, V3 n, V3 t, V3 b, double arm, BondForce& to) {
  to.force = pull.fn * n + pull.ft * t + pull.fb * b;
  to.couple = (arm * pull.ft) * b - (arm * pull.fb) * t;
  to.moment = pull.mn * n + pull.mt * t + pull.mb * b;
}

/// Stretches the springs of a bond whose frame has been turned, and says how they were before.
template <BondDamping damping>
TSUBU_INLINE BondStrain stretchBond(const BondKind& kind, const BondAxis& axis, V3 sumT, V3 sumB, const BondMotion& moved, double dt,
                                    BondMemory& memory) {
  const BondStrain before = strainOf(memory, axis.r0);
  const BondStrain now = stretched<damping>(kind, before, strainBy(moved, axis, sumT, sumB, dt), dt);
  if constexpr (damping == BondDamping::exponential) memory.rest = now.stretch + axis.r;
  memory.shearT = now.shearT, memory.shearB = now.shearB;
  memory.twist = now.twist, memory.bendT = now.bendT, memory.bendB = now.bendB;
  return before;
}

/// \brief What a bond does, with its springs as they are now.
/// \param before  the springs at the beginning of the step; read by B5 only
/// \param now     motion of the instant; read by dampers only
template <BondDamping damping, bool breakable>
TSUBU_INLINE BondForce pullBond(const BondKind& kind, const BondBody& body, const BondMemory& memory, const BondStrain& before, V3 n, V3 b,
                                double r, double perRadiusSum, const BondMotion& now, double dt) {
  const BondSprings springs = springsOf(body, kind.shearOverNormal);
  const BondStrain strain = strainOf(memory, r);
  const double arm = r * perRadiusSum;
  BondPull pull = pullOf(springs, strain);
  BondForce result{};
  result.holds = true;
  if constexpr (breakable) result.holds = bondHolds(kind.strength, body, pull, r);
  if constexpr (damping == BondDamping::exponential) result.relaxed = relaxedIn(kind, springs, before, strain, dt);
  if constexpr (damping == BondDamping::percent || damping == BondDamping::viscous)
    result.loss = dampPull<damping>(kind, body, now, n, memory.t, b, arm, dt, pull);
  resolve(pull, n, memory.t, b, arm, result);
  return result;
}

/// One step of one bond: advances the memory and returns what the bond does. The kernels take many bonds through these four parts one
/// after the other (kernel/bond_passes.h).
template <BondDamping damping, bool breakable>
TSUBU_INLINE BondForce stepBond(const BondKind& kind, const BondBody& body, V3 d, double radiusSum, const BondMotion& moved,
                                const BondMotion& now, double dt, BondMemory& memory) {
  const BondAxis axis = axisOf(d, radiusSum, moved.velocity, dt);
  const BondFrame frame = turned(memory.t, axis, moved.spinSum, dt);
  memory.t = frame.t;
  const BondStrain before = stretchBond<damping>(kind, axis, frame.sumT, frame.sumB, moved, dt, memory);
  return pullBond<damping, breakable>(kind, body, memory, before, axis.n, frame.b, axis.r, axis.perRadiusSum, now, dt);
}

}  // namespace tsubu::sim
