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

/// Four contacts at once: difference and sum of the two rows (x − x', r + r'; v − v', 1/m + 1/m'; rω + r'ω', 1/r + 1/r'; ω − ω',
/// 1/(m r²) + 1/(m' r'²)), turned into columns. Differences are taken in double, whatever the columns are.
template <class Law, class Real>
TSUBU_INLINE void gatherFour(const GrainRow* rows, const std::int32_t* is, const std::int32_t* js, int q, StageIn<Real>& s) {
  const D4 signs{-1, -1, -1, 1};
  D4 x[4];
  Four<Real> v[4], w[4];
  for (int k = 0; k < 4; ++k) {
    const double* const a = &rows[is[k]].x;
    const double* const b = &rows[js[k]].x;
    x[k] = load4(a) + signs * load4(b);
    v[k] = as<Real>(load4(a + 4) + signs * load4(b + 4));
    if constexpr (Law::turns || Law::readsRadius) w[k] = as<Real>(load4(a + 8) + load4(b + 8));
  }
  transpose4(x[0], x[1], x[2], x[3]);
  if constexpr (single<Real>) store4(s.gap + q, as<Real>(x[3] * x[3] - (x[0] * x[0] + x[1] * x[1] + x[2] * x[2])));
  store4(s.dx + q, as<Real>(x[0]));
  store4(s.dy + q, as<Real>(x[1]));
  store4(s.dz + q, as<Real>(x[2]));
  store4(s.radiusSum + q, as<Real>(x[3]));
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
    Four<Real> r[4];
    for (int k = 0; k < 4; ++k) r[k] = as<Real>(spinRow(rows[is[k]]) + signs * spinRow(rows[js[k]]));
    transpose4(r[0], r[1], r[2], r[3]);
    store4(s.rx + q, r[0]);
    store4(s.ry + q, r[1]);
    store4(s.rz + q, r[2]);
    store4(s.inverseInertiaSum + q, r[3]);
  }
}

/// Columns of the stage from the rows of both grains. The columns have room for a multiple of four: places beyond `count` repeat the
/// last contact.
template <class Law, bool oneClass, class Real>
void gather(const PassContext& context, const std::int32_t* is, const std::int32_t* js, int count, StageIn<Real>& s) {
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

/// The law on every contact of the chunk. `memory` points to the columns of the contacts' memory.
template <class Law, bool oneClass, bool accounts, bool weighted, class Real>
void compute(const PassContext& context, int count, StageIn<Real>& s, Real* const* memory) {
  typename Law::template PairIn<Real> only{};
  if constexpr (oneClass)
    only = onlyPair<Law, Real>(context.pairs);
  else
    gatherConstants<Law>(context, count, s);
  findDirections<Law>(count, s);
  findSlip<Law, weighted>(count, s);
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

/// Adds the columns of up to four contacts to the rows of both grains.
template <class Law, class Real>
TSUBU_INLINE void scatterFour(const PassContext& context, const std::int32_t* is, const std::int32_t* js, int count, int q, StageIn<Real>& s) {
  using R4 = Four<Real>;
  R4 f[4] = {load4(s.fx + q), load4(s.fy + q), load4(s.fz + q), R4{}}, c[4], m[4];
  transpose4(f[0], f[1], f[2], f[3]);
  if constexpr (Law::turns) {
    c[0] = load4(s.qx + q), c[1] = load4(s.qy + q), c[2] = load4(s.qz + q), c[3] = R4{};
    transpose4(c[0], c[1], c[2], c[3]);
  }
  if constexpr (Law::rolls) {
    m[0] = load4(s.mx + q), m[1] = load4(s.my + q), m[2] = load4(s.mz + q), m[3] = R4{};
    transpose4(m[0], m[1], m[2], m[3]);
  }
  for (int k = 0; k < count; ++k) {
    double* const a = &context.forces[is[k]].fx;
    double* const b = &context.forces[js[k]].fx;
    const D4 force = as<double>(f[k]);
    add4(a, force);
    subtract4(b, force);
    if constexpr (Law::rolls) {
      // T = −r Q + M, so a moment is −M/r in Q, which differs for the two.
      const D4 couple = as<double>(c[k]), moment = as<double>(m[k]);
      add4(a + 4, couple - fill4(context.rows[is[k]].inverseRadius) * moment);
      add4(b + 4, couple + fill4(context.rows[js[k]].inverseRadius) * moment);
    } else if constexpr (Law::turns) {
      const D4 couple = as<double>(c[k]);
      add4(a + 4, couple);
      add4(b + 4, couple);
    }
  }
}

/// Adds the columns to the rows of both grains, in the order of the contacts.
template <class Law, class Real>
void scatter(const PassContext& context, const std::int32_t* is, const std::int32_t* js, int count, StageIn<Real>& s) {
  int q = 0;
  for (; q + 4 <= count; q += 4) scatterFour<Law>(context, is + q, js + q, 4, q, s);
  if (q < count) scatterFour<Law>(context, is + q, js + q, count - q, q, s);
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

/// Asks for the rows of a chunk's partners; those of the first grains come in order, and the processor sees it.
TSUBU_INLINE void askFor(const PassContext& context, const std::int32_t* js, std::int64_t count) {
  for (std::int64_t q = 0; q < count; ++q) {
    const auto* const row = reinterpret_cast<const char*>(&context.rows[js[q]]);
    __builtin_prefetch(row, 0, 2);
    __builtin_prefetch(row + sizeof(GrainRow) - 1, 0, 2);
    __builtin_prefetch(&context.forces[js[q]], 1, 2);
  }
}

/// The memory of a chunk as columns in the precision of the stage: in place, or copied to the bench and back.
template <class Law, class Real>
void fetchMemory(double* from, std::size_t stride, int count, StageIn<Real>& s, Real* (&columns)[mostMemory]) {
  for (int c = 0; c < Law::stateSize; ++c) {
    double* const column = from + static_cast<std::size_t>(c) * stride;
    if constexpr (single<Real>) {
      columns[c] = s.memory[c];
      for (int q = 0; q < count; ++q) s.memory[c][q] = static_cast<Real>(column[q]);
    } else {
      columns[c] = column;
    }
  }
}
template <class Law, class Real>
void returnMemory(double* to, std::size_t stride, int count, const StageIn<Real>& s) {
  if constexpr (single<Real>) {
    for (int c = 0; c < Law::stateSize; ++c)
      for (int q = 0; q < count; ++q) to[static_cast<std::size_t>(c) * stride + static_cast<std::size_t>(q)] = s.memory[c][q];
  }
}

template <class Law, bool oneClass, bool accounts, class Real>
void passPairs(const PassContext& context, const PairRange& range, StageIn<Real>& stage, Accounts& sums) {
  for (std::int64_t first = 0; first < range.count; first += chunkSize) {
    const std::int64_t left = range.count - first;
    const int count = static_cast<int>(left < chunkSize ? left : chunkSize);
    if (context.prefetch) askFor(context, range.j + first + count, left - count < chunkSize ? left - count : chunkSize);
    Real* memory[mostMemory] = {};
    fetchMemory<Law>(range.memory + first, range.stride, count, stage, memory);
    gather<Law, oneClass>(context, range.i + first, range.j + first, count, stage);
    if (range.touch) touchSooner<Law>(range.touch + first, count, stage);
    compute<Law, oneClass, accounts, false>(context, count, stage, memory);
    if (range.touch) restoreArms<Law>(range.touch + first, count, stage);
    returnMemory<Law>(range.memory + first, range.stride, count, stage);
    if constexpr (accounts) addAccounts<Law>(count, stage, context.observed, sums);
    if (context.observed) addDeepest(count, stage, sums);
    scatter<Law>(context, range.i + first, range.j + first, count, stage);
  }
}

template <class Law, bool oneClass, bool accounts>
void passWalls(const PassContext& context, int count, Stage& stage, Accounts& sums) {
  double* memory[mostMemory];
  for (int c = 0; c < mostMemory; ++c) memory[c] = stage.memory[c];
  compute<Law, oneClass, accounts, true>(context, count, stage, memory);
  if constexpr (accounts) addAccounts<Law>(count, stage, context.observed, sums);
  if (context.observed) addDeepest(count, stage, sums);
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
