#pragma once
// The loops over contacts: gather, compute, scatter; how rows become columns and back is in columns.h. Included by one translation unit per
// instruction set; everything here has internal linkage or is inlined, so that no instruction of a wide set leaks into code that every
// processor runs.

#include <algorithm>

#include "sim/kernel/columns.h"
#include "sim/kernel/kernels.h"
#include "sim/laws/catalogue.h"

namespace tsubu::sim {
namespace {

/// The least distance that is divided by. More in single precision: there the reciprocal is that of a product with radii and masses, which
/// must not underflow.
template <class Real>
constexpr Real leastDivisor = single<Real> ? Real(1e-12) : tinyIn<Real>;

/// Directions, overlaps and effective masses, over what they are made of. A loop of its own: with the law behind it in one loop the
/// chain of dependent operations is longer than what a processor looks ahead, and it waits for each contact.
template <class Shape, class Real>
void findDirections(int count, StageIn<Real>& s) {
  TSUBU_INDEPENDENT
  for (int q = 0; q < count; ++q) {
    const V3In<Real> d{s.dx[q], s.dy[q], s.dz[q]};
    const Real distance = norm(d), safeDistance = larger(distance, leastDivisor<Real>);
    // One division for all reciprocals: divisions and roots are what this loop waits for. Only arms want that of the sum of the radii.
    const Real sum = Shape::turns ? s.radiusSum[q] : 1, mass = s.inverseMassSum[q];
    Real reciprocal = 1;
    if constexpr (Shape::readsRadius) {
      const Real all = 1 / (safeDistance * sum * mass * s.inverseRadiusSum[q]);
      reciprocal = all * s.inverseRadiusSum[q];
      s.effectiveRadius[q] = all * (safeDistance * sum * mass);
    } else {
      reciprocal = 1 / (safeDistance * sum * mass);
    }
    const Real perDistance = reciprocal * sum * mass;
    s.effectiveMass[q] = reciprocal * safeDistance * sum;
    if constexpr (single<Real>)
      s.overlap[q] = s.gap[q] / (s.radiusSum[q] + distance);
    else
      s.overlap[q] = s.radiusSum[q] - distance;
    if constexpr (Shape::turns) {
      const Real perRadiusSum = reciprocal * safeDistance * mass;
      s.perRadiusSum[q] = perRadiusSum;
      s.arm[q] = distance * perRadiusSum;
      s.dx[q] = perDistance * d.x, s.dy[q] = perDistance * d.y, s.dz[q] = perDistance * d.z;
    } else {
      s.perDistance[q] = perDistance;
    }
  }
}

/// The direction of a contact. Where only the loop of the law asks for it, it is made there.
template <class Shape, class Real>
TSUBU_INLINE V3In<Real> directionAt(const StageIn<Real>& s, int q) {
  const V3In<Real> d{s.dx[q], s.dy[q], s.dz[q]};
  if constexpr (Shape::turns)
    return d;
  else
    return s.perDistance[q] * d;
}

/// Velocities along the normal and across it, over the relative velocities: for laws with friction.
template <bool ofWalls, class Real>
void findSlip(int count, StageIn<Real>& s) {
  TSUBU_INDEPENDENT
  for (int q = 0; q < count; ++q) {
    const V3In<Real> n{s.dx[q], s.dy[q], s.dz[q]}, dv{s.dvx[q], s.dvy[q], s.dvz[q]};
    const Real separationSpeed = dot(dv, n);
    s.separationSpeed[q] = separationSpeed;
    const V3In<Real> spin{s.sx[q], s.sy[q], s.sz[q]};
    const V3In<Real> slip = dv - separationSpeed * n - s.arm[q] * cross(spin, n);
    s.dvx[q] = slip.x, s.dvy[q] = slip.y, s.dvz[q] = slip.z;
    // Any mean turns with the pair: between grains the one weighted by the radii, which comes for nothing with the sum of r ω.
    const V3In<Real> frameSpin = ofWalls ? V3In<Real>{s.ox[q], s.oy[q], s.oz[q]} : s.perRadiusSum[q] * spin;
    s.frameSpin[q] = dot(frameSpin, n);
  }
}

/// √m* for the laws that read it. A loop of its own: roots that nothing waits for.
template <class Real>
void findRootMass(int count, StageIn<Real>& s) {
  TSUBU_INDEPENDENT
  for (int q = 0; q < count; ++q) s.rootMass[q] = std::sqrt(s.effectiveMass[q]);
}

/// Carries the memory along (T3).
template <class Law, class Real>
void carryMemory(Real turning, int count, StageIn<Real>& s, Real* const (&columns)[mostMemory]) {
  TSUBU_INDEPENDENT
  for (int q = 0; q < count; ++q) {
    typename Law::template MemoryIn<Real> held = memoryFromColumns<Law>(columns, q);
    Law::carry(V3In<Real>{s.dx[q], s.dy[q], s.dz[q]}, turning * s.frameSpin[q], held);
    memoryToColumns<Law>(held, true, columns, q);
  }
}

/// A contact of the stage, as a law sees it.
template <class Law, class Real>
TSUBU_INLINE ContactIn<Real> contactAt(const StageIn<Real>& s, int q) {
  ContactIn<Real> c;
  c.n = directionAt<ShapeOf<Law>>(s, q);
  c.overlap = s.overlap[q];
  c.separationSpeed = Law::turns ? s.separationSpeed[q] : dot(V3In<Real>{s.dvx[q], s.dvy[q], s.dvz[q]}, c.n);
  c.effectiveMass = s.effectiveMass[q];
  c.inverseEffectiveMass = s.inverseMassSum[q];
  c.rootMass = s.rootMass[q];
  c.frameAngle = 0;
  if constexpr (Law::readsRadius) c.effectiveRadius = s.effectiveRadius[q];
  if constexpr (Law::turns) c.slip = {s.dvx[q], s.dvy[q], s.dvz[q]};
  if constexpr (Law::rolls) {
    c.relativeSpin = {s.rx[q], s.ry[q], s.rz[q]};
    c.inverseSpinInertia = Real(2.5) * s.inverseInertiaSum[q];
  }
  return c;
}

/// What springs store at the instant of the forces. Only rows of the ledger ask for it: the law is evaluated for them once more, before it
/// advances the memory, and nothing else is kept.
template <class Law, bool oneClass, bool ofWalls, class Real>
void observe(const typename Law::template PairIn<Real>& known, StepIn<Real> step, int count, StageIn<Real>& s,
             Real* const (&columns)[mostMemory]) {
  const typename Law::template PairIn<Real> only = known;
  TSUBU_INDEPENDENT
  for (int q = 0; q < count; ++q) {
    const ContactIn<Real> c = contactAt<Law>(s, q);
    const bool touching = c.overlap > 0;
    typename Law::template MemoryIn<Real> held = memoryFromColumns<Law>(columns, q);
    ContactEnergyIn<Real> energy{};
    const typename Law::template PairIn<Real> pair = oneClass ? only : pairFromColumns<Law>(s.constants, q);
    Law::template evaluate<true>(pair, c, step, held, energy);
    const Real share = ofWalls ? s.weight[q] : 1;
    s.account[Accounts::storedNormal][q] = touching ? share * energy.storedNormal : 0;
    s.account[Accounts::storedTangential][q] = touching ? share * energy.storedTangential : 0;
    s.account[Accounts::storedRolling][q] = touching ? share * energy.storedRolling : 0;
  }
}

/// Asks for the rows of the next chunk's partners; those of the first grains come in order, and the processor sees it. A share at a time,
/// between the loops over a chunk: asked for all at once, they would be more than a processor can wait for while it goes on.
struct Ahead {
  static constexpr int shares = 6;

  const PassContext& context;
  const std::int32_t* next = nullptr;
  const std::int32_t* end = nullptr;

  template <class Real>
  TSUBU_INLINE void ask() {
    if (next == end) return;
    const std::int32_t* const until = end - next > share ? next + share : end;
    for (; next != until; ++next) {
      if constexpr (single<Real>) {
        __builtin_prefetch(&context.single[*next], 0, 2);
        __builtin_prefetch(&context.singleForces[*next], 1, 2);
      } else {
        const auto* const row = reinterpret_cast<const char*>(&context.rows[*next]);
        __builtin_prefetch(row, 0, 2);
        __builtin_prefetch(row + sizeof(GrainRow) - 1, 0, 2);
        __builtin_prefetch(&context.forces[*next], 1, 2);
      }
    }
  }

 private:
  static constexpr int share = (chunkSize + shares - 1) / shares;
};

/// The law on every contact of the chunk. `memory` points to the columns of the contacts' memory; `asBefore`: the constants of the stage
/// are those of these contacts already.
template <class Law, bool oneClass, bool accounts, bool ofWalls, class Real>
void compute(const PassContext& context, int count, StageIn<Real>& s, Real* const* memory, bool asBefore, Ahead& ahead) {
  typename Law::template PairIn<Real> only{};
  if constexpr (oneClass)
    only = onlyPair<Law, Real>(context.pairs);
  else if (!asBefore)
    gatherConstants<numbersIn<typename Law::Pair>>(context, count, s);
  ahead.ask<Real>();
  findDirections<ShapeOf<Law>>(count, s);
  ahead.ask<Real>();
  if constexpr (Law::turns) findSlip<ofWalls>(count, s);
  ahead.ask<Real>();
  if (!oneClass || Law::Normal::readsRootMass(only.normal))
    findRootMass(count, s);
  else
    std::fill_n(s.rootMass, count, Real(0));
  const StepIn<Real> step = stepIn<Real>(context.step);
  Real* columns[mostMemory];
  for (int k = 0; k < mostMemory; ++k) columns[k] = k < Law::stateSize ? memory[k] : nullptr;
  if constexpr (Law::stateSize > 0) carryMemory<Law>(step.turning, count, s, columns);
  if constexpr (accounts)
    if (context.observed) observe<Law, oneClass, ofWalls>(only, step, count, s, columns);
  ahead.ask<Real>();
  TSUBU_INDEPENDENT
  for (int q = 0; q < count; ++q) {
    const ContactIn<Real> c = contactAt<Law>(s, q);
    const bool touching = c.overlap > 0;
    typename Law::template MemoryIn<Real> held = memoryFromColumns<Law>(columns, q);
    const typename Law::template MemoryIn<Real> before = held;
    ContactEnergyIn<Real> energy{};
    const typename Law::template PairIn<Real> pair = oneClass ? only : pairFromColumns<Law>(s.constants, q);
    const ContactForceIn<Real> result = Law::template evaluate<accounts>(pair, c, step, held, energy);
    const Real share = ofWalls ? s.weight[q] : 1;
    s.fx[q] = touching ? share * result.force.x : 0;
    s.fy[q] = touching ? share * result.force.y : 0;
    s.fz[q] = touching ? share * result.force.z : 0;
    if constexpr (Law::turns) {
      s.qx[q] = touching ? share * (s.arm[q] * result.couple.x) : 0;
      s.qy[q] = touching ? share * (s.arm[q] * result.couple.y) : 0;
      s.qz[q] = touching ? share * (s.arm[q] * result.couple.z) : 0;
    }
    if constexpr (Law::rolls) {
      s.mx[q] = touching ? share * result.moment.x : 0;
      s.my[q] = touching ? share * result.moment.y : 0;
      s.mz[q] = touching ? share * result.moment.z : 0;
    }
    memoryToColumns<Law>(held, touching, columns, q);
    if constexpr (accounts) {
      // What a spring still holds when its contact ends is let go: friction and rolling resistance keep it.
      s.account[Accounts::normal][q] = touching ? share * energy.normal : 0;
      if constexpr (Law::turns) {
        s.account[Accounts::tangential][q] = touching ? share * energy.tangential : 0;
        s.account[Accounts::friction][q] = share * (touching ? energy.friction : Law::storedTangential(pair, before));
      }
      if constexpr (Law::rolls) {
        Real released = 0;
        if constexpr (Law::stateSize > Law::tangentialSize)
          released = Law::storedRolling(pair, c, Law::Normal::force(pair.normal, c, step).stiffness, before);
        s.account[Accounts::rolling][q] = share * (touching ? energy.rolling : released);
      }
    }
  }
}

/// Which kinds of accounts a law fills in.
template <class Shape>
constexpr bool books(Accounts::Kind kind) {
  return kind == Accounts::rolling ? Shape::rolls : kind == Accounts::tangential || kind == Accounts::friction ? Shape::turns : true;
}

template <class Shape, class Real>
void addAccounts(int count, const StageIn<Real>& s, bool observed, Accounts& accounts) {
  const int whole = count & ~7;
  for (int kind = observed ? 0 : Accounts::normal; kind < Accounts::overlap; ++kind) {
    if (!books<Shape>(static_cast<Accounts::Kind>(kind))) continue;
    const Real* const column = s.account[kind];
    double* const lane = accounts.lane[kind];
    for (int q = 0; q < whole; q += 8)
      for (int l = 0; l < 8; ++l) lane[l] += column[q + l];
    for (int q = whole; q < count; ++q) lane[q - whole] += column[q];
  }
}

/// Adds how deep contacts are, over the smaller radius.
template <class Real>
void addDeepest(int count, const StageIn<Real>& s, Accounts& accounts) {
  double* const deepest = accounts.lane[Accounts::overlap];
  for (int q = 0; q < count; ++q) deepest[q & 7] = larger(deepest[q & 7], s.overlap[q] / s.smallerRadius[q]);
}

/// Pairs that touch at another distance than the sum of their radii: the sum is changed, and with it what the loop divides by it. The
/// arms stay those of the grains: the spins go in scaled, and `restoreArms` scales the couple that comes out.
template <class Shape, class Real>
void touchSooner(const double* touch, int count, StageIn<Real>& s) {
  for (int q = 0; q < count; ++q) {
    if (touch[q] == 0) continue;
    const Real sum = static_cast<Real>(touch[q]), scale = sum / s.radiusSum[q];
    s.armScale[q] = scale;
    if constexpr (single<Real>) s.gap[q] += (sum - s.radiusSum[q]) * (sum + s.radiusSum[q]);
    s.radiusSum[q] = sum;
    if constexpr (Shape::turns) s.sx[q] *= scale, s.sy[q] *= scale, s.sz[q] *= scale;
  }
}

template <class Shape, class Real>
void restoreArms(const double* touch, int count, StageIn<Real>& s) {
  if constexpr (Shape::turns) {
    for (int q = 0; q < count; ++q)
      if (touch[q] != 0) s.qx[q] *= s.armScale[q], s.qy[q] *= s.armScale[q], s.qz[q] *= s.armScale[q];
  }
}

template <class Law, bool oneClass, bool accounts, class Real>
void passPairs(const PassContext& context, const PairRangeIn<Real>& range, StageIn<Real>& stage, Accounts& sums) {
  for (std::int64_t first = 0; first < range.count; first += chunkSize) {
    const std::int64_t left = range.count - first;
    const int count = static_cast<int>(left < chunkSize ? left : chunkSize);
    Ahead ahead{context};
    if (context.prefetch) {
      ahead.next = range.j + first + count;
      ahead.end = ahead.next + (left - count < chunkSize ? left - count : chunkSize);
    }
    ahead.ask<Real>();
    Real* memory[mostMemory] = {};
    for (int c = 0; c < Law::stateSize; ++c) memory[c] = range.memory + first + static_cast<std::size_t>(c) * range.stride;
    gather<ShapeOf<Law>, oneClass>(context, range.i + first, range.j + first, count, stage);
    if (range.touch) touchSooner<ShapeOf<Law>>(range.touch + first, count, stage);
    compute<Law, oneClass, accounts, false>(context, count, stage, memory, first > 0 && context.materials == 1, ahead);
    ahead.ask<Real>();
    if (range.touch) restoreArms<ShapeOf<Law>>(range.touch + first, count, stage);
    if constexpr (accounts) addAccounts<ShapeOf<Law>>(count, stage, context.observed, sums);
    if (context.observed) addDeepest(count, stage, sums);
    scatter<ShapeOf<Law>>(context, range.i + first, range.j + first, count, stage);
  }
}

template <class Law, bool oneClass, bool accounts>
void passWalls(const PassContext& context, const WallRange& range, Stage& stage, Accounts& sums) {
  const int count = range.count;
  gatherWalls<ShapeOf<Law>>(context, range, stage);
  fetchWallMemory<Law::stateSize>(range, stage);
  double* memory[mostMemory];
  for (int c = 0; c < mostMemory; ++c) memory[c] = stage.memory[c];
  Ahead nobody{context};
  compute<Law, oneClass, accounts, true>(context, count, stage, memory, false, nobody);
  returnWallMemory<Law::stateSize>(range, stage);
  if constexpr (accounts) addAccounts<ShapeOf<Law>>(count, stage, context.observed, sums);
  if (context.observed) addDeepest(count, stage, sums);
  scatterWalls<ShapeOf<Law>>(context, range, stage);
}

/// A loop for each law that has one: filled in by `Loop`, for each choice of classes and accounts.
template <class Kernel, class Loop>
Kernel loopFor(std::size_t law, PassKind kind, Loop) {
  const auto table = []<bool oneClass, bool accounts>() {
    return tableOf(ContactLaws{}, []<class Law>() -> Kernel { return Loop::template of<Law, oneClass, accounts>(); });
  };
  static const auto oneWith = table.template operator()<true, true>(), oneWithout = table.template operator()<true, false>();
  static const auto moreWith = table.template operator()<false, true>(), moreWithout = table.template operator()<false, false>();
  if (kind.oneClass) return kind.accounts ? oneWith[law] : oneWithout[law];
  return kind.accounts ? moreWith[law] : moreWithout[law];
}

/// Common laws have a loop for each choice, to carry nothing that a scene does not ask for. The others have the one that serves every
/// scene: that for several classes, with accounts.
template <class Law, bool oneClass, bool accounts>
inline constexpr bool hasLoop = objection<Law>.empty() && (Law::common || (!oneClass && accounts));

}  // namespace
}  // namespace tsubu::sim
