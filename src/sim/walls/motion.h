#pragma once
// The prescribed rigid motion of a wall as a function of time: a plain value that knows its pose and the exact derivative of it.

#include <limits>
#include <variant>
#include <vector>

#include "core/vec.h"

namespace tsubu::sim {

/// The rigid velocity field V + Ω × (x − X) of equation W2.
struct Twist {
  Vec3 velocity = Vec3::Zero();         ///< m/s: of the material point at `origin`
  Vec3 angularVelocity = Vec3::Zero();  ///< rad/s
  Vec3 origin = Vec3::Zero();           ///< m: in the world

  /// m/s: of the wall at a point of the world (W2).
  Vec3 at(const Vec3& point) const { return velocity + angularVelocity.cross(point - origin); }
};

/// Constant velocity.
struct Translation {
  Vec3 velocity = Vec3::Zero();  ///< m/s
};

/// Constant angular velocity about an axis through a point, right-handed.
struct Rotation {
  Vec3 point = Vec3::Zero();  ///< m
  Vec3 axis = Vec3::UnitZ();  ///< any length but zero
  double angularSpeed = 0;    ///< rad/s
};

/// Displacement amplitude·(sin(2πft + phase) − sin(phase)): the motion starts where the wall was put.
struct Oscillation {
  Vec3 amplitude = Vec3::Zero();  ///< m
  double frequency = 0;           ///< Hz
  double phase = 0;               ///< rad
};

/// Angle amplitude·(sin(2πft + phase) − sin(phase)) about an axis through a point.
struct Rocking {
  Vec3 point = Vec3::Zero();  ///< m
  Vec3 axis = Vec3::UnitZ();  ///< any length but zero
  double amplitude = 0;       ///< rad
  double frequency = 0;       ///< Hz
  double phase = 0;           ///< rad
};

/// One motion with the time during which it acts: at rest in the initial pose before `start`, in the final pose from `end` on.
/// The clock of the motion starts at `start`.
struct MotionPart {
  std::variant<Translation, Rotation, Oscillation, Rocking> kind;
  double start = 0;                                      ///< s
  double end = std::numeric_limits<double>::infinity();  ///< s
};

/// A wall that stands still, or motions applied one after the other: the first moves the wall, the second moves the result.
class WallMotion {
 public:
  WallMotion() = default;
  explicit WallMotion(std::vector<MotionPart> parts);

  const std::vector<MotionPart>& parts() const { return parts_; }
  /// True when the wall never moves.
  bool still() const;

  /// Where the wall is at time t (s): world = pose.toWorld(local). Identity before anything starts.
  Pose at(double t) const;
  /// How it moves at time t (s), the derivative of at(): exactly at a start or end, the one from the right.
  Twist twistAt(double t) const;
  /// m/s: of the wall's material at a point of the world.
  Vec3 velocityAt(const Vec3& point, double t) const { return twistAt(t).at(point); }
  /// m/s: no point of `local` (frame of the wall, m) is faster than this between the times t0 and t1 (s).
  double maxSpeed(const Box& local, double t0, double t1) const;

 private:
  std::vector<MotionPart> parts_;
};

}  // namespace tsubu::sim
