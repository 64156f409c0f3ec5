#pragma once
// Coulomb friction with a tangential spring that remembers.
//
//   T1   F_t = −k_t δ_t − η_t v_t
//   T2   |F_t| ≤ μ |F_n|; beyond it spring and dashpot are cut back by the same factor, so that together they are the limit
//   T3   δ_t is carried with the contact: turned with n and with a mean spin about n, kept tangential at unchanged length
//   T4   η_t = f η_n √(k_t/k_n): with f = √(2/7) the damping ratio of the normal contact, for a mass of 2/7 m* (a sphere turns as it
//        slips); or η_t = m* γ_t from a rate
//
//   k_t  tangential stiffness, N/m (2/7 k_n when absent and k_n is a constant)      v_t  slip velocity, m/s
//   μ    friction coefficient                                                       δ_t  tangential displacement, m
//
// The memory is k_t δ_t in N. It is advanced with the slip of a whole step and read at `lead` of a step, so that in velocity Verlet
// the spring's work over a step is exactly the change of its energy: a sticking contact leaks nothing (docs/physics.md, T5). In
// symplectic Euler the account takes the spring's mean force over the step, for the same reason.
//   T6   η_t ≥ k_t (7/2 k_t/m*) Δt³ in velocity Verlet (contact.h, quieting): matters for nearly elastic contacts alone
//
// Cutting back is passive: what the spring loses beyond its work is friction, and never less than nothing. Luding (Granular Matter 10
// (2008) 235) keeps the dashpot whole and gives the spring the rest, limit − η_t v_t; where the dashpot alone exceeds the limit, that
// charges a spring that pushes along the slip, with energy that nobody spent. Steady sliding below it ends in the same state.
//
// Six laws share the formula: `spring` (k_t a constant), `frozen_spring` (the spring is not cut back but stays as it is while the
// contact slides: where the load falls, a spring that pushes the grain along gives energy and keeps it), `luding_spring` (Luding's way),
// `mindlin` (k_t follows the overlap), and two that do what LIGGGHTS does, to compare with it: `limited_spring`, `mindlin_displacement`.
//   T13  luding_spring, at the limit:  k_t δ_t = −F_t − η_t v_t,  |F_t| = μ |F_n|
//   T14  limited_spring:  k_t |δ_t| ≤ μ |F_n|; the dashpot is added while δ_t is below it (beyond the limit then), and gone while it slides
//   T15  mindlin_displacement:  T14, and when k_t changes it is δ_t that stays: the force rises with the load, with energy nobody spent
//   T7   k_t = 8 G* √(R* δ) = (4 G*/E*) S,   1/G* = (2−ν_i)/G_i + (2−ν_j)/G_j,   G = E/(2(1+ν))
//   T8   what becomes of a stretched spring whose stiffness changes: memory.h
//
// Source: Cundall & Strack 1979; luding_spring after Luding; Mindlin 1949, with the rescaling of Thornton,
// Cummins & Cleary, Powder Technology 210 (2011) 189. Proven by tests/sim/laws/spring_friction_test.cpp.

#include "sim/laws/hertz_normal.h"
#include "sim/laws/tangential.h"

namespace tsubu::sim {

/// followsNormal: what stays when it changes is T8. scalesForce: it is the displacement.
enum class SpringStiffness { constant, followsNormal, scalesForce };
enum class SlidingSpring { cutBack, frozen, getsTheRest, limitedAlone };

template <SpringStiffness kind, SlidingSpring sliding>
struct SpringLaw {
  static constexpr bool follows = kind != SpringStiffness::constant;
  static constexpr bool limitsTheSpring = sliding == SlidingSpring::limitedAlone;
  static constexpr bool acts = true, needsGrowing = follows, withinLimit = !limitsTheSpring;
  static constexpr bool passive = kind != SpringStiffness::scalesForce && (sliding == SlidingSpring::cutBack || limitsTheSpring);
  template <bool, class Real>
  using MemoryIn = std::conditional_t<follows, GrowingVectorMemoryIn<Real>, VectorMemoryIn<Real>>;

  template <class Real>
  struct PairIn {
    Real stiffness;       // k_t, or k_t/k_n where it follows
    Real half;            // 1/(2 k_t), or 0 without a spring
    Real friction;        // μ
    Real damping;         // η_t √k_n/η_n, or η_t/η_n where it follows
    Real dampingPerMass;  // η_t/m*
    Real rescales;        // T8: 1, or 0 for the demonstration of what goes wrong
  };
  using Pair = PairIn<double>;

  static Pair prepare(const PairValues& values, double normalStiffness, bool rescales) {
    Pair p{};
    if constexpr (follows)
      p.stiffness = 4 * effectiveShear(values) / effectiveModulus(values);
    else
      p.stiffness = values.pair.valueOr(Property::tangentialStiffness, 2.0 / 7.0 * normalStiffness);
    p.half = p.stiffness > 0 ? 0.5 / p.stiffness : 0;
    p.friction = values[Property::friction];
    if (values.has(Property::tangentialDampingRate))
      p.dampingPerMass = values[Property::tangentialDampingRate];
    else
      p.damping = values.pair.valueOr(Property::tangentialDampingFactor, std::sqrt(2.0 / 7.0)) * std::sqrt(p.stiffness);
    p.rescales = rescales ? 1 : 0;
    return p;
  }

  /// A sphere's rotation makes 7/2 of a tangential spring: 1/m + r²/I.
  static ContactMode mode(const Pair& p, double normalStiffness, double normalDamping, double inverseMass) {
    const double k = follows ? p.stiffness * normalStiffness : p.stiffness;
    const double damping = follows ? p.damping * normalDamping : p.damping * normalDamping / std::sqrt(normalStiffness);
    return {3.5 * k * inverseMass, 3.5 * (damping * inverseMass + p.dampingPerMass)};
  }

  /// Energy that a memory holds, J.
  template <class Real, class M>
  TSUBU_LAW Real stored(const PairIn<Real>& p, const M& memory) {
    if constexpr (follows)
      return Real(0.5) * norm2(memory.spring) / larger(memory.stiffness, tinyIn<Real>);
    else
      return p.half * norm2(memory.spring);
  }

  template <class Real, class M>
  TSUBU_LAW TangentialForceIn<Real> force(const PairIn<Real>& p, const ContactIn<Real>& c, const NormalForceIn<Real>& normal,
                                          StepIn<Real> step, M& memory) {
    Real k = p.stiffness, own = p.dampingPerMass * c.effectiveMass, half = p.half, storedBefore = 0, ease = 1;
    if constexpr (follows) {
      k = p.stiffness * normal.stiffness;
      own += p.damping * normal.damping;
      half = Real(0.5) / larger(k, tinyIn<Real>);
      const Eased<Real> e = eased(memory, k, p.rescales);
      ease = kind == SpringStiffness::scalesForce ? k / larger(memory.stiffness, tinyIn<Real>) : e.factor;
      storedBefore = e.before;
    } else {
      own += p.damping * normal.dampingPerRootStiffness;
    }
    const Real damping = larger(own, k * quieting(Real(3.5) * k * c.inverseEffectiveMass, step));
    const V3In<Real> before = ease * memory.spring;
    if constexpr (!follows) storedBefore = half * norm2(before);
    const V3In<Real> gain = (k * step.dt) * c.slip;
    const V3In<Real> trial = limitsTheSpring ? before + step.lead * gain : before + step.lead * gain + damping * c.slip;
    const Real limit = p.friction * std::abs(normal.force), size2 = norm2(trial);
    const bool slides = size2 > limit * limit;
    const Real keep = slides ? shareOf(limit, size2) : Real(1);
    const Real drag = limitsTheSpring ? (slides ? 0 : damping) : keep * damping;
    const V3In<Real> force = limitsTheSpring ? -keep * trial - drag * c.slip : -keep * trial;
    if constexpr (sliding == SlidingSpring::getsTheRest) {
      const V3In<Real> spring = -force - damping * c.slip;  // at the instant of the force
      memory.spring = spring + (1 - step.lead) * gain;
      setStiffness(memory, k);
      const Real storedAfter = half * norm2(memory.spring), work = dot(spring + (step.mean - step.lead) * gain, c.slip) * step.dt;
      return {force, storedBefore, storedAfter, damping * norm2(c.slip) * step.dt, work - (storedAfter - storedBefore)};
    }
    if constexpr (sliding == SlidingSpring::frozen)
      memory.spring = select(slides, before, before + gain);
    else
      memory.spring = keep * (before + gain);
    setStiffness(memory, k);
    const Real storedAfter = half * norm2(memory.spring);
    const Real springWork = keep * dot(before + step.mean * gain, c.slip) * step.dt;
    return {force, storedBefore, storedAfter, drag * norm2(c.slip) * step.dt, springWork - (storedAfter - storedBefore)};
  }

 private:
  static double effectiveShear(const PairValues& values) {
    const auto compliance = [](double young, double poisson) { return (2 - poisson) * 2 * (1 + poisson) / young; };
    return 1 / (compliance(values.first[Property::youngModulus], values.first[Property::poissonRatio]) +
                compliance(values.second[Property::youngModulus], values.second[Property::poissonRatio]));
  }
};

struct SpringFriction : SpringLaw<SpringStiffness::constant, SlidingSpring::cutBack> {
  static constexpr std::string_view name = "spring";
  static constexpr std::string_view sentence = "Coulomb friction with a spring that remembers (T1–T4): grains stick, then slide.";
  static constexpr std::array reads{need(Property::friction), mayRead(Property::tangentialStiffness),
                                    mayReadEither(Property::tangentialDampingRate, Property::tangentialDampingFactor)};
  static constexpr bool common = true;
};

struct FrozenSpringFriction : SpringLaw<SpringStiffness::constant, SlidingSpring::frozen> {
  static constexpr std::string_view name = "frozen_spring";
  static constexpr std::string_view sentence =
      "The same, but the spring stays as it was while the contact slides: it jumps when sliding turns (for comparison).";
  static constexpr std::array reads = SpringFriction::reads;
  static constexpr bool common = false;
};

struct LudingSpringFriction : SpringLaw<SpringStiffness::constant, SlidingSpring::getsTheRest> {
  static constexpr std::string_view name = "luding_spring";
  static constexpr std::string_view sentence =
      "The same, but while the contact slides the dashpot stays whole and the spring gets the rest (T13): Luding's way, and that of "
      "LAMMPS.";
  static constexpr std::array reads = SpringFriction::reads;
  static constexpr bool common = false;
};

struct LimitedSpringFriction : SpringLaw<SpringStiffness::constant, SlidingSpring::limitedAlone> {
  static constexpr std::string_view name = "limited_spring";
  static constexpr std::string_view sentence =
      "The same, but only the spring is held to the limit, and the dashpot acts while it sticks (T14): that of LIGGGHTS, for comparison.";
  static constexpr std::array reads = SpringFriction::reads;
  static constexpr bool common = false;
};

struct MindlinFriction : SpringLaw<SpringStiffness::followsNormal, SlidingSpring::cutBack> {
  static constexpr std::string_view name = "mindlin";
  static constexpr std::string_view sentence =
      "Coulomb friction with Mindlin's spring, whose stiffness follows the overlap (T7, T8); for hertz.";
  static constexpr std::array reads{need(Property::friction), need(Property::youngModulus), need(Property::poissonRatio),
                                    mayReadEither(Property::tangentialDampingRate, Property::tangentialDampingFactor)};
  static constexpr bool common = true;
};

struct MindlinDisplacementFriction : SpringLaw<SpringStiffness::scalesForce, SlidingSpring::limitedAlone> {
  static constexpr std::string_view name = "mindlin_displacement";
  static constexpr std::string_view sentence =
      "Mindlin's spring that keeps its displacement when the stiffness changes, which can make energy; slides as limited_spring (T15): "
      "that of LIGGGHTS.";
  static constexpr std::array reads = MindlinFriction::reads;
  static constexpr bool common = false;
};

}  // namespace tsubu::sim
