// Orientations (docs/physics.md, I3): the loop that turns them, against the formula, on every instruction set.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>

#include "core/random.h"
#include "core/vec.h"
#include "sim/kernel/grain_kernels.h"
#include "sim/kernel/kernels.h"

namespace tsubu::sim {
namespace {

TEST(Orientation, TurnsByAnyAngleAsTheFormulaAndToTheSameBits) {
  constexpr std::array angles{0.0, 1e-12, 0.01, 0.1999, 0.2001, 0.9, std::numbers::pi, 7.0, 300.0};
  Random random(5, 2);
  const auto any = [&] { return random.uniform(-1, 1); };
  std::vector<Quat> before;
  std::vector<AngleRow> turns;
  for (int n = 0; n < 31; ++n) {
    const double w = any(), x = any(), y = any(), z = any();
    before.push_back(Quat(w, x, y, z).normalized());
    const double a = any(), b = any(), c = any();
    const Vec3 angle = angles[static_cast<std::size_t>(n) % angles.size()] * Vec3(a, b, c).normalized();
    const Eigen::Vector3f row = angle.cast<float>();
    turns.push_back({row.x(), row.y(), row.z(), 0});
  }
  std::vector<std::vector<Quat>> found;
  for (const Kernels& set : availableKernels()) {
    std::vector<Quat> now = before;
    set.grains->turn(now[0].coeffs().data(), turns.data(), static_cast<std::int64_t>(now.size()));
    found.push_back(now);
  }
  for (std::size_t n = 0; n < before.size(); ++n) {
    const Vec3 angle(turns[n].x, turns[n].y, turns[n].z);
    const double size = angle.norm();
    const Quat turn = size > 0 ? Quat(Eigen::AngleAxisd(size, angle / size)) : Quat::Identity();
    const Quat expected = turn * before[n];
    // Halving and squaring loses a bit for every halving; a quaternion and its negative are one orientation.
    EXPECT_NEAR(std::abs(found[0][n].dot(expected)), 1, 1e-15 * (4 + size)) << size;
    EXPECT_LT((found[0][n].toRotationMatrix() - expected.toRotationMatrix()).norm(), 3e-15 * (1 + size)) << size;
    EXPECT_NEAR(found[0][n].norm(), 1, 3e-16);
    for (const std::vector<Quat>& other : found) EXPECT_EQ(other[n].coeffs(), found[0][n].coeffs());
    // Alone as in company.
    Quat alone = before[n];
    kernels().grains->turn(alone.coeffs().data(), &turns[n], 1);
    EXPECT_EQ(alone.coeffs(), found[0][n].coeffs());
  }
}

}  // namespace
}  // namespace tsubu::sim
