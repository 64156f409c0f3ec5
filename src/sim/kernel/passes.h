#pragma once
// The loops over contacts: gather, compute, scatter. Included by one translation unit per instruction set; everything here has
// internal linkage or is inlined, so that no instruction of a wide set leaks into code that every processor runs.

#include "sim/kernel/kernels.h"
#include "sim/kernel/lanes.h"
#include "sim/laws/catalogue.h"

// The contacts of a chunk do not depend on each other: the compiler need not check. (Not `omp simd`: GCC would give every lane its
// own copy of the small structs of a law and then fail to vectorise them.)
#if defined(__clang__)
#define TSUBU_INDEPENDENT _Pragma("clang loop vectorize(assume_safety)")
#else
#define TSUBU_INDEPENDENT _Pragma("GCC ivdep")
#endif

namespace tsubu::sim {
namespace {

/// ω and 1/(m r²) of a grain, from its row.
TSUBU_INLINE D4 spinRow(const GrainRow& row) {
  const D4 inverseRadius{row.inverseRadius, row.inverseRadius, row.inverseRadius, row.inverseRadius};
  const D4 mass{1, 1, 1, row.inverseMass};
  return (load4(&row.sx) * inverseRadius) * mass;
}

/// Four contacts at once: difference and sum of the two rows (x − x', r + r'; v − v', 1/m + 1/m'; rω + r'ω', 1/r + 1/r'; ω − ω',
/// 1/(m r²) + 1/(m' r'²)), turned into columns.
template <class Law>
TSUBU_INLINE void gatherFour(const GrainRow* rows, const std::int32_t* is, const std::int32_t* js, int q, Stage& s) {
  const D4 signs{-1, -1, -1, 1};
  D4 x[4], v[4], w[4];
  for (int k = 0; k < 4; ++k) {
    const double* const a = &rows[is[k]].x;
    const double* const b = &rows[js[k]].x;
    x[k] = load4(a) + signs * load4(b);
    v[k] = load4(a + 4) + signs * load4(b + 4);
    if constexpr (Law::turns || Law::readsRadius) w[k] = load4(a + 8) + load4(b + 8);
  }
  transpose4(x[0], x[1], x[2], x[3]);
  store4(s.dx + q, x[0]);
  store4(s.dy + q, x[1]);
  store4(s.dz + q, x[2]);
  store4(s.radiusSum + q, x[3]);
  transpose4(v[0], v[1], v[2], v[3]);
  store4(s.dvx + q, v[0]);
  store4(s.dvy + q, v[1]);
  store4(s.dvz + q, v[2]);
  store4(s.inverseMassSum + q, v[3]);
  if constexpr (Law::turns || Law::readsRadius) {
    transpose4(w[0], w[1], w[2], w[3]);
    store4(s.sx + q, w[0]);
    store4(s.sy + q, w[1]);
    store4(s.sz + q, w[2]);
    if constexpr (Law::readsRadius) store4(s.inverseRadiusSum + q, w[3]);
  }
  if constexpr (Law::rolls) {
    D4 r[4];
    for (int k = 0; k < 4; ++k) r[k] = spinRow(rows[is[k]]) + signs * spinRow(rows[js[k]]);
    transpose4(r[0], r[1], r[2], r[3]);
    store4(s.rx + q, r[0]);
    store4(s.ry + q, r[1]);
    store4(s.rz + q, r[2]);
    store4(s.inverseInertiaSum + q, r[3]);
  }
}

/// Columns of the stage from the rows of both grains. The columns have room for a multiple of four: places beyond `count` repeat the
/// last contact.
template <class Law, bool oneClass, bool accounts>
void gather(const PassContext& context, const std::int32_t* is, const std::int32_t* js, int count, Stage& s) {
  const GrainRow* const rows = context.rows;
  int q = 0;
  for (; q + 4 <= count; q += 4) gatherFour<Law>(rows, is + q, js + q, q, s);
  if (q < count) {
    std::int32_t i[4], j[4];
    for (int k = 0; k < 4; ++k) {
      const int from = q + k < count ? q + k : count - 1;
      i[k] = is[from];
      j[k] = js[from];
    }
    gatherFour<Law>(rows, i, j, q, s);
  }
  if (accounts && context.observed)
    for (q = 0; q < count; ++q) s.smallerRadius[q] = smaller(rows[is[q]].radius, rows[js[q]].radius);
  if constexpr (!oneClass)
    for (q = 0; q < count; ++q)
      s.pairClass[q] = static_cast<std::int32_t>(context.material[is[q]] * context.materials + context.material[js[q]]);
}

/// Columns of the constants of each contact's pair of materials. Rows of constants are read four doubles at a time: the table has room
/// for it behind its end.
template <class Law>
void gatherConstants(const PassContext& context, int count, Stage& s) {
  constexpr int size = doublesIn<typename Law::Pair>;
  for (int q = 0; q < count; q += 4) {
    const double* row[4];
    for (int k = 0; k < 4; ++k) row[k] = context.pairs + static_cast<std::size_t>(s.pairClass[q + k < count ? q + k : count - 1]) * size;
    for (int c = 0; c < size; c += 4) {
      D4 r[4];
      for (int k = 0; k < 4; ++k) r[k] = load4(row[k] + c);
      transpose4(r[0], r[1], r[2], r[3]);
      for (int k = 0; k < 4 && c + k < size; ++k) store4(s.constants[c + k] + q, r[k]);
    }
  }
}

/// Law::Pair from columns. Part by part: an empty part has no column.
template <class Law>
TSUBU_INLINE typename Law::Pair pairFromColumns(const double (*constants)[chunkSize], int q) {
  using N = typename Law::Normal::Pair;
  using T = typename Law::Tangential::Pair;
  using R = typename Law::Rolling::Pair;
  using W = typename Law::Twisting::Pair;
  constexpr int t = doublesIn<N>, r = t + doublesIn<T>, w = r + doublesIn<R>;
  static_assert(w + doublesIn<W> == doublesIn<typename Law::Pair> && w + doublesIn<W> <= mostConstants);
  return {fromColumns<N>(constants, 0, q), fromColumns<T>(constants, t, q), fromColumns<R>(constants, r, q), fromColumns<W>(constants, w, q)};
}

/// Law::Memory from columns and back.
template <class Law>
TSUBU_INLINE typename Law::Memory memoryFromColumns(double* const (&columns)[mostMemory], int q) {
  using M = typename Law::Memory;
  return {fromColumns<decltype(M::tangential)>(columns, 0, q), fromColumns<decltype(M::rolling)>(columns, Law::tangentialSize, q),
          fromColumns<decltype(M::twisting)>(columns, Law::tangentialSize + Law::rollingSize, q)};
}
template <class Law>
TSUBU_INLINE void memoryToColumns(typename Law::Memory& memory, bool kept, double* const (&columns)[mostMemory], int q) {
  int c = 0;
  const auto put = [&](double value) __attribute__((always_inline)) { columns[c++][q] = kept ? value : 0; };
  memory.tangential.each(put);
  memory.rolling.each(put);
  memory.twisting.each(put);
}

/// Directions, overlaps and effective masses, over what they are made of. A loop of its own: with the law behind it in one loop the
/// chain of dependent operations is longer than what a processor looks ahead, and it waits for each contact.
template <class Law>
void findDirections(int count, Stage& s) {
  TSUBU_INDEPENDENT
  for (int q = 0; q < count; ++q) {
    const V3 d{s.dx[q], s.dy[q], s.dz[q]};
    const double distance = norm(d), safeDistance = larger(distance, tiny);
    // One division for three reciprocals: divisions and roots are what this loop waits for.
    double reciprocal = 1;
    if constexpr (Law::readsRadius) {
      const double all = 1 / (safeDistance * s.radiusSum[q] * s.inverseMassSum[q] * s.inverseRadiusSum[q]);
      reciprocal = all * s.inverseRadiusSum[q];
      s.effectiveRadius[q] = all * (safeDistance * s.radiusSum[q] * s.inverseMassSum[q]);
    } else {
      reciprocal = 1 / (safeDistance * s.radiusSum[q] * s.inverseMassSum[q]);
    }
    const double perDistance = reciprocal * s.radiusSum[q] * s.inverseMassSum[q];
    s.effectiveMass[q] = reciprocal * safeDistance * s.radiusSum[q];
    if constexpr (Law::turns) {
      const double perRadiusSum = reciprocal * safeDistance * s.inverseMassSum[q];
      s.perRadiusSum[q] = perRadiusSum;
      s.arm[q] = distance * perRadiusSum;
    }
    s.overlap[q] = s.radiusSum[q] - distance;
    s.dx[q] = perDistance * d.x, s.dy[q] = perDistance * d.y, s.dz[q] = perDistance * d.z;
  }
}

/// Velocities along the normal and across it, over the relative velocities.
template <class Law, bool weighted>
void findSlip(int count, Stage& s) {
  TSUBU_INDEPENDENT
  for (int q = 0; q < count; ++q) {
    const V3 n{s.dx[q], s.dy[q], s.dz[q]}, dv{s.dvx[q], s.dvy[q], s.dvz[q]};
    const double separationSpeed = dot(dv, n);
    s.separationSpeed[q] = separationSpeed;
    if constexpr (Law::turns) {
      const V3 spin{s.sx[q], s.sy[q], s.sz[q]};
      const V3 slip = dv - separationSpeed * n - s.arm[q] * cross(spin, n);
      s.dvx[q] = slip.x, s.dvy[q] = slip.y, s.dvz[q] = slip.z;
      // Between grains the mean is weighted with the radii, which the sum of r ω gives for nothing; any mean turns with the pair.
      const V3 frameSpin = weighted ? V3{s.ox[q], s.oy[q], s.oz[q]} : s.perRadiusSum[q] * spin;
      s.frameSpin[q] = dot(frameSpin, n);
    }
  }
}

/// √m* for the laws that read it. A loop of its own: roots that nothing waits for.
void findRootMass(int count, Stage& s) {
  TSUBU_INDEPENDENT
  for (int q = 0; q < count; ++q) s.rootMass[q] = std::sqrt(s.effectiveMass[q]);
}

/// Carries the memory along (T3).
template <class Law>
void carryMemory(double turning, int count, Stage& s, double* const (&columns)[mostMemory]) {
  TSUBU_INDEPENDENT
  for (int q = 0; q < count; ++q) {
    typename Law::Memory held = memoryFromColumns<Law>(columns, q);
    Law::carry({s.dx[q], s.dy[q], s.dz[q]}, turning * s.frameSpin[q], held);
    memoryToColumns<Law>(held, true, columns, q);
  }
}

/// A contact of the stage, as a law sees it.
template <class Law>
TSUBU_INLINE Contact contactAt(const Stage& s, int q) {
  Contact c;
  c.n = {s.dx[q], s.dy[q], s.dz[q]};
  c.overlap = s.overlap[q];
  c.separationSpeed = s.separationSpeed[q];
  c.effectiveMass = s.effectiveMass[q];
  c.inverseEffectiveMass = s.inverseMassSum[q];
  c.rootMass = s.rootMass[q];
  if constexpr (Law::readsRadius) c.effectiveRadius = s.effectiveRadius[q];
  if constexpr (Law::turns) c.slip = {s.dvx[q], s.dvy[q], s.dvz[q]};
  if constexpr (Law::rolls) {
    c.relativeSpin = {s.rx[q], s.ry[q], s.rz[q]};
    c.inverseSpinInertia = 2.5 * s.inverseInertiaSum[q];
  }
  return c;
}

/// What springs store at the instant of the forces, and how deep contacts are. Only rows of the ledger and the watch ask for it: the law
/// is evaluated for them once more, before it advances the memory, and nothing else is kept.
template <class Law, bool oneClass, bool weighted>
void observe(const PassContext& context, const typename Law::Pair& known, int count, Stage& s, double* const (&columns)[mostMemory]) {
  const typename Law::Pair only = known;
  const StepOf step = context.step;
  TSUBU_INDEPENDENT
  for (int q = 0; q < count; ++q) {
    const Contact c = contactAt<Law>(s, q);
    const bool touching = c.overlap > 0;
    typename Law::Memory held = memoryFromColumns<Law>(columns, q);
    ContactEnergy energy{};
    const typename Law::Pair pair = oneClass ? only : pairFromColumns<Law>(s.constants, q);
    Law::template evaluate<true>(pair, c, step, held, energy);
    const double share = weighted ? s.weight[q] : 1.0;
    s.account[Accounts::storedNormal][q] = touching ? share * energy.storedNormal : 0;
    s.account[Accounts::storedTangential][q] = touching ? share * energy.storedTangential : 0;
    s.account[Accounts::storedRolling][q] = touching ? share * energy.storedRolling : 0;
    s.account[Accounts::overlap][q] = touching ? c.overlap / s.smallerRadius[q] : 0;
  }
}

/// The law on every contact of the chunk. `memory` points to the columns of the contacts' memory.
template <class Law, bool oneClass, bool accounts, bool weighted>
void compute(const PassContext& context, int count, Stage& s, double* const* memory) {
  typename Law::Pair only{};  // a copy that no store can change
  if constexpr (oneClass)
    std::memcpy(&only, context.pairs, sizeof only);
  else
    gatherConstants<Law>(context, count, s);
  findDirections<Law>(count, s);
  findSlip<Law, weighted>(count, s);
  if (!oneClass || Law::Normal::readsRootMass(only.normal))
    findRootMass(count, s);
  else
    std::fill_n(s.rootMass, count, 0.0);
  const StepOf step = context.step;
  double* columns[mostMemory];
  for (int k = 0; k < mostMemory; ++k) columns[k] = k < Law::stateSize ? memory[k] : nullptr;
  if constexpr (Law::stateSize > 0) carryMemory<Law>(step.turning, count, s, columns);
  if constexpr (accounts)
    if (context.observed) observe<Law, oneClass, weighted>(context, only, count, s, columns);
  TSUBU_INDEPENDENT
  for (int q = 0; q < count; ++q) {
    const Contact c = contactAt<Law>(s, q);
    const bool touching = c.overlap > 0;
    typename Law::Memory held = memoryFromColumns<Law>(columns, q);
    const typename Law::Memory before = held;
    ContactEnergy energy{};
    const typename Law::Pair pair = oneClass ? only : pairFromColumns<Law>(s.constants, q);
    const ContactForce result = Law::template evaluate<accounts>(pair, c, step, held, energy);
    const double share = weighted ? s.weight[q] : 1.0;
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
        double released = 0;
        if constexpr (Law::stateSize > Law::tangentialSize)
          released = Law::storedRolling(pair, c, Law::Normal::force(pair.normal, c, step).stiffness, before);
        s.account[Accounts::rolling][q] = share * (touching ? energy.rolling : released);
      }
    }
  }
}

/// Which kinds of accounts a law fills in.
template <class Law>
constexpr bool books(Accounts::Kind kind) {
  return kind == Accounts::rolling                                        ? Law::rolls
         : kind == Accounts::tangential || kind == Accounts::friction ? Law::turns
                                                                         : true;
}

template <class Law>
void addAccounts(int count, const Stage& s, bool observed, Accounts& accounts) {
  const int whole = count & ~7;
  for (int kind = observed ? 0 : Accounts::normal; kind < Accounts::overlap; ++kind) {
    if (!books<Law>(static_cast<Accounts::Kind>(kind))) continue;
    const double* const column = s.account[kind];
    double* const lane = accounts.lane[kind];
    for (int q = 0; q < whole; q += 8)
      for (int l = 0; l < 8; ++l) lane[l] += column[q + l];
    for (int q = whole; q < count; ++q) lane[q - whole] += column[q];
  }
  if (!observed) return;
  const double* const overlap = s.account[Accounts::overlap];
  double* const deepest = accounts.lane[Accounts::overlap];
  for (int q = 0; q < whole; q += 8)
    for (int l = 0; l < 8; ++l) deepest[l] = larger(deepest[l], overlap[q + l]);
  for (int q = whole; q < count; ++q) deepest[q - whole] = larger(deepest[q - whole], overlap[q]);
}

/// Adds the columns of up to four contacts to the rows of both grains.
template <class Law>
TSUBU_INLINE void scatterFour(const PassContext& context, const std::int32_t* is, const std::int32_t* js, int count, int q, Stage& s) {
  D4 f[4] = {load4(s.fx + q), load4(s.fy + q), load4(s.fz + q), D4{}}, c[4], m[4];
  transpose4(f[0], f[1], f[2], f[3]);
  if constexpr (Law::turns) {
    c[0] = load4(s.qx + q), c[1] = load4(s.qy + q), c[2] = load4(s.qz + q), c[3] = D4{};
    transpose4(c[0], c[1], c[2], c[3]);
  }
  if constexpr (Law::rolls) {
    m[0] = load4(s.mx + q), m[1] = load4(s.my + q), m[2] = load4(s.mz + q), m[3] = D4{};
    transpose4(m[0], m[1], m[2], m[3]);
  }
  for (int k = 0; k < count; ++k) {
    double* const a = &context.forces[is[k]].fx;
    double* const b = &context.forces[js[k]].fx;
    add4(a, f[k]);
    subtract4(b, f[k]);
    if constexpr (Law::rolls) {
      // T = −r Q + M, so a moment is −M/r in Q, which differs for the two.
      add4(a + 4, c[k] - fill4(context.rows[is[k]].inverseRadius) * m[k]);
      add4(b + 4, c[k] + fill4(context.rows[js[k]].inverseRadius) * m[k]);
    } else if constexpr (Law::turns) {
      add4(a + 4, c[k]);
      add4(b + 4, c[k]);
    }
  }
}

/// Adds the columns to the rows of both grains, in the order of the contacts.
template <class Law>
void scatter(const PassContext& context, const std::int32_t* is, const std::int32_t* js, int count, Stage& s) {
  int q = 0;
  for (; q + 4 <= count; q += 4) scatterFour<Law>(context, is + q, js + q, 4, q, s);
  if (q < count) scatterFour<Law>(context, is + q, js + q, count - q, q, s);
}

/// Pairs that touch at another distance than the sum of their radii: the sum is changed, and with it what the loop divides by it. The
/// arms stay those of the grains: the spins go in scaled, and `restoreArms` scales the couple that comes out.
template <class Law>
void touchSooner(const double* touch, int count, Stage& s) {
  for (int q = 0; q < count; ++q) {
    if (touch[q] == 0) continue;
    const double scale = touch[q] / s.radiusSum[q];
    s.armScale[q] = scale;
    s.radiusSum[q] = touch[q];
    if constexpr (Law::turns) s.sx[q] *= scale, s.sy[q] *= scale, s.sz[q] *= scale;
  }
}

template <class Law>
void restoreArms(const double* touch, int count, Stage& s) {
  if constexpr (Law::turns) {
    for (int q = 0; q < count; ++q)
      if (touch[q] != 0) s.qx[q] *= s.armScale[q], s.qy[q] *= s.armScale[q], s.qz[q] *= s.armScale[q];
  }
}

/// Asks for the rows of a chunk's partners; those of the first grains come in order, and the processor sees it.
TSUBU_INLINE void askFor(const PassContext& context, const std::int32_t* js, std::int64_t count) {
  for (std::int64_t q = 0; q < count; ++q) {
    const auto* const row = reinterpret_cast<const char*>(&context.rows[js[q]]);
    __builtin_prefetch(row, 0, 2);
    __builtin_prefetch(row + sizeof(GrainRow) - 1, 0, 2);
    __builtin_prefetch(&context.forces[js[q]], 1, 2);
  }
}

template <class Law, bool oneClass, bool accounts>
void passPairs(const PassContext& context, const PairRange& range, Stage& stage, Accounts& sums) {
  for (std::int64_t first = 0; first < range.count; first += chunkSize) {
    const std::int64_t left = range.count - first;
    const int count = static_cast<int>(left < chunkSize ? left : chunkSize);
    if (context.prefetch) askFor(context, range.j + first + count, left - count < chunkSize ? left - count : chunkSize);
    double* memory[mostMemory] = {};
    for (int c = 0; c < Law::stateSize; ++c) memory[c] = range.memory + static_cast<std::size_t>(c) * range.stride + first;
    gather<Law, oneClass, accounts>(context, range.i + first, range.j + first, count, stage);
    if (range.touch) touchSooner<Law>(range.touch + first, count, stage);
    compute<Law, oneClass, accounts, false>(context, count, stage, memory);
    if (range.touch) restoreArms<Law>(range.touch + first, count, stage);
    if constexpr (accounts) addAccounts<Law>(count, stage, context.observed, sums);
    scatter<Law>(context, range.i + first, range.j + first, count, stage);
  }
}

template <class Law, bool oneClass, bool accounts>
void passWalls(const PassContext& context, int count, Stage& stage, Accounts& sums) {
  double* memory[mostMemory];
  for (int c = 0; c < mostMemory; ++c) memory[c] = stage.memory[c];
  compute<Law, oneClass, accounts, true>(context, count, stage, memory);
  if constexpr (accounts) addAccounts<Law>(count, stage, context.observed, sums);
}

#ifndef TSUBU_EVERY_LAW
#define TSUBU_EVERY_LAW false
#endif

// Laws that are not common are compiled once, for any processor and any number of classes: they are there for comparison.
template <class Law, bool oneClass, bool accounts>
inline constexpr bool hasKernel = objection<Law>.empty() && (Law::common || (TSUBU_EVERY_LAW && !oneClass && accounts));

template <bool oneClass, bool accounts>
constexpr auto pairTable = tableOf(ContactLaws{}, []<class Law>() -> PairKernel {
  if constexpr (hasKernel<Law, oneClass, accounts>)
    return &passPairs<Law, oneClass, accounts>;
  else
    return nullptr;
});
template <bool oneClass, bool accounts>
constexpr auto wallTable = tableOf(ContactLaws{}, []<class Law>() -> WallKernel {
  if constexpr (hasKernel<Law, oneClass, accounts>)
    return &passWalls<Law, oneClass, accounts>;
  else
    return nullptr;
});

PairKernel pairPassFor(std::size_t law, PassKind kind) {
  if (kind.oneClass) return kind.accounts ? pairTable<true, true>[law] : pairTable<true, false>[law];
  return kind.accounts ? pairTable<false, true>[law] : pairTable<false, false>[law];
}

WallKernel wallPassFor(std::size_t law, PassKind kind) {
  if (kind.oneClass) return kind.accounts ? wallTable<true, true>[law] : wallTable<true, false>[law];
  return kind.accounts ? wallTable<false, true>[law] : wallTable<false, false>[law];
}

}  // namespace
}  // namespace tsubu::sim
