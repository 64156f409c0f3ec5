#pragma once
// How grains lie in memory. A contact needs everything about both partners, so a grain is one row and not a line in many arrays:
// two cache lines fetch it whole. r ω instead of ω keeps the radius out of the slip velocity; the couple of a contact then adds the
// same number to both partners (docs/architecture.md, "The step").

#include "sim/laws/arithmetic.h"

namespace tsubu::sim {

/// What contacts read of a grain. `v` and `s` are the velocities that contacts see (docs/physics.md, I1).
struct alignas(32) GrainRow {
  double x, y, z;        ///< centre, m
  double radius;         ///< m
  double vx, vy, vz;     ///< m/s
  double inverseMass;    ///< 1/kg
  double sx, sy, sz;     ///< r ω, m/s
  double inverseRadius;  ///< 1/m

  TSUBU_INLINE V3 position() const { return {x, y, z}; }
  TSUBU_INLINE V3 velocity() const { return {vx, vy, vz}; }
  TSUBU_INLINE V3 surfaceSpin() const { return {sx, sy, sz}; }
};

/// What contacts do to a grain: F, and the couple Q with torque T = −r Q.
struct alignas(64) ForceRow {
  double fx, fy, fz, unused0;
  double qx, qy, qz, unused1;
};

/// Mixed precision: what contacts between grains read, one cache line. Differences of places are taken in double.
struct alignas(64) SingleRow {
  double x, y, z, radius;
  float vx, vy, vz, inverseMass;
  float sx, sy, sz, inverseRadius;
};

/// Mixed precision: what contacts between grains do to a grain.
struct alignas(32) SingleForceRow {
  float fx, fy, fz, unused0;
  float qx, qy, qz, unused1;
};

/// Velocities half a step before the positions: velocity Verlet's own (docs/physics.md, I2).
struct alignas(64) HalfStepRow {
  double vx, vy, vz, unused0;
  double sx, sy, sz, unused1;
};

/// An angle as a vector, rad. Small: single numbers tell it to 1e-7 of itself.
struct alignas(16) AngleRow {
  float x, y, z, unused;
};

/// A place, m.
struct alignas(32) PlaceRow {
  double x, y, z, unused;
};

}  // namespace tsubu::sim
