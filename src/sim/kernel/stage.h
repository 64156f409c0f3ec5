#pragma once
// The bench on which contacts are worked: a chunk of them, gathered from the grains' rows into columns that fit the first-level
// cache, computed as vectors, and scattered back. Several small loops beat one long one (docs/performance.md).

#include <cstdint>

#include "sim/laws/memory.h"

namespace tsubu::sim {

inline constexpr int chunkSize = 128;

/// Most doubles that any law keeps for a pair of materials.
inline constexpr int mostConstants = 16;

/// Column by column, one entry per contact of the chunk. `Real`: what contacts are computed in.
template <class Real>
struct alignas(64) StageIn {
  using Column = Real[chunkSize];

  // In, for every law: differences i − j and sums i + j of the two rows. With friction (dx, dy, dz) becomes the direction n.
  Column dx, dy, dz, radiusSum;
  Column dvx, dvy, dvz, inverseMassSum;
  Column gap;  // single precision: (r_i + r_j)² − |x_ij|², subtracted in double: the overlap is a small difference
  // In, for laws with friction.
  Column sx, sy, sz;        // r_i ω_i + r_j ω_j
  Column ox, oy, oz;        // walls: the mean spin ½(ω_i + Ω)
  Column inverseRadiusSum;  // 1/r_i + 1/r_j, for laws that read R*
  // In, for rolling laws.
  Column rx, ry, rz;         // ω_i − ω_j
  Column inverseInertiaSum;  // 1/(m_i r_i²) + 1/(m_j r_j²)
  // In, when observed: the smaller radius. In, for walls: the share of a face in a contact that several faces carry.
  Column smallerRadius, weight;
  Column armScale;  // of pairs that touch sooner or later than their radii say; only when there are such
  // In, when there is more than one class of pairs: row × column of the materials, and the constants of that pair.
  std::int32_t pairClass[chunkSize];
  Column constants[mostConstants];

  // On the way.
  Column overlap, effectiveMass, rootMass, effectiveRadius;
  Column perDistance;  // without friction: what makes n of (dx, dy, dz)
  Column separationSpeed, frameSpin;
  Column perRadiusSum, arm;  // 1/(r_i + r_j); distance over that sum, the share of its radius at which each grain is touched

  // Out: force on i, couple (same on both), moment on i.
  Column fx, fy, fz, qx, qy, qz, mx, my, mz;
  // Out, when the ledger is kept: see Accounts.
  Column account[8];

  // Memory of wall contacts, gathered here; that of pairs is read in place.
  Column memory[mostMemory];
};
using Stage = StageIn<double>;

/// What the ledger takes from a pass. Eight lanes, whatever the width of the vectors: the order of the sums is fixed.
struct Accounts {
  enum Kind { storedNormal, storedTangential, storedRolling, normal, tangential, friction, rolling, overlap, kinds };

  double lane[kinds][8] = {};

  double sum(Kind kind) const {
    double total = 0;
    for (double part : lane[kind]) total += part;
    return total;
  }
  /// For `overlap`: the deepest overlap over the smaller radius.
  double deepest() const {
    double most = 0;
    for (double part : lane[overlap]) most = part > most ? part : most;
    return most;
  }
};

}  // namespace tsubu::sim
