#pragma once
// An unbounded plane wall: everything behind it is solid, so that no grain can tunnel through it.

#include "core/vec.h"

namespace tsubu::sim {

/// The plane normal·x = offset (W1). Grains live where normal·x > offset.
struct Plane {
  Vec3 normal = Vec3::UnitZ();  ///< unit
  double offset = 0;            ///< m

  /// m: positive on the side of the grains (W1).
  double signedDistance(const Vec3& point) const { return normal.dot(point) - offset; }
};

}  // namespace tsubu::sim
