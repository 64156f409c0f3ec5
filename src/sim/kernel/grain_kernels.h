#pragma once
// The inner loops that know no law: moving grains, and finding the pairs that are near. Chosen with the others (kernels.h).

#include <cstdint>
#include <limits>

#include "sim/grain_rows.h"
#include "sim/scheme.h"

namespace tsubu::sim {

/// The columns of the state that moving grains reads and writes; null where the scheme or the scene has none.
struct MoveContext {
  GrainRow* rows;
  ForceRow* forces;
  SingleRow* single;
  SingleForceRow* singleForces;
  HalfStepRow* half;
  PlaceRow* previous;
  AngleRow* turned;
  const float* perSkin2;  ///< 1/m²
  V3 gravity;             ///< m/s²
  double dt;              ///< s
};

/// What a pass over grains finds.
struct Motion {
  double fastest2 = 0;  ///< (m/s)²: the largest squared speed
  double travel2 = 0;   ///< largest (distance moved in the step / radius)²; NaN counts as infinite
  double haste2 = 0;    ///< 1/s²: largest (speed / skin)²

  /// A grain goes with the square of this speed; `scale`: Δt/r.
  TSUBU_INLINE void add(double speed2, double scale, double perSkin2) {
    const double hasteOfGrain2 = speed2 * perSkin2;
    haste2 = hasteOfGrain2 > haste2 ? hasteOfGrain2 : haste2;
    fastest2 = speed2 > fastest2 ? speed2 : fastest2;
    addTravel(speed2 * scale * scale);
  }
  TSUBU_INLINE void addTravel(double way2) {
    if (!(way2 <= travel2)) travel2 = way2 == way2 ? way2 : std::numeric_limits<double>::infinity();
  }
};

/// Which variant of the loop: do grains turn; is it kept how far; have they single rows to be kept up to date; do the single force rows
/// act, and not the others?
struct MoveKind {
  bool turns, keepsOrientation, mixed, bySingle;
};

/// Moves grains [first, last) by one step (docs/physics.md, I1–I6) and clears their forces.
using MoveKernel = Motion (*)(const MoveContext&, std::int32_t first, std::int32_t last);

/// Turns orientations (x, y, z, w in a row each) of `count` grains by these angles (docs/physics.md, I3).
using TurnKernel = void (*)(double* orientations, const AngleRow* angles, std::int64_t count);

/// Which of `count` pairs are nearer than the sum of their radii and this share of their skins (m): their places, in order. `kept` has room
/// for `count` rounded up to a multiple of four. Returns how many.
template <class Row>
using NearKernel = std::int64_t (*)(const Row* rows, const float* skins, double share, const std::int32_t* i, const std::int32_t* j,
                                    std::int64_t count, std::int32_t* kept);

/// Balls in columns, in which each has a place. The columns may be read for seven more balls beyond the last.
struct BallColumns {
  const double *x, *y, *z, *radius;  ///< m
  const std::int32_t* number;
};

/// Balls that follow each other in the columns.
struct BallRun {
  std::int32_t first, last;
};

/// Writes the numbers of those balls of the runs that are nearer to a ball at (x, y, z) than the sum of the radii and have a number above
/// `after`: in their order, to `found`, which has room for all of them and seven more. Returns how many.
using NearBallsKernel = std::int64_t (*)(const BallColumns& balls, const BallRun* runs, int count, const double (&ball)[4],
                                         std::int32_t after, std::int32_t* found);

/// The loops for one instruction set.
struct GrainKernels {
  MoveKernel (*move)(Integrator scheme, MoveKind kind);  ///< all but Runge–Kutta
  TurnKernel turn;
  NearBallsKernel nearBalls;
  NearKernel<GrainRow> nearPairs;
  NearKernel<SingleRow> nearSinglePairs;  ///< mixed precision: places and radii are the same
};

}  // namespace tsubu::sim
