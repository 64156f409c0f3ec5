#include "core/vec.h"

#include <gtest/gtest.h>

#include <numbers>

namespace tsubu {
namespace {

constexpr double rounding = 1e-15;

TEST(Pose, IsTheIdentityUnlessToldOtherwise) {
  const Vec3 point(1, -2, 3);
  EXPECT_EQ(Pose{}.toWorld(point), point);
  EXPECT_EQ(Pose{}.toLocal(point), point);
}

TEST(Pose, RotatesFirstAndThenTranslates) {
  const Pose pose{Quat(Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitZ())), Vec3(10, 0, 0)};
  EXPECT_LT((pose.toWorld(Vec3::UnitX()) - Vec3(10, 1, 0)).norm(), rounding);
  EXPECT_LT((pose.toLocal(Vec3(10, 1, 0)) - Vec3::UnitX()).norm(), rounding);
}

TEST(Pose, ToLocalUndoesToWorld) {
  const Pose pose{Quat(Eigen::AngleAxisd(1.1, Vec3(1, 2, 3).normalized())), Vec3(-0.3, 0.7, 0.2)};
  const Vec3 point(0.4, -0.5, 0.6);
  EXPECT_LT((pose.toLocal(pose.toWorld(point)) - point).norm(), rounding);
  EXPECT_LT((pose.toWorld(pose.toLocal(point)) - point).norm(), rounding);
}

TEST(Pose, KeepsDistances) {
  const Pose pose{Quat(Eigen::AngleAxisd(-2.5, Vec3(0, 1, 1).normalized())), Vec3(5, 6, 7)};
  const Vec3 a(0.1, 0.2, 0.3), b(-0.4, 0.5, 0.25);
  EXPECT_NEAR((pose.toWorld(a) - pose.toWorld(b)).norm(), (a - b).norm(), 16 * rounding);
}

}  // namespace
}  // namespace tsubu
