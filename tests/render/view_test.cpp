#include "render/view.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace tsubu::render {
namespace {

/// Place on the picture, −1 to 1 from left to right and from bottom to top.
Eigen::Vector2d onPicture(const View& view, const Vec3& world) {
  const Vec3 p = view.toView(world);
  return {p.x() / (-p.z() * view.tanX), p.y() / (-p.z() * view.tanY)};
}

TEST(View, LooksAtTheTargetWithUpUpwards) {
  FixedCamera camera;
  camera.eye = {3, -4, 5};
  camera.target = {1, 1, 1};
  const View view = viewAt(camera, 0, 1.5, Box());
  EXPECT_LT(onPicture(view, camera.target).norm(), 1e-12);
  const Eigen::Vector2d above = onPicture(view, camera.target + Vec3(0, 0, 0.1));
  EXPECT_NEAR(above.x(), 0, 1e-12);
  EXPECT_GT(above.y(), 0);
  EXPECT_LT((view.rotation * view.rotation.transpose() - Mat3::Identity()).norm(), 1e-12);
  EXPECT_NEAR(view.rotation.determinant(), 1, 1e-12);
  EXPECT_NEAR(view.tanX, 1.5 * view.tanY, 1e-12);
}

TEST(View, LooksStraightDownWithoutTrouble) {
  FixedCamera camera;
  camera.eye = {0, 0, 5};
  const View view = viewAt(camera, 0, 1, Box());
  EXPECT_TRUE(view.rotation.allFinite());
  EXPECT_NEAR(view.rotation.determinant(), 1, 1e-12);
  EXPECT_LT(onPicture(view, Vec3::Zero()).norm(), 1e-12);
}

TEST(View, AnAutomaticCameraHoldsTheBoundsWithinItsMargin) {
  const Box boxes[] = {Box(Vec3(0, 0, 0), Vec3(1, 1, 1)), Box(Vec3(-5, 2, 1), Vec3(5, 2.1, 9)), Box(Vec3(0, 0, 0), Vec3(100, 1, 0.1)),
                       Box(Vec3(-1e-3, 0, 0), Vec3(1e-3, 1e-4, 2e-3))};
  for (const Box& box : boxes) {
    for (const double aspect : {0.6, 1.0, 16.0 / 9}) {
      for (const double azimuth : {-2.0, 0.0, 1.0}) {
        AutoCamera camera;
        camera.azimuth = azimuth;
        const View view = viewAt(camera, 0, aspect, box);
        double reach = 0;
        for (int k = 0; k < 8; ++k) {
          reach = std::max(reach, onPicture(view, box.corner(static_cast<Box::CornerType>(k))).lpNorm<Eigen::Infinity>());
        }
        EXPECT_NEAR(reach, 1 - 2 * camera.margin, 1e-9) << "all within, and no farther away than needed";
      }
    }
  }
}

TEST(View, AnOrbitGoesRoundAtItsAngularVelocity) {
  OrbitCamera camera;
  camera.target = {1, 2, 3};
  camera.distance = 5;
  camera.elevation = 0.3;
  camera.azimuth = 0;
  camera.angularVelocity = 0.5;
  for (const double time : {0.0, 1.0, std::numbers::pi}) {
    const View view = viewAt(camera, time, 1, Box());
    const Vec3 from = view.eye - camera.target;
    EXPECT_NEAR(from.norm(), 5, 1e-12);
    EXPECT_NEAR(std::asin(from.z() / 5), 0.3, 1e-12);
    EXPECT_NEAR(std::atan2(from.y(), from.x()), 0.5 * time, 1e-12);
  }
}

KeyFrameCamera threeFrames() {
  KeyFrameCamera camera;
  camera.frames = {
      {0, {0, -10, 0}, {0, 0, 0}, {0, 0, 1}, 0.5}, {1, {5, -8, 2}, {1, 0, 0}, {0, 0, 1}, 0.6}, {3, {10, 0, 5}, {0, 0, 2}, {0, 0, 1}, 0.4}};
  return camera;
}

TEST(View, KeyFramesAreMetAndHeldAtTheEnds) {
  const KeyFrameCamera camera = threeFrames();
  for (const KeyFrame& frame : camera.frames) {
    const View view = viewAt(camera, frame.time, 1, Box());
    EXPECT_LT((view.eye - frame.eye).norm(), 1e-12);
    EXPECT_NEAR(view.tanY, std::tan(0.5 * frame.fovY), 1e-12);
    EXPECT_LT(onPicture(view, frame.target).norm(), 1e-12);
  }
  EXPECT_EQ(viewAt(camera, -7, 1, Box()).eye, camera.frames.front().eye);
  EXPECT_EQ(viewAt(camera, 99, 1, Box()).eye, camera.frames.back().eye);
}

TEST(View, BetweenKeyFramesTheEyeMovesWithoutJerks) {
  const KeyFrameCamera camera = threeFrames();
  const auto eye = [&](double t) { return viewAt(camera, t, 1, Box()).eye; };
  const double h = 1e-5;
  for (const double t : {0.0, 1.0, 3.0}) {
    const Vec3 before = (eye(t) - eye(t - h)) / h, after = (eye(t + h) - eye(t)) / h;
    EXPECT_LT((before - after).norm(), 1e-3) << t;
  }
  // The tangent at the middle frame is the central difference (10, 10, 5)/3 of its neighbours.
  EXPECT_LT(((eye(1 + h) - eye(1 - h)) / (2 * h) - Vec3(10, 10, 5) / 3).norm(), 1e-3);
}

}  // namespace
}  // namespace tsubu::render
