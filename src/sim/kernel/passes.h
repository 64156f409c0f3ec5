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

template <class Real>
constexpr bool single = std::is_same_v<Real, float>;

/// ω and 1/(m r²) of a grain, from its row.
TSUBU_INLINE D4 spinRow(const GrainRow& row) {
  const D4 inverseRadius{row.inverseRadius, row.inverseRadius, row.inverseRadius, row.inverseRadius};
  const D4 mass{1, 1, 1, row.inverseMass};
  return (load4(&row.sx) * inverseRadius) * mass;
}
TSUBU_INLINE F4 spinRow(const SingleRow& row) {
  const F4 inverseRadius{row.inverseRadius, row.inverseRadius, row.inverseRadius, row.inverseRadius};
  const F4 mass{1, 1, 1, row.inverseMass};
  return (load4(&row.sx) * inverseRadius) * mass;
}

/// Stores columns of which the rows have been turned.
template <class Vector, class Real>
TSUBU_INLINE void storeColumns(const Vector (&v)[4], Real* a, Real* b, Real* c, Real* d) {
  store4(a, as<Real>(v[0])), store4(b, as<Real>(v[1])), store4(c, as<Real>(v[2])), store4(d, as<Real>(v[3]));
}

/// ω − ω' and 1/(m r²) + 1/(m' r'²) of four contacts.
template <class Row, class Real>
TSUBU_INLINE void gatherSpins(const Row* rows, const std::int32_t* is, const std::int32_t* js, int q, StageIn<Real>& s) {
  const Four<Real> signs{-1, -1, -1, 1};
  Four<Real> r[4];
  for (int k = 0; k < 4; ++k) r[k] = spinRow(rows[is[k]]) + signs * spinRow(rows[js[k]]);
  transpose4(r[0], r[1], r[2], r[3]);
  storeColumns(r, s.rx + q, s.ry + q, s.rz + q, s.inverseInertiaSum + q);
}

/// How many contacts are gathered and scattered at once.
template <class Real>
constexpr int together = single<Real> ? 8 : 4;

/// Four contacts at once: difference and sum of the two rows (x − x', r + r'; v − v', 1/m + 1/m'; rω + r'ω', 1/r + 1/r'; ω − ω',
/// 1/(m r²) + 1/(m' r'²)), turned into columns.
template <class Law>
TSUBU_INLINE void gatherSome(const PassContext& context, const std::int32_t* is, const std::int32_t* js, int q, Stage& s) {
  const GrainRow* const rows = context.rows;
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
  storeColumns(x, s.dx + q, s.dy + q, s.dz + q, s.radiusSum + q);
  transpose4(v[0], v[1], v[2], v[3]);
  storeColumns(v, s.dvx + q, s.dvy + q, s.dvz + q, s.inverseMassSum + q);
  if constexpr (Law::turns || Law::readsRadius) {
    transpose4(w[0], w[1], w[2], w[3]);
    storeColumns(w, s.sx + q, s.sy + q, s.sz + q, s.inverseRadiusSum + q);
  }
  if constexpr (Law::rolls) gatherSpins(rows, is, js, q, s);
}

/// Eight contacts at once, in single precision but for the difference of the places, of which the overlap is a small part.
template <class Law>
TSUBU_INLINE void gatherSome(const PassContext& context, const std::int32_t* is, const std::int32_t* js, int q, StageIn<float>& s) {
  const SingleRow* const rows = context.single;
  const D4 signs{-1, -1, -1, 1};
  const F8 signsOfBoth{-1, -1, -1, 1, 1, 1, 1, 1};
  F8 v[8];
  for (int h = 0; h < 8; h += 4) {
    D4 x[4];
    for (int k = 0; k < 4; ++k) {
      const SingleRow &a = rows[is[h + k]], &b = rows[js[h + k]];
      x[k] = load4(&a.x) + signs * load4(&b.x);
      v[h + k] = load8(&a.vx) + signsOfBoth * load8(&b.vx);
    }
    transpose4(x[0], x[1], x[2], x[3]);
    store4(s.gap + q + h, as<float>(x[3] * x[3] - (x[0] * x[0] + x[1] * x[1] + x[2] * x[2])));
    storeColumns(x, s.dx + q + h, s.dy + q + h, s.dz + q + h, s.radiusSum + q + h);
    if constexpr (Law::rolls) gatherSpins(rows, is + h, js + h, q + h, s);
  }
  transpose8(v);
  store8(s.dvx + q, v[0]), store8(s.dvy + q, v[1]), store8(s.dvz + q, v[2]), store8(s.inverseMassSum + q, v[3]);
  if constexpr (Law::turns) store8(s.sx + q, v[4]), store8(s.sy + q, v[5]), store8(s.sz + q, v[6]);
  if constexpr (Law::readsRadius) store8(s.inverseRadiusSum + q, v[7]);
}

/// Columns of the stage from the rows of both grains. The columns have room for a multiple of eight: places beyond `count` repeat the
/// last contact.
template <class Law, bool oneClass, class Real>
void gather(const PassContext& context, const std::int32_t* is, const std::int32_t* js, int count, StageIn<Real>& s) {
  const GrainRow* const rows = context.rows;
  constexpr int some = together<Real>;
  int q = 0;
  for (; q + some <= count; q += some) gatherSome<Law>(context, is + q, js + q, q, s);
  if (q < count) {
    std::int32_t i[some], j[some];
    for (int k = 0; k < some; ++k) {
      const int from = q + k < count ? q + k : count - 1;
      i[k] = is[from];
      j[k] = js[from];
    }
    gatherSome<Law>(context, i, j, q, s);
  }
  if (context.observed)
    for (q = 0; q < count; ++q) s.smallerRadius[q] = static_cast<Real>(smaller(rows[is[q]].radius, rows[js[q]].radius));
  if constexpr (!oneClass)
    for (q = 0; q < count; ++q)
      s.pairClass[q] = static_cast<std::int32_t>(context.material[is[q]] * context.materials + context.material[js[q]]);
}

/// Columns of the constants of each contact's pair of materials. Rows of constants are read four doubles at a time: the table has room
/// for it behind its end.
template <class Law, class Real>
void gatherConstants(const PassContext& context, int count, StageIn<Real>& s) {
  constexpr int size = numbersIn<typename Law::Pair>;
  for (int q = 0; q < count; q += 4) {
    const double* row[4];
    for (int k = 0; k < 4; ++k) row[k] = context.pairs + static_cast<std::size_t>(s.pairClass[q + k < count ? q + k : count - 1]) * size;
    for (int c = 0; c < size; c += 4) {
      D4 r[4];
      for (int k = 0; k < 4; ++k) r[k] = load4(row[k] + c);
      transpose4(r[0], r[1], r[2], r[3]);
      for (int k = 0; k < 4 && c + k < size; ++k) store4(s.constants[c + k] + q, as<Real>(r[k]));
    }
  }
}

/// Law::PairIn from columns. Part by part: an empty part has no column.
template <class Law, class Real>
TSUBU_INLINE typename Law::template PairIn<Real> pairFromColumns(const Real (*constants)[chunkSize], int q) {
  using N = typename Law::Normal::template PairIn<Real>;
  using T = typename Law::Tangential::template PairIn<Real>;
  using R = typename Law::Rolling::template PairIn<Real>;
  using W = typename Law::Twisting::template PairIn<Real>;
  constexpr int t = numbersIn<N, Real>, r = t + numbersIn<T, Real>, w = r + numbersIn<R, Real>;
  static_assert(w + numbersIn<W, Real> == numbersIn<typename Law::Pair> && w + numbersIn<W, Real> <= mostConstants);
  return {fromColumns<N, Real>(constants, 0, q), fromColumns<T, Real>(constants, t, q), fromColumns<R, Real>(constants, r, q),
          fromColumns<W, Real>(constants, w, q)};
}

/// Law::PairIn of the one class that there is: a copy that no store can change.
template <class Law, class Real>
typename Law::template PairIn<Real> onlyPair(const double* constants) {
  constexpr int size = numbersIn<typename Law::Pair>;
  typename Law::template PairIn<Real> only{};
  Real converted[size];
  for (int c = 0; c < size; ++c) converted[c] = static_cast<Real>(constants[c]);
  static_assert(sizeof only == sizeof converted);
  std::memcpy(&only, converted, sizeof only);
  return only;
}

/// Law::MemoryIn from columns and back.
template <class Law, class Real>
TSUBU_INLINE typename Law::template MemoryIn<Real> memoryFromColumns(Real* const (&columns)[mostMemory], int q) {
  using M = typename Law::template MemoryIn<Real>;
  return {fromColumns<decltype(M::tangential), Real>(columns, 0, q), fromColumns<decltype(M::rolling), Real>(columns, Law::tangentialSize, q),
          fromColumns<decltype(M::twisting), Real>(columns, Law::tangentialSize + Law::rollingSize, q)};
}
template <class Law, class Real>
TSUBU_INLINE void memoryToColumns(typename Law::template MemoryIn<Real>& memory, bool kept, Real* const (&columns)[mostMemory], int q) {
  int c = 0;
  const auto put = [&](Real value) __attribute__((always_inline)) { columns[c++][q] = kept ? value : 0; };
  memory.tangential.each(put);
  memory.rolling.each(put);
  memory.twisting.each(put);
}

/// What a reciprocal is taken of at least: of a product of lengths and masses in single precision, more than of a length.
template <class Real>
constexpr Real leastDivisor = single<Real> ? Real(1e-12) : tinyIn<Real>;

/// Directions, overlaps and effective masses, over what they are made of. A loop of its own: with the law behind it in one loop the
/// chain of dependent operations is longer than what a processor looks ahead, and it waits for each contact.
template <class Law, class Real>
void findDirections(int count, StageIn<Real>& s) {
  TSUBU_INDEPENDENT
  for (int q = 0; q < count; ++q) {
    const V3In<Real> d{s.dx[q], s.dy[q], s.dz[q]};
    const Real distance = norm(d), safeDistance = larger(distance, leastDivisor<Real>);
    // One division for three reciprocals: divisions and roots are what this loop waits for.
    Real reciprocal = 1;
    if constexpr (Law::readsRadius) {
      const Real all = 1 / (safeDistance * s.radiusSum[q] * s.inverseMassSum[q] * s.inverseRadiusSum[q]);
      reciprocal = all * s.inverseRadiusSum[q];
      s.effectiveRadius[q] = all * (safeDistance * s.radiusSum[q] * s.inverseMassSum[q]);
    } else {
      reciprocal = 1 / (safeDistance * s.radiusSum[q] * s.inverseMassSum[q]);
    }
    const Real perDistance = reciprocal * s.radiusSum[q] * s.inverseMassSum[q];
    s.effectiveMass[q] = reciprocal * safeDistance * s.radiusSum[q];
    if constexpr (Law::turns) {
      const Real perRadiusSum = reciprocal * safeDistance * s.inverseMassSum[q];
      s.perRadiusSum[q] = perRadiusSum;
      s.arm[q] = distance * perRadiusSum;
    }
    if constexpr (single<Real>)
      s.overlap[q] = s.gap[q] / (s.radiusSum[q] + distance);
    else
      s.overlap[q] = s.radiusSum[q] - distance;
    s.dx[q] = perDistance * d.x, s.dy[q] = perDistance * d.y, s.dz[q] = perDistance * d.z;
  }
}

/// Velocities along the normal and across it, over the relative velocities.
template <class Law, bool weighted, class Real>
void findSlip(int count, StageIn<Real>& s) {
  TSUBU_INDEPENDENT
  for (int q = 0; q < count; ++q) {
    const V3In<Real> n{s.dx[q], s.dy[q], s.dz[q]}, dv{s.dvx[q], s.dvy[q], s.dvz[q]};
    const Real separationSpeed = dot(dv, n);
    s.separationSpeed[q] = separationSpeed;
    if constexpr (Law::turns) {
      const V3In<Real> spin{s.sx[q], s.sy[q], s.sz[q]};
      const V3In<Real> slip = dv - separationSpeed * n - s.arm[q] * cross(spin, n);
      s.dvx[q] = slip.x, s.dvy[q] = slip.y, s.dvz[q] = slip.z;
      // Between grains the mean is weighted with the radii, which the sum of r ω gives for nothing; any mean turns with the pair.
      const V3In<Real> frameSpin = weighted ? V3In<Real>{s.ox[q], s.oy[q], s.oz[q]} : s.perRadiusSum[q] * spin;
      s.frameSpin[q] = dot(frameSpin, n);
    }
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
    c.inverseSpinInertia = Real(2.5) * s.inverseInertiaSum[q];
  }
  return c;
}

/// What springs store at the instant of the forces. Only rows of the ledger ask for it: the law is evaluated for them once more, before it
/// advances the memory, and nothing else is kept.
template <class Law, bool oneClass, bool weighted, class Real>
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
    const Real share = weighted ? s.weight[q] : 1;
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

/// The law on every contact of the chunk. `memory` points to the columns of the contacts' memory.
template <class Law, bool oneClass, bool accounts, bool weighted, class Real>
void compute(const PassContext& context, int count, StageIn<Real>& s, Real* const* memory, Ahead& ahead) {
  typename Law::template PairIn<Real> only{};
  if constexpr (oneClass)
    only = onlyPair<Law, Real>(context.pairs);
  else
    gatherConstants<Law>(context, count, s);
  ahead.ask<Real>();
  findDirections<Law>(count, s);
  ahead.ask<Real>();
  findSlip<Law, weighted>(count, s);
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
    if (context.observed) observe<Law, oneClass, weighted>(only, step, count, s, columns);
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
    const Real share = weighted ? s.weight[q] : 1;
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
template <class Law>
constexpr bool books(Accounts::Kind kind) {
  return kind == Accounts::rolling                                        ? Law::rolls
         : kind == Accounts::tangential || kind == Accounts::friction ? Law::turns
                                                                         : true;
}

template <class Law, class Real>
void addAccounts(int count, const StageIn<Real>& s, bool observed, Accounts& accounts) {
  const int whole = count & ~7;
  for (int kind = observed ? 0 : Accounts::normal; kind < Accounts::overlap; ++kind) {
    if (!books<Law>(static_cast<Accounts::Kind>(kind))) continue;
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

/// Forces, couples and moments of four contacts as rows.
template <class Law>
TSUBU_INLINE void forceRows(const Stage& s, int q, D4 (&f)[4], D4 (&c)[4], D4 (&m)[4]) {
  const auto turn = [q](const double* x, const double* y, const double* z, D4 (&rows)[4]) __attribute__((always_inline)) {
    rows[0] = load4(x + q), rows[1] = load4(y + q), rows[2] = load4(z + q), rows[3] = D4{};
    transpose4(rows[0], rows[1], rows[2], rows[3]);
  };
  turn(s.fx, s.fy, s.fz, f);
  if constexpr (Law::turns) turn(s.qx, s.qy, s.qz, c);
  if constexpr (Law::rolls) turn(s.mx, s.my, s.mz, m);
}

/// Adds the columns of up to four contacts to the rows of both grains. T = −r Q + M, so a moment is −M/r in Q, which differs for the two.
template <class Law>
TSUBU_INLINE void scatterSome(const PassContext& context, const std::int32_t* is, const std::int32_t* js, int count, int q, const Stage& s) {
  D4 f[4], c[4], m[4];
  forceRows<Law>(s, q, f, c, m);
  for (int k = 0; k < count; ++k) {
    double* const a = &context.forces[is[k]].fx;
    double* const b = &context.forces[js[k]].fx;
    add4(a, f[k]);
    subtract4(b, f[k]);
    if constexpr (Law::rolls) {
      add4(a + 4, c[k] - fill4(context.rows[is[k]].inverseRadius) * m[k]);
      add4(b + 4, c[k] + fill4(context.rows[js[k]].inverseRadius) * m[k]);
    } else if constexpr (Law::turns) {
      add4(a + 4, c[k]);
      add4(b + 4, c[k]);
    }
  }
}

/// The same for up to eight contacts in single precision.
template <class Law>
TSUBU_INLINE void scatterSome(const PassContext& context, const std::int32_t* is, const std::int32_t* js, int count, int q, const StageIn<float>& s) {
  const F8 opposite{-1, -1, -1, 1, 1, 1, 1, 1};
  F8 f[8] = {load8(s.fx + q), load8(s.fy + q), load8(s.fz + q)}, m[8];
  if constexpr (Law::turns) f[4] = load8(s.qx + q), f[5] = load8(s.qy + q), f[6] = load8(s.qz + q);
  transpose8(f);
  if constexpr (Law::rolls) {
    m[0] = m[1] = m[2] = m[3] = m[7] = F8{};
    m[4] = load8(s.mx + q), m[5] = load8(s.my + q), m[6] = load8(s.mz + q);
    transpose8(m);
  }
  for (int k = 0; k < count; ++k) {
    float* const a = &context.singleForces[is[k]].fx;
    float* const b = &context.singleForces[js[k]].fx;
    if constexpr (Law::rolls) {
      store8(a, load8(a) + (f[k] - fill8(context.single[is[k]].inverseRadius) * m[k]));
      store8(b, load8(b) + (opposite * f[k] + fill8(context.single[js[k]].inverseRadius) * m[k]));
    } else {
      store8(a, load8(a) + f[k]);
      store8(b, load8(b) + opposite * f[k]);
    }
  }
}

/// Adds the columns to the rows of both grains, in the order of the contacts.
template <class Law, class Real>
void scatter(const PassContext& context, const std::int32_t* is, const std::int32_t* js, int count, StageIn<Real>& s) {
  constexpr int some = together<Real>;
  int q = 0;
  for (; q + some <= count; q += some) scatterSome<Law>(context, is + q, js + q, some, q, s);
  if (q < count) scatterSome<Law>(context, is + q, js + q, count - q, q, s);
}

/// Pairs that touch at another distance than the sum of their radii: the sum is changed, and with it what the loop divides by it. The
/// arms stay those of the grains: the spins go in scaled, and `restoreArms` scales the couple that comes out.
template <class Law, class Real>
void touchSooner(const double* touch, int count, StageIn<Real>& s) {
  for (int q = 0; q < count; ++q) {
    if (touch[q] == 0) continue;
    const Real sum = static_cast<Real>(touch[q]), scale = sum / s.radiusSum[q];
    s.armScale[q] = scale;
    if constexpr (single<Real>) s.gap[q] += (sum - s.radiusSum[q]) * (sum + s.radiusSum[q]);
    s.radiusSum[q] = sum;
    if constexpr (Law::turns) s.sx[q] *= scale, s.sy[q] *= scale, s.sz[q] *= scale;
  }
}

template <class Law, class Real>
void restoreArms(const double* touch, int count, StageIn<Real>& s) {
  if constexpr (Law::turns) {
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
    gather<Law, oneClass>(context, range.i + first, range.j + first, count, stage);
    if (range.touch) touchSooner<Law>(range.touch + first, count, stage);
    compute<Law, oneClass, accounts, false>(context, count, stage, memory, ahead);
    ahead.ask<Real>();
    if (range.touch) restoreArms<Law>(range.touch + first, count, stage);
    if constexpr (accounts) addAccounts<Law>(count, stage, context.observed, sums);
    if (context.observed) addDeepest(count, stage, sums);
    scatter<Law>(context, range.i + first, range.j + first, count, stage);
  }
}

/// Columns from the rows of four grains and what the wall does where they touch.
template <class Law>
TSUBU_INLINE void gatherFourOfWalls(const PassContext& context, const std::int32_t* grains, const WallContactRow* contacts, int q, Stage& s) {
  const D4 signs{-1, -1, -1, 1};
  D4 d[4], v[4], w[4], spin[4], mass{}, radius{};
  for (int k = 0; k < 4; ++k) {
    const GrainRow& row = context.rows[grains[k]];
    const WallContactRow& contact = contacts[k];
    d[k] = load4(&contact.dx);
    v[k] = load4(&row.vx) + signs * load4(&contact.vx);
    radius[k] = row.radius;
    if constexpr (Law::turns || Law::readsRadius) w[k] = load4(&row.sx);
    if constexpr (Law::turns) spin[k] = load4(&contact.wx);
    if constexpr (Law::rolls) mass[k] = row.inverseMass;
  }
  transpose4(d[0], d[1], d[2], d[3]);
  store4(s.dx + q, d[0]), store4(s.dy + q, d[1]), store4(s.dz + q, d[2]);
  store4(s.radiusSum + q, radius);
  if (context.observed) store4(s.smallerRadius + q, radius);
  transpose4(v[0], v[1], v[2], v[3]);
  store4(s.dvx + q, v[0]), store4(s.dvy + q, v[1]), store4(s.dvz + q, v[2]);
  store4(s.inverseMassSum + q, v[3]);
  if constexpr (Law::turns || Law::readsRadius) {
    transpose4(w[0], w[1], w[2], w[3]);
    if constexpr (Law::readsRadius) store4(s.inverseRadiusSum + q, w[3]);
  }
  if constexpr (Law::turns) {
    store4(s.sx + q, w[0]), store4(s.sy + q, w[1]), store4(s.sz + q, w[2]);
    transpose4(spin[0], spin[1], spin[2], spin[3]);
    const D4 half = fill4(0.5), x = w[3] * w[0], y = w[3] * w[1], z = w[3] * w[2];
    store4(s.ox + q, half * (x + spin[0])), store4(s.oy + q, half * (y + spin[1])), store4(s.oz + q, half * (z + spin[2]));
    if constexpr (Law::rolls) {
      store4(s.rx + q, x - spin[0]), store4(s.ry + q, y - spin[1]), store4(s.rz + q, z - spin[2]);
      store4(s.inverseInertiaSum + q, mass * w[3] * w[3]);
    }
  }
}

/// Adds the columns of up to four contacts to the rows of their grains.
template <class Law>
TSUBU_INLINE void scatterFourOfWalls(const PassContext& context, const std::int32_t* grains, int count, int q, const Stage& s) {
  D4 f[4], c[4], m[4];
  forceRows<Law>(s, q, f, c, m);
  for (int k = 0; k < count; ++k) {
    if (context.singleForces) {
      D4 couple{};
      if constexpr (Law::turns) couple = c[k];
      if constexpr (Law::rolls) couple = couple - m[k] * fill4(context.rows[grains[k]].inverseRadius);
      float* const row = &context.singleForces[grains[k]].fx;
      store8(row, load8(row) + joined(as<float>(f[k]), as<float>(couple)));
      continue;
    }
    ForceRow& row = context.forces[grains[k]];
    add4(&row.fx, f[k]);
    if constexpr (Law::turns) add4(&row.qx, c[k]);
    if constexpr (Law::rolls) subtract4(&row.qx, m[k] * fill4(context.rows[grains[k]].inverseRadius));
  }
}

/// The memory of wall contacts lies in rows, since contacts come and go one by one.
template <class Law>
void fetchWallMemory(const WallRange& range, Stage& s) {
  for (int q = 0; q < range.count; ++q)
    for (int c = 0; c < Law::stateSize; ++c) s.memory[c][q] = range.memory[range.at[q] * Law::stateSize + c];
}
template <class Law>
void returnWallMemory(const WallRange& range, const Stage& s) {
  for (int q = 0; q < range.count; ++q)
    for (int c = 0; c < Law::stateSize; ++c) range.memory[range.at[q] * Law::stateSize + c] = s.memory[c][q];
}

template <class Law, bool oneClass, bool accounts>
void passWalls(const PassContext& context, const WallRange& range, Stage& stage, Accounts& sums) {
  const int count = range.count, whole = count & ~3;
  std::int32_t grains[4];
  WallContactRow rest[4];
  for (int k = 0; k < 4; ++k) grains[k] = range.grain[whole + k < count ? whole + k : count - 1], rest[k] = range.rows[whole + k < count ? whole + k : count - 1];
  for (int q = 0; q < whole; q += 4) gatherFourOfWalls<Law>(context, range.grain + q, range.rows + q, q, stage);
  if (whole < count) gatherFourOfWalls<Law>(context, grains, rest, whole, stage);
  fetchWallMemory<Law>(range, stage);
  double* memory[mostMemory];
  for (int c = 0; c < mostMemory; ++c) memory[c] = stage.memory[c];
  Ahead nobody{context};
  compute<Law, oneClass, accounts, true>(context, count, stage, memory, nobody);
  returnWallMemory<Law>(range, stage);
  if constexpr (accounts) addAccounts<Law>(count, stage, context.observed, sums);
  if (context.observed) addDeepest(count, stage, sums);
  for (int q = 0; q < whole; q += 4) scatterFourOfWalls<Law>(context, range.grain + q, 4, q, stage);
  if (whole < count) scatterFourOfWalls<Law>(context, grains, count - whole, whole, stage);
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

template <class Law>
inline constexpr bool hasOwnLoops = objection<Law>.empty() && Law::common;

}  // namespace
}  // namespace tsubu::sim
