#pragma once
// The vectors and rotations that every module speaks of. SI units throughout.

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace tsubu {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Quat = Eigen::Quaterniond;

/// Axis-aligned box, [lower, upper] in metres.
using Box = Eigen::AlignedBox3d;

/// A rigid placement: world = rotation * local + translation.
struct Pose {
  Quat rotation = Quat::Identity();
  Vec3 translation = Vec3::Zero();

  Vec3 toWorld(const Vec3& local) const { return rotation * local + translation; }
  Vec3 toLocal(const Vec3& world) const { return rotation.conjugate() * (world - translation); }
};

}  // namespace tsubu
