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

/// Columns of velocity difference, sum of r ω and difference of ω, of four bonds. `v` and `s` point into the rows of the ends.
TSUBU_INLINE void gatherMotion(const double* const* vi, const double* const* vj, const double* const* si, const double* const* sj,
                               const double* inverseI, const double* inverseJ, int q, BondStage::Motion& to) {
  D4 v[4], s[4], w[4];
  for (int k = 0; k < 4; ++k) {
    const D4 a = load4(si[k]), b = load4(sj[k]);
    const D4 perRadiusA{inverseI[k], inverseI[k], inverseI[k], inverseI[k]}, perRadiusB{inverseJ[k], inverseJ[k], inverseJ[k], inverseJ[k]};
    v[k] = load4(vi[k]) - load4(vj[k]);
    s[k] = a + b;
    w[k] = a * perRadiusA - b * perRadiusB;
  }
  transpose4(v[0], v[1], v[2], v[3]);
  transpose4(s[0], s[1], s[2], s[3]);
  transpose4(w[0], w[1], w[2], w[3]);
  for (int c = 0; c < 3; ++c) {
    store4(to.velocity[c] + q, v[c]);
    store4(to.spinSum[c] + q, s[c]);
    store4(to.spin[c] + q, w[c]);
  }
}

template <bool damped>
TSUBU_INLINE void gatherFourBonds(const BondRows& first, const BondRows& second, const std::int32_t* is, const std::int32_t* js, int q,
                                  BondStage& s) {
  const D4 signs{-1, -1, -1, 1};
  D4 x[4];
  const double *vi[4], *vj[4], *si[4], *sj[4], *ui[4], *uj[4], *pi[4], *pj[4];
  double inverseI[4], inverseJ[4];
  for (int k = 0; k < 4; ++k) {
    const GrainRow& a = first.rows[is[k]];
    const GrainRow& b = second.rows[js[k]];
    x[k] = load4(&a.x) + signs * load4(&b.x);
    inverseI[k] = a.inverseRadius;
    inverseJ[k] = b.inverseRadius;
    vi[k] = &a.vx, vj[k] = &b.vx, si[k] = &a.sx, sj[k] = &b.sx;
    ui[k] = first.half ? &first.half[is[k]].vx : vi[k], pi[k] = first.half ? &first.half[is[k]].sx : si[k];
    uj[k] = first.half ? &second.half[js[k]].vx : vj[k], pj[k] = first.half ? &second.half[js[k]].sx : sj[k];
  }
  transpose4(x[0], x[1], x[2], x[3]);
  for (int c = 0; c < 3; ++c) store4(s.d[c] + q, x[c]);
  store4(s.radiusSum + q, x[3]);
  gatherMotion(ui, uj, pi, pj, inverseI, inverseJ, q, s.half);
  if (damped && first.half) gatherMotion(vi, vj, si, sj, inverseI, inverseJ, q, s.now);
}

TSUBU_INLINE V3 at(const BondStage::Column* columns, int q) { return {columns[0][q], columns[1][q], columns[2][q]}; }
TSUBU_INLINE void put(BondStage::Column* columns, int q, V3 v) { columns[0][q] = v.x, columns[1][q] = v.y, columns[2][q] = v.z; }
TSUBU_INLINE BondMotion at(const BondStage::Motion& motion, int q) {
  return {at(motion.velocity, q), at(motion.spinSum, q), at(motion.spin, q)};
}

template <BondDamping damping, bool breakable>
void computeBonds(const BondKind& given, BondColumns& bonds, std::size_t first, int count, double dt, const BondStage::Motion& instant, BondStage& s) {
  using Name = BondColumns;
  const BondKind kind = given;  // a copy that no store can change
  double* c[BondColumns::columns];
  for (std::size_t k = 0; k < BondColumns::columns; ++k) c[k] = bonds.column[k].data() + first;
  double* const tx = c[Name::tx];
  double* const ty = c[Name::ty];
  double* const tz = c[Name::tz];
  double* const shearT = c[Name::shearT];
  double* const shearB = c[Name::shearB];
  double* const twist = c[Name::twist];
  double* const bendT = c[Name::bendT];
  double* const bendB = c[Name::bendB];
  double* const rest = c[Name::rest];
  const double* const radius = c[Name::radius];
  const double* const stiffness = c[Name::stiffness];
  const double* const length = c[Name::length];
  const double* const critical = c[Name::critical];
  const double* const bendCritical = c[Name::bendCritical];
  TSUBU_BONDS_INDEPENDENT
  for (int q = 0; q < count; ++q) {
    BondMemory memory{{tx[q], ty[q], tz[q]}, shearT[q], shearB[q], twist[q], bendT[q], bendB[q], rest[q]};
    const BondBody body{radius[q], stiffness[q], length[q], critical[q], bendCritical[q]};
    BondMotion now{};
    if constexpr (damping == BondDamping::percent || damping == BondDamping::viscous) now = at(instant, q);
    const BondForce f = stepBond<damping, breakable>(kind, body, at(s.d, q), s.radiusSum[q], at(s.half, q), now, dt, memory);
    tx[q] = memory.t.x, ty[q] = memory.t.y, tz[q] = memory.t.z;
    shearT[q] = memory.shearT, shearB[q] = memory.shearB;
    twist[q] = memory.twist, bendT[q] = memory.bendT, bendB[q] = memory.bendB;
    if constexpr (damping == BondDamping::exponential) rest[q] = memory.rest;
    const bool holds = !breakable || f.holds;
    put(s.force, q, select(holds, f.force, {0, 0, 0}));
    put(s.couple, q, select(holds, f.arm * f.couple, {0, 0, 0}));
    put(s.moment, q, select(holds, f.moment, {0, 0, 0}));
    if constexpr (damping == BondDamping::percent || damping == BondDamping::viscous) s.loss[q] = holds ? f.loss : 0;
    if constexpr (damping == BondDamping::exponential) s.relaxed[q] = f.relaxed;
    if constexpr (breakable) s.broken[q] = holds ? 0 : 1, s.released[q] = f.released;
  }
}

inline void addToLanes(const double* column, int count, double* lane) {
  const int whole = count & ~7;
  for (int q = 0; q < whole; q += 8)
    for (int l = 0; l < 8; ++l) lane[l] += column[q + l];
  for (int q = whole; q < count; ++q) lane[q - whole] += column[q];
}

/// Three columns of four bonds as rows.
TSUBU_INLINE void toRows(const BondStage::Column* columns, int q, D4 (&rows)[4]) {
  for (int c = 0; c < 3; ++c) rows[c] = load4(columns[c] + q);
  rows[3] = D4{};
  transpose4(rows[0], rows[1], rows[2], rows[3]);
}

/// Adds the columns to the rows of both ends, in the order of the bonds. T = −r Q + M, so a moment is −M/r in Q.
inline void scatterBonds(const BondRows& first, const BondRows& second, const std::int32_t* is, const std::int32_t* js, int count,
                         const BondStage& s) {
  for (int q = 0; q < count; q += 4) {
    D4 force[4], couple[4], moment[4];
    toRows(s.force, q, force);
    toRows(s.couple, q, couple);
    toRows(s.moment, q, moment);
    const int few = count - q < 4 ? count - q : 4;
    for (int k = 0; k < few; ++k) {
      const std::int32_t i = is[q + k], j = js[q + k];
      double* const a = &first.forces[i].fx;
      double* const b = &second.forces[j].fx;
      add4(a, force[k]);
      subtract4(b, force[k]);
      add4(a + 4, couple[k] - fill4(first.rows[i].inverseRadius) * moment[k]);
      add4(b + 4, couple[k] + fill4(second.rows[j].inverseRadius) * moment[k]);
    }
  }
}

template <BondDamping damping, bool breakable>
void passBonds(const BondKind& kind, BondColumns& bonds, const BondRows& first, const BondRows& second, double dt, BondStage& stage,
               BondFindings& found) {
  constexpr bool damped = damping == BondDamping::percent || damping == BondDamping::viscous;
  const std::size_t size = bonds.size();
  for (std::size_t from = 0; from < size; from += bondChunk) {
    const int count = static_cast<int>(size - from < bondChunk ? size - from : bondChunk);
    const std::int32_t* const is = bonds.i.data() + from;
    const std::int32_t* const js = bonds.j.data() + from;
    int q = 0;
    for (; q + 4 <= count; q += 4) gatherFourBonds<damped>(first, second, is + q, js + q, q, stage);
    if (q < count) {
      std::int32_t i[4], j[4];
      for (int k = 0; k < 4; ++k) {
        const int at = q + k < count ? q + k : count - 1;
        i[k] = is[at];
        j[k] = js[at];
      }
      gatherFourBonds<damped>(first, second, i, j, q, stage);
    }
    computeBonds<damping, breakable>(kind, bonds, from, count, dt, first.half ? stage.now : stage.half, stage);
    if constexpr (damped) addToLanes(stage.loss, count, found.loss);
    if constexpr (damping == BondDamping::exponential) addToLanes(stage.relaxed, count, found.relaxed);
    if constexpr (breakable) {
      double broken = 0;
      for (q = 0; q < count; ++q) broken = larger(broken, stage.broken[q]);
      for (q = 0; broken > 0 && q < count; ++q) {
        if (stage.broken[q] == 0) continue;
        found.broken.push_back(static_cast<std::int32_t>(from) + q);
        found.released += stage.released[q];
      }
    }
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
