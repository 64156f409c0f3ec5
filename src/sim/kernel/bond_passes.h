#pragma once
// The loop over bonds: gather, compute, scatter, as for contacts (passes.h). Included by one translation unit per instruction set.

#include "sim/bonds/bond_columns.h"
#include "sim/kernel/kernels.h"
#include "sim/kernel/lanes.h"

#if defined(__clang__)
#define TSUBU_BONDS_INDEPENDENT _Pragma("clang loop vectorize(assume_safety)")
#else
#define TSUBU_BONDS_INDEPENDENT _Pragma("GCC ivdep")
#endif

namespace tsubu::sim {
namespace {

/// Does the damping read the motion of the instant?
template <BondDamping damping>
inline constexpr bool dampsMotion = damping == BondDamping::percent || damping == BondDamping::viscous;

TSUBU_INLINE void toColumns(D4 (&rows)[4], int q, BondStage::Column* columns, BondStage::Column& last) {
  transpose4(rows[0], rows[1], rows[2], rows[3]);
  for (int c = 0; c < 3; ++c) store4(columns[c] + q, rows[c]);
  store4(last + q, rows[3]);
}

/// How four bonds move. Velocities and spins come from the half-step rows where there are such, 1/r from the rows of the grains.
template <bool fromHalf>
TSUBU_INLINE void gatherMotion(const BondRows& first, const BondRows& second, const std::int32_t* is, const std::int32_t* js, int q,
                               BondStage::Motion& to) {
  D4 v[4], a[4], b[4];
  for (int k = 0; k < 4; ++k) {
    const GrainRow& i = first.rows[is[k]];
    const GrainRow& j = second.rows[js[k]];
    if constexpr (fromHalf) {
      const HalfStepRow& halfI = first.half[is[k]];
      const HalfStepRow& halfJ = second.half[js[k]];
      v[k] = load4(&halfI.vx) - load4(&halfJ.vx);
      a[k] = withFourth(load4(&halfI.sx), load4(&i.sx));
      b[k] = withFourth(load4(&halfJ.sx), load4(&j.sx));
    } else {
      v[k] = load4(&i.vx) - load4(&j.vx);
      a[k] = load4(&i.sx);
      b[k] = load4(&j.sx);
    }
  }
  transpose4(v[0], v[1], v[2], v[3]);
  for (int c = 0; c < 3; ++c) store4(to.velocity[c] + q, v[c]);
  toColumns(a, q, to.surfaceI, to.perRadiusI);
  toColumns(b, q, to.surfaceJ, to.perRadiusJ);
}

template <bool damped>
TSUBU_INLINE void gatherFourBonds(const BondRows& first, const BondRows& second, const std::int32_t* is, const std::int32_t* js, int q,
                                  BondStage& s) {
  const D4 signs{-1, -1, -1, 1};
  D4 x[4];
  for (int k = 0; k < 4; ++k) x[k] = load4(&first.rows[is[k]].x) + signs * load4(&second.rows[js[k]].x);
  toColumns(x, q, s.d, s.radiusSum);
  if (!first.half) return gatherMotion<false>(first, second, is, js, q, s.half);
  gatherMotion<true>(first, second, is, js, q, s.half);
  if constexpr (damped) gatherMotion<false>(first, second, is, js, q, s.now);
}

/// Columns of the stage from the rows of both ends. Places beyond `count`, up to a multiple of four, repeat the last bond.
template <bool damped>
void gatherBonds(const BondRows& first, const BondRows& second, const std::int32_t* is, const std::int32_t* js, int count, BondStage& s) {
  int q = 0;
  for (; q + 4 <= count; q += 4) gatherFourBonds<damped>(first, second, is + q, js + q, q, s);
  if (q == count) return;
  std::int32_t i[4], j[4];
  for (int k = 0; k < 4; ++k) {
    const int at = q + k < count ? q + k : count - 1;
    i[k] = is[at];
    j[k] = js[at];
  }
  gatherFourBonds<damped>(first, second, i, j, q, s);
}

TSUBU_INLINE V3 at(const BondStage::Column* columns, int q) { return {columns[0][q], columns[1][q], columns[2][q]}; }
TSUBU_INLINE void put(BondStage::Column* columns, int q, V3 v) { columns[0][q] = v.x, columns[1][q] = v.y, columns[2][q] = v.z; }
TSUBU_INLINE BondMotion at(const BondStage::Motion& motion, int q) {
  const V3 i = at(motion.surfaceI, q), j = at(motion.surfaceJ, q);
  return {at(motion.velocity, q), i + j, motion.perRadiusI[q] * i - motion.perRadiusJ[q] * j};
}

TSUBU_INLINE BondAxis axisAt(const BondStage& s, int q) { return {at(s.n0, q), at(s.n, q), s.r0[q], s.r[q], s.perRadiusSum[q]}; }
TSUBU_INLINE BondStrain strainAt(const BondStage::Column* c, int q) { return {c[0][q], c[1][q], c[2][q], c[3][q], c[4][q], c[5][q]}; }
TSUBU_INLINE void put(BondStage::Column* c, int q, const BondStrain& a) {
  c[0][q] = a.stretch, c[1][q] = a.shearT, c[2][q] = a.shearB, c[3][q] = a.twist, c[4][q] = a.bendT, c[5][q] = a.bendB;
}

/// A chunk of the columns of bonds.
struct BondChunk {
  double* column[BondColumns::columns];

  BondChunk(BondColumns& bonds, std::size_t first) {
    for (std::size_t c = 0; c < BondColumns::columns; ++c) column[c] = bonds.column[c].data() + first;
  }
};

// The law in four loops. In one, the chain of dependent operations is longer than what a processor looks ahead, and it waits for each bond.

void findAxes(int count, double dt, BondStage& s) {
  TSUBU_BONDS_INDEPENDENT
  for (int q = 0; q < count; ++q) {
    const BondAxis axis = axisOf(at(s.d, q), s.radiusSum[q], at(s.half.velocity, q), dt);
    put(s.n0, q, axis.n0);
    put(s.n, q, axis.n);
    s.r0[q] = axis.r0, s.r[q] = axis.r;
    s.perRadiusSum[q] = axis.perRadiusSum;
  }
}

void turnFrames(const BondChunk& bonds, int count, double dt, BondStage& s) {
  double* const tx = bonds.column[BondColumns::tx];
  double* const ty = bonds.column[BondColumns::ty];
  double* const tz = bonds.column[BondColumns::tz];
  TSUBU_BONDS_INDEPENDENT
  for (int q = 0; q < count; ++q) {
    const BondFrame frame = turned({tx[q], ty[q], tz[q]}, axisAt(s, q), at(s.half.surfaceI, q) + at(s.half.surfaceJ, q), dt);
    tx[q] = frame.t.x, ty[q] = frame.t.y, tz[q] = frame.t.z;
    put(s.b, q, frame.b);
    put(s.sumT, q, frame.sumT);
    put(s.sumB, q, frame.sumB);
  }
}

template <BondDamping damping, bool keepsBefore>
void stretchBonds(const BondKind& given, const BondChunk& bonds, int count, double dt, BondStage& s) {
  using Name = BondColumns;
  const BondKind kind = given;  // a copy that no store can change
  double* const shearT = bonds.column[Name::shearT];
  double* const shearB = bonds.column[Name::shearB];
  double* const twist = bonds.column[Name::twist];
  double* const bendT = bonds.column[Name::bendT];
  double* const bendB = bonds.column[Name::bendB];
  double* const rest = bonds.column[Name::rest];
  TSUBU_BONDS_INDEPENDENT
  for (int q = 0; q < count; ++q) {
    BondMemory memory{{}, shearT[q], shearB[q], twist[q], bendT[q], bendB[q], rest[q]};
    const BondStrain before = stretchBond<damping>(kind, axisAt(s, q), at(s.sumT, q), at(s.sumB, q), at(s.half, q), dt, memory);
    shearT[q] = memory.shearT, shearB[q] = memory.shearB;
    twist[q] = memory.twist, bendT[q] = memory.bendT, bendB[q] = memory.bendB;
    if constexpr (damping == BondDamping::exponential) rest[q] = memory.rest;
    if constexpr (keepsBefore) put(s.before, q, before);
  }
}

template <BondDamping damping, bool breakable>
void pullBonds(const BondKind& given, const BondChunk& bonds, int count, double dt, const BondStage::Motion& instant, BondStage& s) {
  using Name = BondColumns;
  constexpr bool relaxes = damping == BondDamping::exponential;
  const BondKind kind = given;
  const auto& c = bonds.column;
  TSUBU_BONDS_INDEPENDENT
  for (int q = 0; q < count; ++q) {
    const BondMemory memory{{c[Name::tx][q], c[Name::ty][q], c[Name::tz][q]}, c[Name::shearT][q], c[Name::shearB][q],
                            c[Name::twist][q], c[Name::bendT][q], c[Name::bendB][q], c[Name::rest][q]};
    // What does not relax still has its first length as the length at rest: a column less to read.
    const double length = relaxes ? c[Name::length][q] : memory.rest;
    const BondBody body{c[Name::radius][q], c[Name::stiffness][q], length, c[Name::critical][q], c[Name::bendCritical][q]};
    const BondForce f = pullBond<damping, breakable>(kind, body, memory, relaxes ? strainAt(s.before, q) : BondStrain{}, at(s.n, q), at(s.b, q),
                                                     s.r[q], s.perRadiusSum[q], dampsMotion<damping> ? at(instant, q) : BondMotion{}, dt);
    const bool holds = !breakable || f.holds;
    put(s.force, q, select(holds, f.force, {0, 0, 0}));
    put(s.coupleI, q, select(holds, f.couple - s.half.perRadiusI[q] * f.moment, {0, 0, 0}));
    put(s.coupleJ, q, select(holds, f.couple + s.half.perRadiusJ[q] * f.moment, {0, 0, 0}));
    if constexpr (dampsMotion<damping>) s.loss[q] = holds ? f.loss : 0;
    if constexpr (relaxes) s.relaxed[q] = f.relaxed;
    if constexpr (breakable) s.broken[q] = holds ? 0 : 1;
  }
}

/// In registers: what is stored would have to be waited for before the next is added to it.
inline void addToLanes(const double* column, int count, double* lane) {
  const int whole = count & ~7;
  D4 low = load4(lane), high = load4(lane + 4);
  for (int q = 0; q < whole; q += 8) {
    low += load4(column + q);
    high += load4(column + q + 4);
  }
  store4(lane, low);
  store4(lane + 4, high);
  for (int q = whole; q < count; ++q) lane[q - whole] += column[q];
}

/// Three columns of four bonds as rows.
TSUBU_INLINE void toRows(const BondStage::Column* columns, int q, D4 (&rows)[4]) {
  for (int c = 0; c < 3; ++c) rows[c] = load4(columns[c] + q);
  rows[3] = D4{};
  transpose4(rows[0], rows[1], rows[2], rows[3]);
}

/// Adds the columns of up to four bonds to the rows of both ends.
TSUBU_INLINE void scatterFourBonds(ForceRow* first, ForceRow* second, const std::int32_t* is, const std::int32_t* js, int count, int q,
                                   const BondStage& s) {
  D4 force[4], coupleI[4], coupleJ[4];
  toRows(s.force, q, force);
  toRows(s.coupleI, q, coupleI);
  toRows(s.coupleJ, q, coupleJ);
  for (int k = 0; k < count; ++k) {
    double* const a = &first[is[k]].fx;
    double* const b = &second[js[k]].fx;
    add4(a, force[k]);
    subtract4(b, force[k]);
    add4(a + 4, coupleI[k]);
    add4(b + 4, coupleJ[k]);
  }
}

/// Adds the columns to the rows of both ends, in the order of the bonds.
inline void scatterBonds(const BondRows& first, const BondRows& second, const std::int32_t* is, const std::int32_t* js, int count,
                         const BondStage& s) {
  ForceRow* const i = first.forces;  // copies that no store can change
  ForceRow* const j = second.forces;
  int q = 0;
  for (; q + 4 <= count; q += 4) scatterFourBonds(i, j, is + q, js + q, 4, q, s);
  if (q < count) scatterFourBonds(i, j, is + q, js + q, count - q, q, s);
}

/// Names the bonds of a chunk that break.
inline void noteBroken(const BondKind& kind, const BondColumns& bonds, std::size_t from, int count, const BondStage& s, BondFindings& found) {
  double broken[8] = {};
  addToLanes(s.broken, count, broken);
  if (BondFindings::sum(broken) == 0) return;
  for (int q = 0; q < count; ++q) {
    if (s.broken[q] == 0) continue;
    const std::size_t k = from + static_cast<std::size_t>(q);
    found.broken.push_back(static_cast<std::int32_t>(k));
    found.released += springProduct(springsOf(bonds.body(k), kind.shearOverNormal), strainAt(s.before, q), strainOf(bonds.memory(k), s.r[q]));
  }
}

/// Asks for the columns of a chunk ahead of time: they are too many streams for the processor to see.
template <BondDamping damping>
TSUBU_INLINE void askFor(const BondChunk& bonds) {
  for (int c = 0; c < BondColumns::columns; ++c) {
    if (c == BondColumns::length && damping != BondDamping::exponential) continue;
    if ((c == BondColumns::critical || c == BondColumns::bendCritical) && !dampsMotion<damping>) continue;
    for (int q = 0; q < bondChunk; q += 8) __builtin_prefetch(bonds.column[c] + q, 1, 3);
  }
}

template <BondDamping damping, bool breakable>
void passBonds(const BondKind& kind, BondColumns& bonds, const BondRows& first, const BondRows& second, double dt, BondStage& stage,
               BondFindings& found) {
  constexpr bool relaxes = damping == BondDamping::exponential;
  const std::size_t size = bonds.size();
  for (std::size_t from = 0; from < size; from += bondChunk) {
    const int count = static_cast<int>(size - from < bondChunk ? size - from : bondChunk);
    const std::int32_t* const is = bonds.i.data() + from;
    const std::int32_t* const js = bonds.j.data() + from;
    const BondChunk chunk(bonds, from);
    if (from + 2 * bondChunk <= size) askFor<damping>({bonds, from + bondChunk});
    gatherBonds<dampsMotion<damping>>(first, second, is, js, count, stage);
    findAxes(count, dt, stage);
    turnFrames(chunk, count, dt, stage);
    stretchBonds<damping, breakable || relaxes>(kind, chunk, count, dt, stage);
    pullBonds<damping, breakable>(kind, chunk, count, dt, first.half ? stage.now : stage.half, stage);
    if constexpr (dampsMotion<damping>) addToLanes(stage.loss, count, found.loss);
    if constexpr (relaxes) addToLanes(stage.relaxed, count, found.relaxed);
    if constexpr (breakable) noteBroken(kind, bonds, from, count, stage, found);
    scatterBonds(first, second, is, js, count, stage);
  }
}

BondKernel bondPassFor(BondDamping damping, bool breakable) {
  const auto pick = [breakable]<BondDamping d>() -> BondKernel { return breakable ? &passBonds<d, true> : &passBonds<d, false>; };
  switch (damping) {
    case BondDamping::percent:
      return pick.template operator()<BondDamping::percent>();
    case BondDamping::exponential:
      return pick.template operator()<BondDamping::exponential>();
    case BondDamping::viscous:
      return pick.template operator()<BondDamping::viscous>();
    case BondDamping::none:
      break;
  }
  return pick.template operator()<BondDamping::none>();
}

}  // namespace
}  // namespace tsubu::sim
