// Opaque, translucent, wire, hidden: what each look shows of what is behind it.

#include <gtest/gtest.h>

#include "scene_helpers.h"

namespace tsubu::render {
namespace {

/// A blue pane 4 m wide across the view at y = −2, before a red grain.
Image behindPane(WallStyle wallStyle, double opacity = 0.3) {
  Snapshot snapshot;
  addGrain(snapshot, Vec3(0, 0, 0), 1, 0);
  WallLook look;
  look.style = wallStyle;
  look.colour = {0, 0, 255};
  look.opacity = opacity;
  const VisibleWall pane{quadMesh({-2, -2, -2}, {2, -2, -2}, {2, -2, 2}, {-2, -2, 2}), look};
  return Renderer(plainStyle(), {pane}).draw(snapshot);
}

TEST(WallLook, HiddenIsNotThere) {
  Snapshot snapshot;
  addGrain(snapshot, Vec3(0, 0, 0), 1, 0);
  EXPECT_EQ(behindPane(WallStyle::hidden).rgb, Renderer(plainStyle(), {}).draw(snapshot).rgb);
}

TEST(WallLook, OpaqueHides) { EXPECT_TRUE(isBlue(behindPane(WallStyle::opaque).pixel(80, 60))); }

TEST(WallLook, TranslucentTintsByItsOpacity) {
  const Image without = behindPane(WallStyle::hidden);
  const Image thin = behindPane(WallStyle::translucent, 0.1), thick = behindPane(WallStyle::translucent, 0.6);
  const int x = 80, y = 60;
  const double red = without.pixel(x, y)[0];
  // Face on, the pane lets 1 − opacity of the encoded colour through and adds its own, which is blue with a seventh of white.
  EXPECT_NEAR(thin.pixel(x, y)[0], 0.9 * red + 0.1 * 255 / 7, 5);
  EXPECT_NEAR(thick.pixel(x, y)[0], 0.4 * red + 0.6 * 255 / 7, 5);
  EXPECT_GT(thick.pixel(x, y)[2], thin.pixel(x, y)[2] + 60);
  EXPECT_TRUE(isBackground(thin.pixel(3, 3)));
}

TEST(WallLook, TwoPanesTintMoreThanOneInEitherOrder) {
  WallLook look;
  look.style = WallStyle::translucent;
  look.colour = {0, 0, 255};
  look.opacity = 0.3;
  const VisibleWall pane{quadMesh({-2, 0, -2}, {2, 0, -2}, {2, 0, 2}, {-2, 0, 2}), look};
  Snapshot snapshot;
  snapshot.walls = {{Quat::Identity(), Vec3(0, -2, 0)}, {Quat::Identity(), Vec3(0, 2, 0)}};
  const Image two = Renderer(plainStyle(), {pane, pane}).draw(snapshot);
  std::swap(snapshot.walls[0], snapshot.walls[1]);
  const Image swapped = Renderer(plainStyle(), {pane, pane}).draw(snapshot);
  EXPECT_EQ(two.rgb, swapped.rgb);
  const double own = 255.0 / 7;  // green of a pane
  EXPECT_NEAR(two.pixel(80, 60)[1], (255 * 0.7 + own * 0.3) * 0.7 + own * 0.3, 5);
}

TEST(WallLook, APaneBehindAGrainDoesNotTintIt) {
  Snapshot snapshot;
  addGrain(snapshot, Vec3(0, 0, 0), 1, 0);
  snapshot.walls = {{Quat::Identity(), Vec3(0, 5, 0)}};
  WallLook look;
  look.style = WallStyle::translucent;
  look.colour = {0, 0, 255};
  const VisibleWall pane{quadMesh({-2, 0, -2}, {2, 0, -2}, {2, 0, 2}, {-2, 0, 2}), look};
  const Image image = Renderer(plainStyle(), {pane}).draw(snapshot), bare = Renderer(plainStyle(), {}).draw(snapshot);
  EXPECT_EQ(image.pixel(80, 60)[0], bare.pixel(80, 60)[0]);
  EXPECT_EQ(image.pixel(80, 60)[2], bare.pixel(80, 60)[2]);
}

TEST(WallLook, WireDrawsTheBorderAndNotTheDiagonal) {
  const Image image = behindPane(WallStyle::wire), bare = behindPane(WallStyle::hidden);
  int changed = 0, inside = 0;
  const double half = 2 / (8 * std::tan(0.3)) * 60;  // of the pane, in pixels
  for (int y = 0; y < 120; ++y) {
    for (int x = 0; x < 160; ++x) {
      const bool differs = !std::equal(image.pixel(x, y), image.pixel(x, y) + 3, bare.pixel(x, y));
      changed += differs;
      inside += differs && std::max(std::abs(x + 0.5 - 80), std::abs(y + 0.5 - 60)) < half - 2;
    }
  }
  EXPECT_GT(changed, 8 * half * 0.9);
  EXPECT_LT(changed, 8 * half * 4);
  EXPECT_EQ(inside, 0);
}

TEST(WallLook, AGroundFadesIntoTheBackground) {
  Style style = plainStyle();
  FixedCamera camera;
  camera.eye = {0, -10, 2};
  style.camera = camera;
  WallLook look;
  look.ground = true;
  look.colour = {120, 60, 60};
  const VisibleWall ground{quadMesh({-900, -900, -1}, {900, -900, -1}, {900, 900, -1}, {-900, 900, -1}), look};
  const Image image = Renderer(style, {ground}).draw({});
  EXPECT_GT(image.pixel(80, 118)[0], 60) << "near: its own colour";
  EXPECT_TRUE(isBackground(image.pixel(80, 24))) << "just below the horizon, which is in row 21: background";
}

TEST(WallLook, GrainsDarkenTheWallTheyTouch) {
  Style style = plainStyle(200, 200);
  style.light.sun = 0;
  style.light.ambientOcclusion = true;
  FixedCamera camera;
  camera.eye = {0, -10, 5};
  style.camera = camera;
  Snapshot snapshot;
  addGrain(snapshot, Vec3(0, 0, 0.5), 0.5);
  const VisibleWall floor{quadMesh({-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}), WallLook{}};
  const Image with = Renderer(style, {floor}).draw(snapshot), without = Renderer(style, {floor}).draw({});
  // Half a radius before the contact's rim, at (0, −0.75, 0), which falls on row 110, the grain hides 16 % of the sky: hiddenBy with
  // distance 0.9 m and height 0.5 m, nearly unfaded. That is 7 % in encoded brightness. Five radii to the side nothing changes.
  EXPECT_LT(brightness(with.pixel(100, 110)), 0.96 * brightness(without.pixel(100, 110)));
  EXPECT_GT(brightness(with.pixel(100, 110)), 0.86 * brightness(without.pixel(100, 110)));
  EXPECT_EQ(brightness(with.pixel(160, 110)), brightness(without.pixel(160, 110)));
}

}  // namespace
}  // namespace tsubu::render
