#pragma once
// The loop over bonds: gather, compute, scatter, as for contacts (passes.h). Included by one translation unit per instruction set.

#include "sim/bonds/bond_columns.h"
#include "sim/kernel/kernels.h"
#include "sim/kernel/lanes.h"

namespace tsubu::sim {
namespace {

/// Does the damping read the motion of the instant?
template <BondDamping damping>
inline constexpr bool dampsMotion = damping == BondDamping::percent || damping == BondDamping::viscous;

TSUBU_INLINE void toColumns(D4 (&rows)[4], int q, BondStage::Column* columns, BondStage::Column& last) {
  transpose4(rows[0], rows[1], rows[2], rows[3]);
  // Not in a loop: GCC would go by way of memory.
  store4(columns[0] + q, rows[0]);
  store4(columns[1] + q, rows[1]);
  store4(columns[2] + q, rows[2]);
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
  store4(to.velocity[0] + q, v[0]);
  store4(to.velocity[1] + q, v[1]);
  store4(to.velocity[2] + q, v[2]);
  toColumns(a, q, to.surfaceI, to.perRadiusI);
  toColumns(b, q, to.surfaceJ, to.perRadiusJ);
}

template <bool damped>
TSUBU_INLINE void gatherFourBonds(const BondRows& first, const BondRows& second, const std::int32_t* is, const std::int32_t* js, int q,
                                  BondStage& s) {
  const D4 signs{-1, -1, -1, 1};
  D4 x[4];
  for (int k = 0; k < 4; ++k) x[k] = plusSigned(load4(&first.rows[is[k]].x), signs, load4(&second.rows[js[k]].x));
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
TSUBU_INLINE V3 at(double* const* columns, int q) { return {columns[0][q], columns[1][q], columns[2][q]}; }
TSUBU_INLINE void put(double* const* columns, int q, V3 v) { columns[0][q] = v.x, columns[1][q] = v.y, columns[2][q] = v.z; }

TSUBU_INLINE BondMotion at(const BondStage::Motion& motion, int q) {
  const V3 i = at(motion.surfaceI, q), j = at(motion.surfaceJ, q);
  return {at(motion.velocity, q), i + j, motion.perRadiusI[q] * i - motion.perRadiusJ[q] * j};
}
TSUBU_INLINE BondPath pathAt(const BondStage& s, int q) {
  return {s.r[q], s.perRadiusSum[q], at(s.n, q), at(s.sheared, q), at(s.turned, q), {at(s.rotation, q), s.scale[q]}};
}

/// A chunk of the columns of bonds.
struct BondChunk {
  double* column[BondColumns::columns];
  const double *radius, *length;
  const float *critical, *bendCritical;

  BondChunk(BondColumns& bonds, std::size_t first)
      : radius(bonds.radius.chunk(first)),
        length(bonds.length.chunk(first)),
        critical(bonds.critical.chunk(first)),
        bendCritical(bonds.bendCritical.chunk(first)) {
    for (std::size_t c = 0; c < BondColumns::columns; ++c) column[c] = bonds.column[c].data() + first;
  }
  TSUBU_INLINE BondMemory memory(int q) const {
    return {at(column + BondColumns::shearX, q), at(column + BondColumns::turnX, q), column[BondColumns::rest][q]};
  }
};

// The law in several loops. In one, the chain of dependent operations is longer than what a processor looks ahead, and it waits for each
// bond; most of all for roots and quotients, which end a loop therefore.

void findPaths(int count, double dt, BondStage& s) {
  TSUBU_INDEPENDENT
  for (int q = 0; q < count; ++q) {
    const BondPath path = pathOf(at(s.d, q), s.radiusSum[q], at(s.half, q), dt);
    s.r[q] = path.r, s.perRadiusSum[q] = path.perRadiusSum, s.scale[q] = path.rotation.scale;
    put(s.n, q, path.n);
    put(s.sheared, q, path.sheared);
    put(s.turned, q, path.turned);
    put(s.rotation, q, path.rotation.g);
  }
}

template <BondDamping damping, bool accounts>
void stretchBonds(const BondKind& given, const BondChunk& bonds, int count, double dt, BondStage& s) {
  constexpr bool relaxes = damping == BondDamping::exponential;
  const BondKind kind = given;  // a copy that no store can change
  double* const* const shear = bonds.column + BondColumns::shearX;
  double* const* const turn = bonds.column + BondColumns::turnX;
  double* const rest = bonds.column[BondColumns::rest];
  const double* const radius = bonds.radius;
  const double* const length = bonds.length;
  TSUBU_INDEPENDENT
  for (int q = 0; q < count; ++q) {
    BondMemory memory{at(shear, q), at(turn, q), relaxes ? rest[q] : 0};
    const BondBody body{relaxes ? radius[q] : 0, relaxes ? length[q] : 0, 0, 0};
    const double r0 = relaxes ? lengthBefore(at(s.d, q), at(s.half.velocity, q), dt) : 0;
    const double relaxed = stretchBond<damping>(kind, body, pathAt(s, q), r0, dt, memory);
    put(shear, q, memory.shear);
    put(turn, q, memory.turn);
    if constexpr (relaxes) rest[q] = memory.rest;
    if constexpr (relaxes && accounts) s.relaxed[q] = relaxed;
  }
}

/// Apart from the law: GCC would take sixteen bonds at a time where it sees single numbers, and run out of registers.
inline void widen(const float* from, int count, BondStage::Column& to) {
  TSUBU_INDEPENDENT
  for (int q = 0; q < count; ++q) to[q] = from[q];
}

/// How the ends of a bond slip. `instant`: with velocities that are not those of the step.
template <BondDamping damping, bool instant>
TSUBU_INLINE BondSlip slipAt(const BondStage& s, const BondPath& path, double dt, int q) {
  if constexpr (!dampsMotion<damping>)
    return {};
  else if constexpr (instant)
    return slipOf(path, at(s.now, q), dt);
  else
    return slipOf(path.sheared, path.turned, path.n);
}

template <BondDamping damping, bool breakable, bool accounts, bool instant>
void pullBonds(const BondKind& given, const BondChunk& bonds, int count, double dt, BondStage& s) {
  constexpr bool viscous = damping == BondDamping::viscous;
  const BondKind kind = given;
  const double* const radius = bonds.radius;
  const double* const firstLength = bonds.length;
  TSUBU_INDEPENDENT
  for (int q = 0; q < count; ++q) {
    const BondMemory memory = bonds.memory(q);
    // What does not relax still has its first length as the length at rest: a column less to read.
    const double length = damping == BondDamping::exponential ? firstLength[q] : memory.rest;
    const BondBody body{radius[q], length, viscous ? s.critical[q] : 0, viscous ? s.bendCritical[q] : 0};
    const BondPath path = pathAt(s, q);
    const BondForce f = pullBond<damping, breakable>(kind, body, memory, path, slipAt<damping, instant>(s, path, dt, q), dt);
    const bool holds = !breakable || f.holds;
    put(s.force, q, select(holds, f.force, {0, 0, 0}));
    put(s.coupleI, q, select(holds, f.couple - s.half.perRadiusI[q] * f.moment, {0, 0, 0}));
    put(s.coupleJ, q, select(holds, f.couple + s.half.perRadiusJ[q] * f.moment, {0, 0, 0}));
    if constexpr (dampsMotion<damping> && accounts) s.loss[q] = holds ? f.loss : 0;
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

/// Adds the columns of up to four bonds to the rows of both ends.
TSUBU_INLINE void scatterFourBonds(ForceRow* first, ForceRow* second, const std::int32_t* is, const std::int32_t* js, int count, int q,
                                   const BondStage& s) {
  D4 force[4], coupleI[4], coupleJ[4];
  toRows(s.force[0] + q, s.force[1] + q, s.force[2] + q, force);
  toRows(s.coupleI[0] + q, s.coupleI[1] + q, s.coupleI[2] + q, coupleI);
  toRows(s.coupleJ[0] + q, s.coupleJ[1] + q, s.coupleJ[2] + q, coupleJ);
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

/// What the springs of one bond of a chunk held half a step ago.
template <BondDamping damping>
double heldBy(const BondKind& kind, const BondBody& body, const BondMemory& memory, double dt, const BondStage& s, int q) {
  const BondStrain now = strainOf(memory, at(s.n, q), s.r[q]);
  const double r0 = lengthBefore(at(s.d, q), at(s.half.velocity, q), dt);
  const BondStrain by = strainBy(pathAt(s, q), r0);
  return springProduct(springsOf(kind, body), strainBefore<damping>(kind, now, by, dt), now);
}

/// Names the bonds of a chunk that break.
template <BondDamping damping>
void noteBroken(const BondKind& kind, const BondColumns& bonds, std::size_t from, int count, double dt, const BondStage& s,
                BondFindings& found) {
  double broken[8] = {};
  addToLanes(s.broken, count, broken);
  if (BondFindings::sum(broken) == 0) return;
  for (int q = 0; q < count; ++q) {
    if (s.broken[q] == 0) continue;
    const std::size_t k = from + static_cast<std::size_t>(q);
    found.broken.push_back(static_cast<std::int32_t>(k));
    found.released += heldBy<damping>(kind, bonds.body(k), bonds.memory(k), dt, s, q);
  }
}

/// Asks for the columns of a chunk ahead of time: they are too many streams for the processor to see.
TSUBU_INLINE void askFor(const BondChunk& bonds) {
  for (const double* const column : bonds.column)
    for (int q = 0; q < bondChunk; q += 8) __builtin_prefetch(column + q, 1, 3);
}

template <BondDamping damping, bool breakable, bool accounts>
void passBonds(const BondKind& kind, BondColumns& bonds, const BondRows& first, const BondRows& second, double dt, BondStage& stage,
               BondFindings& found) {
  const std::size_t size = bonds.size();
  for (std::size_t from = 0; from < size; from += bondChunk) {
    const int count = static_cast<int>(size - from < bondChunk ? size - from : bondChunk);
    const std::int32_t* const is = bonds.i.data() + from;
    const std::int32_t* const js = bonds.j.data() + from;
    const BondChunk chunk(bonds, from);
    if (from + 2 * bondChunk <= size) askFor({bonds, from + bondChunk});
    gatherBonds<dampsMotion<damping>>(first, second, is, js, count, stage);
    findPaths(count, dt, stage);
    stretchBonds<damping, accounts>(kind, chunk, count, dt, stage);
    if constexpr (damping == BondDamping::viscous) {
      widen(chunk.critical, count, stage.critical);
      widen(chunk.bendCritical, count, stage.bendCritical);
    }
    if (dampsMotion<damping> && first.half)
      pullBonds<damping, breakable, accounts, dampsMotion<damping>>(kind, chunk, count, dt, stage);
    else
      pullBonds<damping, breakable, accounts, false>(kind, chunk, count, dt, stage);
    if constexpr (dampsMotion<damping> && accounts) addToLanes(stage.loss, count, found.loss);
    if constexpr (damping == BondDamping::exponential && accounts) addToLanes(stage.relaxed, count, found.relaxed);
    if constexpr (breakable) noteBroken<damping>(kind, bonds, from, count, dt, stage, found);
    scatterBonds(first, second, is, js, count, stage);
  }
}

template <BondDamping damping>
BondKernel bondPassOf(BondPassKind kind) {
  if (kind.accounts) return kind.breakable ? &passBonds<damping, true, true> : &passBonds<damping, false, true>;
  return kind.breakable ? &passBonds<damping, true, false> : &passBonds<damping, false, false>;
}
BondKernel bondPassFor(BondPassKind kind) {
  switch (kind.damping) {
    case BondDamping::percent:
      return bondPassOf<BondDamping::percent>(kind);
    case BondDamping::exponential:
      return bondPassOf<BondDamping::exponential>(kind);
    case BondDamping::viscous:
      return bondPassOf<BondDamping::viscous>(kind);
    case BondDamping::none:
      break;
  }
  return bondPassOf<BondDamping::none>(kind);
}

}  // namespace
}  // namespace tsubu::sim
