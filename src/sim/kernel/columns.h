#pragma once
// How rows of grains become columns of the stage, and columns rows again: what contacts read of grains and walls, constants, memory, and
// what they do. Of each there is one for pairs in double, one for pairs in single precision and one for walls. Included where passes.h is.

#include "sim/kernel/kernels.h"
#include "sim/kernel/lanes.h"
#include "sim/laws/catalogue.h"

namespace tsubu::sim {
namespace {

template <class Real>
constexpr bool single = std::is_same_v<Real, float>;

/// What a law reads and does, as far as columns are concerned: laws of one shape share the loops that make and read them.
template <bool itTurns, bool itRolls, bool itReadsRadius>
struct ContactShape {
  static constexpr bool turns = itTurns, rolls = itRolls, readsRadius = itReadsRadius;
};
template <class Law>
using ShapeOf = ContactShape<Law::turns, Law::rolls, Law::readsRadius>;

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
  for (int k = 0; k < 4; ++k) r[k] = plusSigned(spinRow(rows[is[k]]), signs, spinRow(rows[js[k]]));
  transpose4(r[0], r[1], r[2], r[3]);
  storeColumns(r, s.rx + q, s.ry + q, s.rz + q, s.inverseInertiaSum + q);
}

/// How many contacts are gathered and scattered at once.
template <class Real>
constexpr int together = single<Real> ? 8 : 4;

/// Four contacts at once: difference and sum of the two rows (x − x', r + r'; v − v', 1/m + 1/m'; rω + r'ω', 1/r + 1/r'; ω − ω',
/// 1/(m r²) + 1/(m' r'²)), turned into columns.
template <class Shape>
TSUBU_INLINE void gatherSome(const PassContext& context, const std::int32_t* is, const std::int32_t* js, int q, Stage& s) {
  const GrainRow* const rows = context.rows;
  const D4 signs{-1, -1, -1, 1};
  D4 x[4], v[4], w[4];
  for (int k = 0; k < 4; ++k) {
    const double* const a = &rows[is[k]].x;
    const double* const b = &rows[js[k]].x;
    x[k] = plusSigned(load4(a), signs, load4(b));
    v[k] = plusSigned(load4(a + 4), signs, load4(b + 4));
    if constexpr (Shape::turns || Shape::readsRadius) w[k] = load4(a + 8) + load4(b + 8);
  }
  transpose4(x[0], x[1], x[2], x[3]);
  storeColumns(x, s.dx + q, s.dy + q, s.dz + q, s.radiusSum + q);
  transpose4(v[0], v[1], v[2], v[3]);
  storeColumns(v, s.dvx + q, s.dvy + q, s.dvz + q, s.inverseMassSum + q);
  if constexpr (Shape::turns || Shape::readsRadius) {
    transpose4(w[0], w[1], w[2], w[3]);
    storeColumns(w, s.sx + q, s.sy + q, s.sz + q, s.inverseRadiusSum + q);
  }
  if constexpr (Shape::rolls) gatherSpins(rows, is, js, q, s);
}

/// Eight contacts at once, in single precision but for the difference of the places, of which the overlap is a small part.
template <class Shape>
TSUBU_INLINE void gatherSome(const PassContext& context, const std::int32_t* is, const std::int32_t* js, int q, StageIn<float>& s) {
  const SingleRow* const rows = context.single;
  const D4 signs{-1, -1, -1, 1};
  const F8 signsOfBoth{-1, -1, -1, 1, 1, 1, 1, 1};
  F8 v[8];
  for (int h = 0; h < 8; h += 4) {
    D4 x[4];
    for (int k = 0; k < 4; ++k) {
      const SingleRow &a = rows[is[h + k]], &b = rows[js[h + k]];
      x[k] = plusSigned(load4(&a.x), signs, load4(&b.x));
      v[h + k] = plusSigned(load8(&a.vx), signsOfBoth, load8(&b.vx));
    }
    transpose4(x[0], x[1], x[2], x[3]);
    store4(s.gap + q + h, as<float>(x[3] * x[3] - (x[0] * x[0] + x[1] * x[1] + x[2] * x[2])));
    storeColumns(x, s.dx + q + h, s.dy + q + h, s.dz + q + h, s.radiusSum + q + h);
    if constexpr (Shape::rolls) gatherSpins(rows, is + h, js + h, q + h, s);
  }
  transpose8(v);
  store8(s.dvx + q, v[0]), store8(s.dvy + q, v[1]), store8(s.dvz + q, v[2]), store8(s.inverseMassSum + q, v[3]);
  if constexpr (Shape::turns) store8(s.sx + q, v[4]), store8(s.sy + q, v[5]), store8(s.sz + q, v[6]);
  if constexpr (Shape::readsRadius) store8(s.inverseRadiusSum + q, v[7]);
}

/// Columns of the stage from the rows of both grains. The columns have room for a multiple of eight: places beyond `count` repeat the
/// last contact.
template <class Shape, bool oneClass, class Real>
void gather(const PassContext& context, const std::int32_t* is, const std::int32_t* js, int count, StageIn<Real>& s) {
  const GrainRow* const rows = context.rows;
  constexpr int some = together<Real>;
  int q = 0;
  for (; q + some <= count; q += some) gatherSome<Shape>(context, is + q, js + q, q, s);
  if (q < count) {
    std::int32_t i[some], j[some];
    for (int k = 0; k < some; ++k) {
      const int from = q + k < count ? q + k : count - 1;
      i[k] = is[from];
      j[k] = js[from];
    }
    gatherSome<Shape>(context, i, j, q, s);
  }
  if (context.observed)
    for (q = 0; q < count; ++q) s.smallerRadius[q] = static_cast<Real>(smaller(rows[is[q]].radius, rows[js[q]].radius));
  if constexpr (!oneClass)
    for (q = 0; q < count; ++q)
      s.pairClass[q] = static_cast<std::int32_t>(context.material[is[q]] * context.materials + context.material[js[q]]);
}

/// Columns of the constants of each contact's pair of materials. Rows of constants are read four doubles at a time: the table has room
/// for it behind its end.
template <int size, class Real>
void gatherConstants(const PassContext& context, int count, StageIn<Real>& s) {
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
  return {fromColumns<decltype(M::tangential), Real>(columns, 0, q),
          fromColumns<decltype(M::rolling), Real>(columns, Law::tangentialSize, q),
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

/// Forces, couples and moments of four contacts as rows.
template <class Shape>
TSUBU_INLINE void forceRows(const Stage& s, int q, D4 (&f)[4], D4 (&c)[4], D4 (&m)[4]) {
  toRows(s.fx + q, s.fy + q, s.fz + q, f);
  if constexpr (Shape::turns) toRows(s.qx + q, s.qy + q, s.qz + q, c);
  if constexpr (Shape::rolls) toRows(s.mx + q, s.my + q, s.mz + q, m);
}

/// Adds the columns of up to four contacts to the rows of both grains. T = −r Q + M, so a moment is −M/r in Q, which differs for the two.
template <class Shape>
TSUBU_INLINE void scatterSome(const PassContext& context, const std::int32_t* is, const std::int32_t* js, int count, int q,
                              const Stage& s) {
  D4 f[4], c[4], m[4];
  forceRows<Shape>(s, q, f, c, m);
  ForceRow* const forces = context.forces;  // a copy that no store can change
  for (int k = 0; k < count; ++k) {
    double* const a = &forces[is[k]].fx;
    double* const b = &forces[js[k]].fx;
    add4(a, f[k]);
    subtract4(b, f[k]);
    if constexpr (Shape::rolls) {
      add4(a + 4, c[k] - fill4(context.rows[is[k]].inverseRadius) * m[k]);
      add4(b + 4, c[k] + fill4(context.rows[js[k]].inverseRadius) * m[k]);
    } else if constexpr (Shape::turns) {
      add4(a + 4, c[k]);
      add4(b + 4, c[k]);
    }
  }
}

/// The same for up to eight contacts in single precision.
template <class Shape>
TSUBU_INLINE void scatterSome(const PassContext& context, const std::int32_t* is, const std::int32_t* js, int count, int q,
                              const StageIn<float>& s) {
  const F8 opposite{-1, -1, -1, 1, 1, 1, 1, 1};
  F8 f[8] = {load8(s.fx + q), load8(s.fy + q), load8(s.fz + q)}, m[8];
  if constexpr (Shape::turns) f[4] = load8(s.qx + q), f[5] = load8(s.qy + q), f[6] = load8(s.qz + q);
  transpose8(f);
  if constexpr (Shape::rolls) {
    m[0] = m[1] = m[2] = m[3] = m[7] = F8{};
    m[4] = load8(s.mx + q), m[5] = load8(s.my + q), m[6] = load8(s.mz + q);
    transpose8(m);
  }
  SingleForceRow* const forces = context.singleForces;  // a copy that no store can change
  for (int k = 0; k < count; ++k) {
    float* const a = &forces[is[k]].fx;
    float* const b = &forces[js[k]].fx;
    if constexpr (Shape::rolls) {
      store8(a, load8(a) + (f[k] - fill8(context.single[is[k]].inverseRadius) * m[k]));
      store8(b, load8(b) + (opposite * f[k] + fill8(context.single[js[k]].inverseRadius) * m[k]));
    } else {
      store8(a, load8(a) + f[k]);
      store8(b, plusSigned(load8(b), opposite, f[k]));
    }
  }
}

/// Adds the columns to the rows of both grains, in the order of the contacts.
template <class Shape, class Real>
void scatter(const PassContext& context, const std::int32_t* is, const std::int32_t* js, int count, StageIn<Real>& s) {
  constexpr int some = together<Real>;
  int q = 0;
  for (; q + some <= count; q += some) scatterSome<Shape>(context, is + q, js + q, some, q, s);
  if (q < count) scatterSome<Shape>(context, is + q, js + q, count - q, q, s);
}

/// Columns from the rows of four grains and what the wall does where they touch.
template <class Shape>
TSUBU_INLINE void gatherFourOfWalls(const PassContext& context, const std::int32_t* grains, const WallContactRow* contacts, int q,
                                    Stage& s) {
  const D4 signs{-1, -1, -1, 1};
  D4 d[4], v[4], w[4], spin[4];
  double masses[4], radii[4];
  for (int k = 0; k < 4; ++k) {
    const GrainRow& row = context.rows[grains[k]];
    const WallContactRow& contact = contacts[k];
    d[k] = load4(&contact.dx);
    v[k] = plusSigned(load4(&row.vx), signs, load4(&contact.vx));
    radii[k] = row.radius;
    if constexpr (Shape::turns || Shape::readsRadius) w[k] = load4(&row.sx);
    if constexpr (Shape::turns) spin[k] = load4(&contact.wx);
    masses[k] = row.inverseMass;
  }
  const D4 radius{radii[0], radii[1], radii[2], radii[3]}, mass{masses[0], masses[1], masses[2], masses[3]};
  transpose4(d[0], d[1], d[2], d[3]);
  store4(s.dx + q, d[0]), store4(s.dy + q, d[1]), store4(s.dz + q, d[2]);
  store4(s.radiusSum + q, radius);
  if (context.observed) store4(s.smallerRadius + q, radius);
  transpose4(v[0], v[1], v[2], v[3]);
  store4(s.dvx + q, v[0]), store4(s.dvy + q, v[1]), store4(s.dvz + q, v[2]);
  store4(s.inverseMassSum + q, v[3]);
  if constexpr (Shape::turns || Shape::readsRadius) {
    transpose4(w[0], w[1], w[2], w[3]);
    if constexpr (Shape::readsRadius) store4(s.inverseRadiusSum + q, w[3]);
  }
  if constexpr (Shape::turns) {
    store4(s.sx + q, w[0]), store4(s.sy + q, w[1]), store4(s.sz + q, w[2]);
    transpose4(spin[0], spin[1], spin[2], spin[3]);
    const D4 half = fill4(0.5), x = w[3] * w[0], y = w[3] * w[1], z = w[3] * w[2];
    store4(s.ox + q, half * (x + spin[0])), store4(s.oy + q, half * (y + spin[1])), store4(s.oz + q, half * (z + spin[2]));
    if constexpr (Shape::rolls) {
      store4(s.rx + q, x - spin[0]), store4(s.ry + q, y - spin[1]), store4(s.rz + q, z - spin[2]);
      store4(s.inverseInertiaSum + q, mass * w[3] * w[3]);
    }
  }
}

/// The same of all contacts of a range. Places beyond its end repeat the last one.
template <class Shape>
void gatherWalls(const PassContext& context, const WallRange& range, Stage& s) {
  const int count = range.count, whole = count & ~3;
  for (int q = 0; q < whole; q += 4) gatherFourOfWalls<Shape>(context, range.grain + q, range.rows + q, q, s);
  if (whole == count) return;
  std::int32_t grains[4];
  WallContactRow rows[4];
  for (int k = 0; k < 4; ++k) {
    const int from = whole + k < count ? whole + k : count - 1;
    grains[k] = range.grain[from];
    rows[k] = range.rows[from];
  }
  gatherFourOfWalls<Shape>(context, grains, rows, whole, s);
}

/// Adds the columns of up to four contacts to the rows of their grains.
template <class Shape>
TSUBU_INLINE void scatterFourOfWalls(const PassContext& context, const std::int32_t* grains, int count, int q, const Stage& s) {
  D4 f[4], c[4], m[4];
  forceRows<Shape>(s, q, f, c, m);
  for (int k = 0; k < count; ++k) {
    if (context.singleForces) {
      D4 couple{};
      if constexpr (Shape::turns) couple = c[k];
      if constexpr (Shape::rolls) couple = couple - m[k] * fill4(context.rows[grains[k]].inverseRadius);
      float* const row = &context.singleForces[grains[k]].fx;
      store8(row, load8(row) + joined(as<float>(f[k]), as<float>(couple)));
      continue;
    }
    ForceRow& row = context.forces[grains[k]];
    add4(&row.fx, f[k]);
    if constexpr (Shape::turns) add4(&row.qx, c[k]);
    if constexpr (Shape::rolls) subtract4(&row.qx, m[k] * fill4(context.rows[grains[k]].inverseRadius));
  }
}

template <class Shape>
void scatterWalls(const PassContext& context, const WallRange& range, const Stage& s) {
  const int count = range.count, whole = count & ~3;
  for (int q = 0; q < whole; q += 4) scatterFourOfWalls<Shape>(context, range.grain + q, 4, q, s);
  if (whole < count) scatterFourOfWalls<Shape>(context, range.grain + whole, count - whole, whole, s);
}

/// The memory of wall contacts lies in rows, since contacts come and go one by one.
template <int size>
void fetchWallMemory(const WallRange& range, Stage& s) {
  for (int q = 0; q < range.count; ++q)
    for (int c = 0; c < size; ++c) s.memory[c][q] = range.memory[range.at[q] * size + c];
}
template <int size>
void returnWallMemory(const WallRange& range, const Stage& s) {
  for (int q = 0; q < range.count; ++q)
    for (int c = 0; c < size; ++c) range.memory[range.at[q] * size + c] = s.memory[c][q];
}

}  // namespace
}  // namespace tsubu::sim
