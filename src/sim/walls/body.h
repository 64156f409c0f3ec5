#pragma once
// A wall with a will, as the scene tells it (docs/physics.md, W4; moving_wall.h moves it).

#include "core/vec.h"

namespace tsubu::sim {

/// A wall of a mass that moves under load along an axis.
struct WallBody {
  Vec3 axis = Vec3::UnitZ();  ///< any length but zero
  double mass = 0;            ///< kg, positive
  double force = 0;           ///< N, from outside, along the axis
  bool weight = true;         ///< does gravity act on it?
  double damping = 0;         ///< kg/s: of the guide
  double velocity = 0;        ///< m/s along the axis, when it is let go
  double start = 0;           ///< s: it is held before

  bool operator==(const WallBody&) const = default;
};

}  // namespace tsubu::sim
