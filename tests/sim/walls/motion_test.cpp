// Prescribed motions: closed forms, and the twist as the derivative of the pose.

#include "sim/walls/motion.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/error.h"
#include "shapes.h"

namespace tsubu::sim::test {
namespace {

constexpr double tau = 2 * std::numbers::pi;

std::vector<WallMotion> someMotions() {
  const MotionPart slide{Translation{{0.1, -0.2, 0.3}}};
  const MotionPart turn{Rotation{{0.1, 0.2, 0.3}, {1, 1, 0}, 3}};
  const MotionPart shake{Oscillation{{0.01, 0, 0.02}, 5, 0.4}};
  const MotionPart rock{Rocking{{-0.1, 0, 0}, {0, 2, 1}, 0.3, 2, 1}};
  const MotionPart late{Rotation{{0, 0.5, 0}, {0, 0, 1}, -2}, 0.35, 0.8};
  return {WallMotion({slide}), WallMotion({turn}),        WallMotion({shake}),       WallMotion({rock}),
          WallMotion({late}),  WallMotion({turn, shake}), WallMotion({shake, turn}), WallMotion({rock, slide, late, turn, shake})};
}

TEST(Motion, StandsStillByDefault) {
  const WallMotion motion;
  EXPECT_TRUE(motion.still());
  EXPECT_EQ(motion.at(3).translation, Vec3::Zero());
  EXPECT_EQ(motion.velocityAt(Vec3::Ones(), 3), Vec3::Zero());
  EXPECT_TRUE(WallMotion({{Rotation{}, 0, 1}}).still());
  EXPECT_TRUE(WallMotion({{Translation{Vec3::UnitX()}, 2, 2}}).still());
  EXPECT_FALSE(WallMotion({{Translation{Vec3::UnitX()}, 2, 3}}).still());
}

TEST(Motion, TranslatesBetweenStartAndEnd) {
  const WallMotion motion({{Translation{{2, 0, 0}}, 1, 3}});
  const auto x = [&](double t) { return motion.at(t).translation.x(); };
  EXPECT_EQ(x(0.5), 0);
  EXPECT_NEAR(x(1.5), 1, 1e-15);
  EXPECT_NEAR(x(99), 4, 1e-15);
  EXPECT_EQ(motion.velocityAt(Vec3::Zero(), 0.9).x(), 0);
  EXPECT_EQ(motion.velocityAt(Vec3::Zero(), 1).x(), 2);  // from the right
  EXPECT_EQ(motion.velocityAt(Vec3::Zero(), 3).x(), 0);
}

TEST(Motion, RotatesAboutItsPoint) {
  const WallMotion motion({{Rotation{{1, 0, 0}, {0, 0, 3}, tau / 4}}});
  const Pose pose = motion.at(1);  // a quarter turn
  EXPECT_NEAR((pose.toWorld({1, 0, 0}) - Vec3(1, 0, 0)).norm(), 0, 1e-15);
  EXPECT_NEAR((pose.toWorld({2, 0, 0}) - Vec3(1, 1, 0)).norm(), 0, 1e-15);
  EXPECT_NEAR((motion.velocityAt({1, 1, 0}, 1) - Vec3(-tau / 4, 0, 0)).norm(), 0, 1e-15);
}

TEST(Motion, OscillatesFromWhereTheWallIs) {
  const WallMotion motion({{Oscillation{{0, 0, 0.002}, 50, 0.3}}});
  EXPECT_EQ(motion.at(0).translation, Vec3::Zero());
  const double t = 0.0123, phase = tau * 50 * t + 0.3;
  EXPECT_NEAR(motion.at(t).translation.z(), 0.002 * (std::sin(phase) - std::sin(0.3)), 1e-15);
  EXPECT_NEAR(motion.velocityAt(Vec3::Zero(), t).z(), 0.002 * tau * 50 * std::cos(phase), 1e-12);
}

TEST(Motion, PartsApplyOneAfterTheOther) {
  // Shaken along x, then turned by a quarter: shaken along y.
  const WallMotion motion({{Oscillation{{0.1, 0, 0}, 1, 0}}, {Rotation{Vec3::Zero(), Vec3::UnitZ(), tau / 4}, 0, 1}});
  const Vec3 origin = motion.at(1.25).toWorld(Vec3::Zero());
  EXPECT_NEAR((origin - Vec3(0, 0.1, 0)).norm(), 0, 1e-15);
  EXPECT_NEAR((motion.velocityAt(origin, 1.5) - Vec3(0, -0.1 * tau, 0)).norm(), 0, 1e-12);
}

TEST(Motion, TwistIsTheDerivativeOfThePose) {
  const double h = 1e-5;
  for (const WallMotion& motion : someMotions()) {
    for (double t = 0.013; t < 1; t += 0.05) {  // no start or end within h
      for (const Vec3& local : {Vec3(0, 0, 0), Vec3(0.3, 0.1, -0.2), Vec3(-1, 2, 0.5)}) {
        const Vec3 expected = (motion.at(t + h).toWorld(local) - motion.at(t - h).toWorld(local)) / (2 * h);
        // Central differences err by h²/6 of the third derivative, at most (2π·5)³·0.02 and some for the sum.
        EXPECT_NEAR((motion.velocityAt(motion.at(t).toWorld(local), t) - expected).norm(), 0, 1e-7);
      }
    }
  }
}

TEST(Motion, MaxSpeedBoundsEveryPoint) {
  const Box box(Vec3(-0.1, -0.2, -0.3), Vec3(0.4, 0.5, 0.6));
  Random random(6, 6);
  for (const WallMotion& motion : someMotions()) {
    for (const auto& [t0, t1] : {std::pair{0.0, 0.2}, {0.3, 0.4}, {0.9, 1.0}, {0.0, 1.0}}) {
      const double bound = motion.maxSpeed(box, t0, t1);
      double fastest = 0;
      for (int i = 0; i < 2000; ++i) {
        const double t = random.uniform(t0, t1);
        fastest = std::max(fastest, motion.velocityAt(motion.at(t).toWorld(randomIn(random, box.min(), box.max())), t).norm());
      }
      EXPECT_LE(fastest, bound * (1 + 1e-12));
    }
  }
  EXPECT_EQ(WallMotion({{Translation{{1, 0, 0}}, 2, 3}}).maxSpeed(box, 0, 1.9), 0);
  EXPECT_EQ(WallMotion({{Translation{{1, 0, 0}}, 2, 3}}).maxSpeed(box, 0, 2.1), 1);
}

TEST(Motion, RefusesWhatCannotMove) {
  EXPECT_THROW(WallMotion({{Rotation{Vec3::Zero(), Vec3::Zero(), 1}}}), Error);
  EXPECT_THROW(WallMotion({{Translation{}, 3, 2}}), Error);
}

}  // namespace
}  // namespace tsubu::sim::test
