#pragma once
// One step of one bond: a linear, elastic, massless beam of circular section between two grains, clamped at both.
//
//   B1  r_b = λ min(R_i, R_j),  A = π r_b²,  J = ½ A r_b²,  I = ½ J
//   B2  F_n = k_n A (r_0 − r) along n;  F_t = −k_t A s, across;  M_n = −k_t J θ_n, torsion;  M_t = −k_n I θ_t, bending
//   B3  ṡ = v_t (T0, arms l_i + l_j = r),  θ̇ = ω_i − ω_j,  turning with the bond
//   B4  percent:      F ← F − η |F| v/|v|, for what is along, across, twists, bends
//   B5  exponential:  Ḟ = −η F beside the springs, the rest length included: what they hold relaxes
//   B6  viscous:      F ← F − 2ζ √(k m) v, m the mass that the component moves
//
// The force on i is F, on j −F; the couple of F is that of a contact, T_i = −l_i n × F, T_j = −l_j n × F; M acts on i, −M on j.
//
// Springs are vectors that turn with the bond: by one rotation in each step, exactly orthogonal, so that nothing leaks. Memory lives at
// whole steps. From step to step it is advanced with the velocities of the half step that moved the grains, in the geometry half-way, so
// that going back undoes it: without damping energy neither grows nor falls, in either integrator, and needs none of the least dashpot of
// T6. Dampers see how the ends slip at the instant or, where only velocities of half steps are known, what they slipped in the step.
//
// Source: "linear bond model" (Bond 1–14), corrected (docs/physics.md). Proven by tests/sim/bonds and tests/verification/bonds_test.cpp.

#include <cmath>

#include "sim/bonds/bonding.h"
#include "sim/laws/arithmetic.h"

namespace tsubu::sim {

/// B7–B10 as lengths: over k_n a stress is what the outermost fibre is stretched by, and the springs need not be asked for their forces.
struct BondLimits {
  double softness, softnessPerLength;  ///< m³/N, m²/N: 1/k_n is the first, or the second times the length that the bond was made with
  double tension, compression;         ///< Pa
  double shear;                        ///< Pa: τ_max k_n/k_t
  double pressureSlope;                ///< tan φ k_n/k_t
  double stretch;                      ///< r_max over the length
};

inline constexpr double bondPi = 3.141592653589793;

/// What all bonds of a kind have in common.
struct BondKind {
  double stiffness, modulus;  ///< N/m³ and Pa, times π: k_n is the first, or the second over the length that the bond was made with
  double shearOverNormal;     ///< k_t/k_n
  double eta[bondWays];       ///< B4: shares; B5: 1/s; B6: dashpots over critical ones, of BondBody
  BondStrength strength;
  BondLimits limits;
};

inline BondKind kindOf(const Bonding& bonding) {
  BondKind kind{};
  kind.stiffness = bonding.modulus > 0 ? 0 : bondPi * bonding.stiffness;
  kind.modulus = bondPi * bonding.modulus;
  kind.shearOverNormal = 1 / bonding.stiffnessRatio;
  for (int way = 0; way < bondWays; ++way) kind.eta[way] = bonding.dampingOf[static_cast<std::size_t>(way)];
  if (bonding.damping == BondDamping::viscous) {
    // Spheres that slip move 2/7 of their mass; k_t J = 2 (k_t/k_n) k_n I.
    kind.eta[across] *= std::sqrt(2.0 / 7.0 * kind.shearOverNormal);
    kind.eta[twisting] *= std::sqrt(2 * kind.shearOverNormal);
  }
  const BondStrength& strength = kind.strength = bonding.strength;
  kind.limits = {bonding.modulus > 0 ? 0 : 1 / bonding.stiffness,
                 bonding.modulus > 0 ? 1 / bonding.modulus : 0,
                 strength.tension,
                 strength.compression,
                 strength.shear * bonding.stiffnessRatio,
                 strength.pressureSlope * bonding.stiffnessRatio,
                 strength.stretch};
  return kind;
}

/// What is kept of a bond from step to step, in the directions of the world.
struct BondMemory {
  V3 shear{};       ///< s, m; at right angles to n
  V3 turn{};        ///< θ, rad: torsion along n, bending across
  double rest = 0;  ///< r_0, m
};

/// What does not change.
struct BondBody {
  double radius;        ///< r_b, m
  double length;        ///< m, when it was made
  double critical;      ///< B6: critical dashpot along the bond, 2 √(k_n A m*), kg/s
  double bendCritical;  ///< B6: of bending, 2 √(k_n I I*), N m s
};

/// How the two grains move against each other: i − j, and sums i + j of r ω.
struct BondMotion {
  V3 velocity;  ///< m/s
  V3 spinSum;   ///< r_i ω_i + r_j ω_j, m/s
  V3 spin;      ///< ω_i − ω_j, rad/s
};

struct BondForce {
  V3 force;     ///< on i
  V3 couple;    ///< Q = (l/R) n × F, the same at both ends: torques −R Q (grain_rows.h)
  V3 moment;    ///< on i
  double loss;  ///< J: what dampers take in the step
  bool holds;   ///< or breaks now
};

/// How far the springs are stretched.
struct BondStrain {
  double stretch;  ///< r_0 − r, m
  V3 shear;        ///< s, m
  double twist;    ///< along n, rad
  V3 bend;         ///< across it, rad
};
TSUBU_INLINE BondStrain strainOf(const BondMemory& memory, V3 n, double r) {
  const double twist = dot(memory.turn, n);
  return {memory.rest - r, memory.shear, twist, memory.turn - twist * n};
}

/// N/m and N m: k_n A, k_t A, k_t J, k_n I.
struct BondSprings {
  double along, across, twist, bend;
};
/// B1, of a circular section: A = π r_b², I = A r_b²/4, J = 2 I.
TSUBU_INLINE BondSprings springsOf(const BondKind& kind, const BondBody& body) {
  const double radius2 = body.radius * body.radius, along = (kind.stiffness + kind.modulus / body.length) * radius2;
  const double bend = 0.25 * radius2 * along, share = kind.shearOverNormal;
  return {along, share * along, 2 * share * bend, bend};
}

/// The energy of the springs when both states are the same; otherwise between the two: ½ Σ k a b.
TSUBU_INLINE double springProduct(const BondSprings& k, const BondStrain& a, const BondStrain& b) {
  return 0.5 * (k.along * (a.stretch * b.stretch) + k.across * dot(a.shear, b.shear) + k.twist * (a.twist * b.twist) +
                k.bend * dot(a.bend, b.bend));
}

/// What springs do: forces along and across the bond, moments about it and across it, on i.
struct BondPull {
  double along;
  V3 across;
  double twist;
  V3 bend;
};
/// B2.
TSUBU_INLINE BondPull pullOf(const BondSprings& k, const BondStrain& strain) {
  return {k.along * strain.stretch, -k.across * strain.shear, -k.twist * strain.twist, -k.bend * strain.bend};
}

/// B7–B10, for pictures: the largest of the stresses over their strengths and of r over r_max; at 1 a bond breaks. `bondHolds` decides,
/// without quotients; a test holds the two together. Stresses: along the bond (positive in compression), in the outermost fibre by bending,
/// across it with what torsion adds.
TSUBU_INLINE double bondLoad(const BondStrength& strength, const BondBody& body, const BondPull& pull, double r) {
  const double area = bondPi * body.radius * body.radius, section = 0.25 * area * body.radius;  // I/r_b, half of J/r_b
  const double axial = pull.along / area, fibre = norm(pull.bend) / section;
  const double shear = norm(pull.across) / area + 0.5 * std::abs(pull.twist) / section;
  const double resistance = strength.shear + strength.pressureSlope * larger(axial, 0);
  return larger(larger((fibre - axial) / strength.tension, (fibre + axial) / strength.compression),
                larger(shear / resistance, r / (body.length * strength.stretch)));
}
/// Is that less than 1? Without quotients and roots, which a loop over bonds would wait for: stresses over k_n, which of a circular section
/// (J = 2 I, I = A r_b²/4) leave lengths alone.
/// \param twist  θ·n
TSUBU_INLINE bool bondHolds(const BondLimits& limits, const BondBody& body, const BondMemory& memory, double twist, double r) {
  const double pressed = memory.rest - r, softness = limits.softness + limits.softnessPerLength * body.length;
  const double bendLeft = smaller(limits.tension * softness + pressed, limits.compression * softness - pressed);  // for r_b θ_t
  const double shearLeft = limits.shear * softness + limits.pressureSlope * larger(pressed, 0) - body.radius * std::abs(twist);  // for s
  // Not below zero where rounding is all that is left of it: of a limit that is below zero already, the square says nothing.
  const double bent2 = (body.radius * body.radius) * larger(norm2(memory.turn) - twist * twist, 0);
  const double over = larger(bent2 - bendLeft * larger(bendLeft, 0), norm2(memory.shear) - shearLeft * larger(shearLeft, 0));
  return larger(over, r - limits.stretch * body.length) < 0;
}

TSUBU_INLINE double lengthBefore(V3 d, V3 velocity, double dt) { return norm(d - dt * velocity); }

/// A rotation about g by twice the arc tangent of |g|. Cayley's form is orthogonal at any angle, without sine or cosine.
struct BondRotation {
  V3 g;
  double scale;  ///< 2/(1 + g²)
};
/// How a step has moved a bond.
struct BondPath {
  double r;               ///< m, now
  double perRadiusSum;    ///< 1/m
  V3 n;                   ///< now
  V3 sheared, turned;     ///< half of the way and of the angle by which the ends moved against each other: added to the springs at
                          ///< either end of the step
  BondRotation rotation;  ///< since the step before
};
/// B3, half-way: the bond follows its ends and turns about itself with the mean spin of the grains.
/// \param d       x_i − x_j now
/// \param motion  with which the grains have come there
TSUBU_INLINE BondPath pathOf(V3 d, double radiusSum, const BondMotion& motion, double dt) {
  const V3 way = (0.5 * dt) * motion.velocity, spin = (0.5 * dt) * motion.spinSum, middle = d - way;
  const double r = norm(d), middle2 = norm2(middle), unit = middle2 * radiusSum;
  // Everything over the sum of the radii, and g over that and |middle|²: one division, at the end, for all reciprocals.
  const V3 sheared = radiusSum * way + cross(middle, spin);
  // Of the mean spin, middle × sheared takes away what is across the bond and puts there how the bond itself turns.
  const V3 g = middle2 * spin + cross(middle, sheared);
  const double unit2 = unit * unit, both2 = unit2 + norm2(g), rUnit = r * unit;
  const double all = 1 / (rUnit * both2), perRUnit = all * both2, perUnit = perRUnit * r, perRadiusSum = perUnit * middle2;
  return {
      r, perRadiusSum, (perRUnit * unit) * d, perRadiusSum * sheared, (0.5 * dt) * motion.spin, {perUnit * g, 2 * (all * rUnit) * unit2}};
}

/// By how much v changes.
TSUBU_INLINE V3 changeBy(const BondRotation& rotation, V3 v) { return cross(rotation.scale * rotation.g, v + cross(rotation.g, v)); }

/// Takes from v what is along n. A step leaves that in the springs across, by less than it knows of them: they are kept where they belong.
TSUBU_INLINE V3 acrossOf(V3 v, V3 n) { return v - dot(v, n) * n; }

/// What a step adds to the springs, in the directions of its end. Half of it is added at its beginning, and turns with the bond.
TSUBU_INLINE BondStrain strainBy(const BondPath& path, double r0) {
  const V3 shear = acrossOf(2 * path.sheared + changeBy(path.rotation, path.sheared), path.n);
  return strainOf({shear, 2 * path.turned + changeBy(path.rotation, path.turned), r0}, path.n, path.r);
}

/// B5 in a step: what is left of a spring, and of what the step adds to it. (1 − ½ηΔt)/(1 + ½ηΔt) rather than 1 − ηΔt (Bond 11): second
/// order, and what `relaxedIn` says is lost is exact.
template <BondDamping damping>
struct BondRelaxation {
  double kept = 1, taken = 1;

  TSUBU_INLINE BondRelaxation(const BondKind& kind, BondWay way, double dt) {
    if constexpr (damping != BondDamping::exponential) return;
    const double half = 0.5 * kind.eta[way] * dt;
    kept = (1 - half) / (1 + half), taken = 1 / (1 + half);
  }
  TSUBU_INLINE double after(double before, double by) const { return kept * before + taken * by; }
  TSUBU_INLINE V3 after(V3 before, V3 by) const { return kept * before + taken * by; }
  /// From what is now, to second order: without relaxation it is exact.
  TSUBU_INLINE double before(double now, double by) const { return (2 - kept) * now - taken * by; }
  TSUBU_INLINE V3 before(V3 now, V3 by) const { return (2 - kept) * now - taken * by; }
};

/// B5: what relaxation has taken between two states, J.
TSUBU_INLINE double relaxedIn(const BondKind& kind, const BondSprings& k, const BondStrain& a, const BondStrain& b, double dt) {
  const double stretch = a.stretch + b.stretch, twist = a.twist + b.twist;
  return 0.25 * dt *
         (kind.eta[along] * k.along * (stretch * stretch) + kind.eta[across] * k.across * norm2(a.shear + b.shear) +
          kind.eta[twisting] * k.twist * (twist * twist) + kind.eta[bending] * k.bend * norm2(a.bend + b.bend));
}

/// \brief The springs at the end of a step, from those at its beginning.
/// \param r0  the length at its beginning; read by B5 only
/// \return what has relaxed, J
template <BondDamping damping>
TSUBU_INLINE double stretchBond(const BondKind& kind, const BondBody& body, const BondPath& path, double r0, double dt,
                                BondMemory& memory) {
  if constexpr (damping == BondDamping::exponential) {
    const BondMemory turned{memory.shear + changeBy(path.rotation, memory.shear), memory.turn + changeBy(path.rotation, memory.turn),
                            memory.rest};
    const BondStrain before = strainOf(turned, path.n, r0), by = strainBy(path, r0);
    const BondStrain now{BondRelaxation<damping>(kind, along, dt).after(before.stretch, by.stretch),
                         acrossOf(BondRelaxation<damping>(kind, across, dt).after(before.shear, by.shear), path.n),
                         BondRelaxation<damping>(kind, twisting, dt).after(before.twist, by.twist),
                         BondRelaxation<damping>(kind, bending, dt).after(before.bend, by.bend)};
    memory = {now.shear, now.bend + now.twist * path.n, now.stretch + path.r};
    return relaxedIn(kind, springsOf(kind, body), before, now, dt);
  } else {
    // The same with one rotation for what was there and what is added.
    const V3 shear = memory.shear + path.sheared, turn = memory.turn + path.turned;
    memory.shear = acrossOf(shear + changeBy(path.rotation, shear) + path.sheared, path.n);
    memory.turn = turn + changeBy(path.rotation, turn) + path.turned;
    return 0;
  }
}

/// The springs at the beginning of the step, in the directions of its end, from those at its end.
template <BondDamping damping>
TSUBU_INLINE BondStrain strainBefore(const BondKind& kind, const BondStrain& now, const BondStrain& by, double dt) {
  return {BondRelaxation<damping>(kind, along, dt).before(now.stretch, by.stretch),
          BondRelaxation<damping>(kind, across, dt).before(now.shear, by.shear),
          BondRelaxation<damping>(kind, twisting, dt).before(now.twist, by.twist),
          BondRelaxation<damping>(kind, bending, dt).before(now.bend, by.bend)};
}

/// The force `force + moreAlong n` and the moment `moment + moreTwist n`: to scale a vector and set right with one number what lies along n
/// costs less than to take it apart.
struct BondWrench {
  double moreAlong;
  V3 force;
  double moreTwist;
  V3 moment;
};
TSUBU_INLINE BondWrench operator-(const BondWrench& a, const BondWrench& b) {
  return {a.moreAlong - b.moreAlong, a.force - b.force, a.moreTwist - b.moreTwist, a.moment - b.moment};
}

/// B2.
/// \param twist  θ·n
TSUBU_INLINE BondWrench wrenchOf(const BondSprings& k, const BondMemory& memory, double twist, double r) {
  return {k.along * (memory.rest - r), -k.across * memory.shear, (k.bend - k.twist) * twist, -k.bend * memory.turn};
}

/// How the ends move against each other in half a step: the way where they meet (T0), the angle, and what of each is along n.
struct BondSlip {
  V3 way;
  double along;
  V3 turn;
  double twist;
};
TSUBU_INLINE BondSlip slipOf(V3 way, V3 turn, V3 n) { return {way, dot(way, n), turn, dot(turn, n)}; }
/// Where the velocities of the instant are not those that have moved the grains.
TSUBU_INLINE BondSlip slipOf(const BondPath& path, const BondMotion& now, double dt) {
  const V3 lever = (path.r * path.perRadiusSum) * path.n;
  return slipOf((0.5 * dt) * (now.velocity + cross(lever, now.spinSum)), (0.5 * dt) * now.spin, path.n);
}

/// B4: the force of a spring over the way against which a share of it acts. What is but the rounding of the whole way is no way.
TSUBU_INLINE double forceOverWay(double force2, double way2, double whole2) {
  return std::sqrt(force2 / larger(way2, larger(1e-24 * whole2, tiny)));
}

/// B4, B6: what dampers hold back.
template <BondDamping damping>
TSUBU_INLINE BondWrench heldBack(const BondKind& kind, const BondBody& body, const BondStrain& strain, const BondSlip& slip, V3 n,
                                 double dt) {
  const double* const eta = kind.eta;
  if constexpr (damping == BondDamping::viscous) {
    // The dashpot across acts on the whole velocity, that of bending on the whole spin.
    const double rate = 2 / dt;
    return {rate * (eta[along] - eta[across]) * body.critical * slip.along, (rate * eta[across] * body.critical) * slip.way,
            rate * (eta[twisting] - eta[bending]) * body.bendCritical * slip.twist, (rate * eta[bending] * body.bendCritical) * slip.turn};
  } else {
    const BondPull pull = pullOf(springsOf(kind, body), strain);
    const V3 slid = slip.way - slip.along * n, bent = slip.turn - slip.twist * n;
    const double way2 = norm2(slip.way), turn2 = norm2(slip.turn);
    return {eta[along] * forceOverWay(pull.along * pull.along, slip.along * slip.along, way2) * slip.along,
            (eta[across] * forceOverWay(norm2(pull.across), norm2(slid), way2)) * slid,
            eta[twisting] * forceOverWay(pull.twist * pull.twist, slip.twist * slip.twist, turn2) * slip.twist,
            (eta[bending] * forceOverWay(norm2(pull.bend), norm2(bent), turn2)) * bent};
  }
}

/// \brief What a bond does, with its springs as they are now.
/// \param slip  at the instant; read by dampers only
template <BondDamping damping, bool breakable>
TSUBU_INLINE BondForce pullBond(const BondKind& kind, const BondBody& body, const BondMemory& memory, const BondPath& path,
                                const BondSlip& slip, double dt) {
  const V3 n = path.n, lever = (path.r * path.perRadiusSum) * n;
  const double twist = dot(memory.turn, n);
  BondWrench wrench = wrenchOf(springsOf(kind, body), memory, twist, path.r);
  BondForce result{};
  result.holds = true;
  if constexpr (breakable) result.holds = bondHolds(kind.limits, body, memory, twist, path.r);
  if constexpr (damping == BondDamping::percent || damping == BondDamping::viscous) {
    const BondWrench held = heldBack<damping>(kind, body, strainOf(memory, n, path.r), slip, n, dt);
    result.loss = 2 * (held.moreAlong * slip.along + dot(held.force, slip.way) + held.moreTwist * slip.twist + dot(held.moment, slip.turn));
    wrench = wrench - held;
  }
  result.force = wrench.moreAlong * n + wrench.force;
  result.couple = cross(lever, wrench.force);
  result.moment = wrench.moreTwist * n + wrench.moment;
  return result;
}

}  // namespace tsubu::sim
