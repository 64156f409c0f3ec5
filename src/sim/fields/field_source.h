#pragma once
// The fields of magnets that are not grains (docs/physics.md, F7). No function of a library but sqrt: the same bits everywhere.

#include "sim/fields/magnets.h"
#include "sim/walls/motion.h"

namespace tsubu::sim {

/// A field at a point: B, its gradient (symmetric and without trace, as a field without currents is), and how fast B changes there.
struct FieldAt {
  Vec3 field = Vec3::Zero();     ///< T
  Mat3 gradient = Mat3::Zero();  ///< T/m: ∂B_l/∂x_k in row k, column l
  Vec3 change = Vec3::Zero();    ///< T/s
};

/// Adds the field of a source that stands where it was put.
void addField(const FieldSource& source, const Vec3& x, FieldAt& sum);

/// Adds the field of a source that a wall has carried along: B turns with it, and changes as it passes by.
void addMovedField(const FieldSource& source, const Pose& pose, const Twist& twist, const Vec3& x, FieldAt& sum);

}  // namespace tsubu::sim
