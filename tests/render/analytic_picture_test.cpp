// Pictures whose pixels follow from geometry: rays through pixel centres of a pinhole camera, worked out here a second time.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "scene_helpers.h"

namespace tsubu::render {
namespace {

/// The camera of plainStyle: at (0, −10, 0), looking along +y, x to the right, z up.
struct Pinhole {
  int width, height;
  double fovY = 0.6;
  Vec3 eye{0, -10, 0};

  /// Direction of the ray through the centre of a pixel, rows from the top.
  Vec3 ray(int x, int y) const {
    const double t = std::tan(0.5 * fovY), px = (2 * (x + 0.5) / width - 1) * t * width / height, pz = (1 - 2 * (y + 0.5) / height) * t;
    return Vec3(px, 1, pz).normalized();
  }

  struct Meeting {
    double distance = std::numeric_limits<double>::infinity();
    double margin = 0;  ///< how far the ray passes within the silhouette, in radii
  };
  Meeting meet(int x, int y, const Vec3& centre, double radius) const {
    const Vec3 d = ray(x, y), c = centre - eye;
    const double closest = c.dot(d), miss = (c - closest * d).norm();
    Meeting m;
    m.margin = 1 - miss / radius;
    if (closest < 0) m.margin = -1;  // behind the eye
    if (m.margin >= 0) m.distance = closest - std::sqrt(radius * radius - miss * miss);
    return m;
  }
};

/// The ellipse of every sphere, pixel by pixel; only pixels whose centre lies within 0.05 % of the silhouette may go either way.
void expectSilhouettes(const Style& style, const std::vector<std::pair<Vec3, double>>& spheres) {
  Snapshot snapshot;
  for (const auto& [centre, radius] : spheres) addGrain(snapshot, centre, radius);
  const Image image = Renderer(style, {}).draw(snapshot);
  const Pinhole pinhole{image.width, image.height, std::get<FixedCamera>(style.camera).fovY};
  int wrong = 0, covered = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      bool inside = false, undecided = false;
      for (const auto& [centre, radius] : spheres) {
        const auto meeting = pinhole.meet(x, y, centre, radius);
        inside = inside || meeting.margin > 0;
        undecided = undecided || std::abs(meeting.margin) < 5e-4;
      }
      covered += inside;
      wrong += !undecided && isBackground(image.pixel(x, y)) == inside;
    }
  }
  EXPECT_GT(covered, 50);
  EXPECT_EQ(wrong, 0);
}

TEST(AnalyticPicture, ASphereCoversItsEllipseAndNothingElse) { expectSilhouettes(plainStyle(), {{Vec3(0.3, 0, -0.4), 1.3}}); }

TEST(AnalyticPicture, FarOffTheAxisTheEllipseIsLongAndWhole) {
  Style style = plainStyle(320, 180);
  std::get<FixedCamera>(style.camera).fovY = 1.6;  // 122 degrees across: the ellipse is twice as long as wide
  expectSilhouettes(style, {{Vec3(14, -2, 4), 1.5}, {Vec3(-13, -2, -6), 1}, {Vec3(-10, -5, 0.5), 2}});
}

TEST(AnalyticPicture, AtTheEdgeOfThePictureNothingIsCutOff) {
  expectSilhouettes(plainStyle(), {{Vec3(4.2, 0, 0), 0.6}, {Vec3(0, 0, 3.2), 0.5}, {Vec3(-4, 0, -3), 1}});
}

TEST(AnalyticPicture, ASphereBesideTheEyeThatReachesBehindItIsWhole) {
  Style style = plainStyle(200, 120);
  std::get<FixedCamera>(style.camera).fovY = 1.6;
  expectSilhouettes(style, {{Vec3(3, -9.5, 0), 2.2}});
}

TEST(AnalyticPicture, InterpenetratingSpheresShowTheNearerSurface) {
  const Vec3 red(-0.4, 0, 0.1), blue(0.5, 0.3, -0.1);
  Snapshot snapshot;
  addGrain(snapshot, red, 1.2, 0);
  addGrain(snapshot, blue, 1.3, 1);
  const Image image = Renderer(plainStyle(), {}).draw(snapshot);
  const Pinhole pinhole{image.width, image.height};
  int wrong = 0, reds = 0, blues = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const auto r = pinhole.meet(x, y, red, 1.2), b = pinhole.meet(x, y, blue, 1.3);
      if (std::abs(r.margin) < 1e-3 || std::abs(b.margin) < 1e-3 || std::abs(r.distance - b.distance) < 1e-4) continue;
      if (r.margin < 0 && b.margin < 0) continue;
      const bool isNearerRed = r.distance < b.distance;
      wrong += isNearerRed != isRed(image.pixel(x, y));
      reds += isNearerRed, blues += !isNearerRed;
    }
  }
  EXPECT_GT(reds, 300);
  EXPECT_GT(blues, 300);
  EXPECT_EQ(wrong, 0);
}

TEST(AnalyticPicture, WithSeveralSamplesAPixelShowsItsShareOfTheGrain) {
  // A magenta sphere before green: more green than its highlights have, but less than the background's, is a pixel that shows both.
  Style style = plainStyle(64, 64);
  style.grains.by = ColourBy::uniform;
  style.grains.uniform = {255, 0, 255};
  Snapshot snapshot;
  addGrain(snapshot, Vec3::Zero(), 2);
  for (const auto& [quality, steps] : {std::pair(Quality::draft, 0), std::pair(Quality::normal, 1), std::pair(Quality::fine, 2)}) {
    style.picture.quality = quality;
    const Image image = Renderer(style, {}).draw(snapshot);
    int between = 0;
    for (int k = 0; k < 64 * 64; ++k) {
      const std::uint8_t* p = image.pixel(k % 64, k / 64);
      between += p[1] > 120 && p[1] < 250;
    }
    EXPECT_EQ(between > 20, steps > 0);
  }
}

TEST(AnalyticPicture, TheBackgroundIsExact) {
  Style style = plainStyle(64, 50);
  style.background = {{12, 200, 77}, {12, 200, 77}};
  for (const Quality quality : {Quality::draft, Quality::normal, Quality::fine}) {
    style.picture.quality = quality;
    const Image image = Renderer(style, {}).draw({});
    for (int k = 0; k < 64 * 50; ++k) {
      const std::uint8_t* p = image.pixel(k % 64, k / 64);
      ASSERT_TRUE(p[0] == 12 && p[1] == 200 && p[2] == 77) << k;
    }
  }
}

TEST(AnalyticPicture, TheGradientRunsFromTopToBottomWithinHalfALevelAndANoiseOfHalf) {
  Style style = plainStyle(64, 100);
  style.background = {{0, 10, 100}, {200, 20, 100}};
  const Image image = Renderer(style, {}).draw({});
  for (int y = 0; y < 100; ++y) {
    const double share = (y + 0.5) / 100;
    double mean = 0;
    for (int x = 0; x < 64; ++x) {
      const std::uint8_t* p = image.pixel(x, y);
      EXPECT_NEAR(p[0], 200 * share, 1.0);
      EXPECT_NEAR(p[1], 10 + 10 * share, 1.0);
      EXPECT_EQ(p[2], 100);
      mean += p[1] / 64.0;
    }
    EXPECT_NEAR(mean, 10 + 10 * share, 0.25) << "dithering keeps the mean";
  }
}

TEST(AnalyticPicture, AWallHidesWhatIsBehindItAndNothingElse) {
  Snapshot snapshot;
  addGrain(snapshot, Vec3(-1, 0, 0), 0.8, 0);
  addGrain(snapshot, Vec3(1, 0, 0), 0.8, 0);
  WallLook look;
  look.colour = {0, 0, 255};
  // Covers x > 0, between the eye and the grains.
  const VisibleWall wall{quadMesh({0, -2, -5}, {8, -2, -5}, {8, -2, 5}, {0, -2, 5}), look};
  const Image image = Renderer(plainStyle(), {wall}).draw(snapshot);
  EXPECT_TRUE(isRed(image.pixel(80 - 19, 60)));
  for (int y = 0; y < 120; ++y) {
    for (int x = 82; x < 160; ++x) ASSERT_TRUE(isBlue(image.pixel(x, y))) << x << ' ' << y;
  }
  EXPECT_TRUE(isBackground(image.pixel(3, 3)));
}

TEST(AnalyticPicture, AGrainInFrontOfAWallIsSeenWholeAndAWallMovesWithItsPose) {
  Snapshot snapshot;
  addGrain(snapshot, Vec3(0, 0, 0), 0.8, 0);
  WallLook look;
  look.colour = {0, 0, 255};
  const VisibleWall wall{quadMesh({-9, 0, -9}, {9, 0, -9}, {9, 0, 9}, {-9, 0, 9}), look};
  Renderer renderer(plainStyle(), {wall});
  const auto red = [&](double y) {
    snapshot.walls = {{Quat::Identity(), Vec3(0, y, 0)}};
    const Image image = renderer.draw(snapshot);
    int count = 0;
    for (int k = 0; k < 160 * 120; ++k) count += isRed(image.pixel(k % 160, k / 160));
    return count;
  };
  const int whole = red(5), half = red(0), none = red(-1);
  // Cut through its centre the sphere shows a disc of radius 0.8 at distance 10, a little smaller than its silhouette from outside.
  const double pixels = 60 / std::tan(0.3);
  EXPECT_NEAR(half, std::numbers::pi * std::pow(0.08 * pixels, 2), 12);
  EXPECT_NEAR(whole, std::numbers::pi * std::pow(0.08 * pixels, 2) / (1 - 0.0064), 12);
  EXPECT_EQ(none, 0);
}

/// Mean brightness of the left and right halves of the picture of one grain, and of its upper and lower halves.
struct Halves {
  double left = 0, right = 0, top = 0, bottom = 0;
};

Halves halvesOf(Pattern pattern, const Quat& orientation) {
  Style style = plainStyle(120, 120);
  style.light.sun = 0;
  style.grains.pattern = pattern;
  style.grains.by = ColourBy::uniform;
  style.grains.uniform = {220, 220, 220};
  Snapshot snapshot;
  addGrain(snapshot, Vec3::Zero(), 2.5, 0, orientation);
  const Image image = Renderer(style, {}).draw(snapshot);
  Halves halves;
  for (int k = 0; k < 120 * 120; ++k) {
    const int x = k % 120, y = k / 120;
    if (isBackground(image.pixel(x, y))) continue;
    const double b = brightness(image.pixel(x, y)) / 1e4;
    (x < 60 ? halves.left : halves.right) += b;
    (y < 60 ? halves.top : halves.bottom) += b;
  }
  return halves;
}

TEST(AnalyticPicture, TwoTonesTurnWithTheGrain) {
  // Light where the grain's own x is positive; the camera looks along +y with x to the right.
  const Halves still = halvesOf(Pattern::twoTone, Quat::Identity());
  EXPECT_GT(still.right, 1.2 * still.left);
  // Half a turn about z brings x to the left.
  const Halves half = halvesOf(Pattern::twoTone, Quat(Eigen::AngleAxisd(std::numbers::pi, Vec3::UnitZ())));
  EXPECT_GT(half.left, 1.2 * half.right);
  EXPECT_NEAR(half.left, still.right, 0.02 * still.right);
  // A quarter turn about z brings x to +y, away from the eye: all dark; the other way it faces the eye: all light.
  const Halves away = halvesOf(Pattern::twoTone, Quat(Eigen::AngleAxisd(0.5 * std::numbers::pi, Vec3::UnitZ())));
  const Halves towards = halvesOf(Pattern::twoTone, Quat(Eigen::AngleAxisd(-0.5 * std::numbers::pi, Vec3::UnitZ())));
  EXPECT_NEAR(away.left, still.left, 0.05 * still.left);
  EXPECT_NEAR(towards.left, half.left, 0.05 * half.left);
  // A quarter turn about −y brings x to z: light above.
  const Halves up = halvesOf(Pattern::twoTone, Quat(Eigen::AngleAxisd(-0.5 * std::numbers::pi, Vec3::UnitY())));
  const Halves down = halvesOf(Pattern::twoTone, Quat(Eigen::AngleAxisd(0.5 * std::numbers::pi, Vec3::UnitY())));
  EXPECT_GT(up.top, 1.2 * down.top);
  EXPECT_GT(down.bottom, 1.2 * up.bottom);
}

TEST(AnalyticPicture, StripesLieAcrossTheGrainsOwnAxis) {
  Style style = plainStyle(120, 120);
  style.light.sun = 0;
  style.grains.pattern = Pattern::stripes;
  style.grains.by = ColourBy::uniform;
  style.grains.uniform = {220, 220, 220};
  Snapshot snapshot;
  addGrain(snapshot, Vec3::Zero(), 2.5);
  Renderer renderer(style, {});
  const Image upright = renderer.draw(snapshot);
  snapshot.orientation[0] = Quat(Eigen::AngleAxisd(0.5 * std::numbers::pi, Vec3::UnitY()));
  const Image lying = renderer.draw(snapshot);
  // The belt is |z| < 0.24: dark at the centre row; at half height (z = 0.5) light.
  EXPECT_LT(brightness(upright.pixel(60 - 20, 60)), 0.85 * brightness(upright.pixel(60, 60 - 20)));
  EXPECT_LT(brightness(lying.pixel(60, 60 - 20)), 0.85 * brightness(lying.pixel(60 - 20, 60)));
}

TEST(AnalyticPicture, ASphereThrowsItsShadowAlongTheRaysOfTheSun) {
  Style style = plainStyle(200, 200);
  style.light.shadows = true;
  style.light.from = {1, 0, 1};  // 45 degrees from +x
  FixedCamera camera;
  camera.eye = {0, 0, 12};
  camera.up = {0, 1, 0};  // x to the right, y upwards: a map of the floor
  camera.fovY = 2 * std::atan(0.5);
  style.camera = camera;
  Snapshot snapshot;
  addGrain(snapshot, Vec3(1, 0, 2), 0.5);
  WallLook look;
  look.colour = {200, 200, 200};
  const VisibleWall floor{quadMesh({-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}), look};
  // In the bounds of the scene, and where it has left them.
  for (const Box& bounds : {Box(Vec3(-3, -3, 0), Vec3(3, 3, 3)), Box(Vec3(2, 0.5, 0), Vec3(4, 2.5, 1))}) {
    const Image image = Renderer(style, {floor}, bounds).draw(snapshot);
    const auto at = [&](double x, double y) {  // the floor spans 12 m over 200 pixels
      const auto pixel = [](double offset) { return static_cast<int>(std::lround(100 + offset * 200 / 12 - 0.5)); };
      return brightness(image.pixel(pixel(x), pixel(-y)));
    };
    // The shadow is the ellipse around (−1, 0), half as wide as long: ±0.5·√2 in x, ±0.5 in y.
    const int lit = at(-3, 0), shade = at(-1, 0);
    EXPECT_LT(shade, 0.75 * lit);
    for (const auto& [x, y] : {std::pair(-1.5, 0.0), {-0.5, 0.0}, {-1.0, 0.35}, {-1.0, -0.35}}) EXPECT_NEAR(at(x, y), shade, 0.05 * lit);
    for (const auto& [x, y] : {std::pair(-2.0, 0.0), {0.0, 0.0}, {-1.0, 0.75}, {-1.0, -0.75}}) EXPECT_NEAR(at(x, y), lit, 0.05 * lit);
  }
}

TEST(AnalyticPicture, ALitSphereHasNoShadowOnItself) {
  Style style = plainStyle(100, 100);
  style.light.from = {0.3, -1, 0.4};
  Snapshot snapshot;
  addGrain(snapshot, Vec3::Zero(), 2);
  const Image without = Renderer(style, {}).draw(snapshot);
  style.light.shadows = true;
  EXPECT_EQ(Renderer(style, {}).draw(snapshot).rgb, without.rgb);
}

TEST(AnalyticPicture, AWallThatOnlyTheSunReachesAtAGrazingAngleHasNoShadowOnItself) {
  Style style = plainStyle(120, 120);
  style.light.shadows = true;
  style.light.sky = 0;
  WallLook look;
  look.colour = {200, 200, 200};
  const VisibleWall wall{quadMesh({-9, 0, -9}, {9, 0, -9}, {9, 0, 9}, {-9, 0, 9}), look};
  for (const double degrees : {3.0, 10.0, 40.0, 80.0}) {  // of the rays above the plane
    const double a = degrees * std::numbers::pi / 180;
    style.light.from = {std::cos(a) * 0.6, -std::sin(a), std::cos(a) * 0.8};
    const Image image = Renderer(style, {wall}, Box(Vec3(-9, -1, -9), Vec3(9, 1, 9))).draw({});
    style.light.shadows = false;
    const Image open = Renderer(style, {wall}, Box(Vec3(-9, -1, -9), Vec3(9, 1, 9))).draw({});
    style.light.shadows = true;
    EXPECT_EQ(image.rgb, open.rgb) << degrees;
  }
}

TEST(AnalyticPicture, NeighboursHideTheSkyWhereTheyTouch) {
  Style style = plainStyle(200, 200);
  style.light.sun = 0;
  style.light.ambientOcclusion = true;
  style.grains.by = ColourBy::uniform;
  Snapshot snapshot;
  addGrain(snapshot, Vec3(-1, 0, 0), 1);
  addGrain(snapshot, Vec3(1, 0, 0), 1);
  const Image image = Renderer(style, {}).draw(snapshot);
  // Along the row of the centres, from the outside towards the contact, both sides get darker, and alike.
  const auto row = [&](double x) { return brightness(image.pixel(static_cast<int>(100 + x * 100 / (10 * std::tan(0.3))), 100)); };
  EXPECT_LT(row(-0.15), 0.8 * row(-1.0));
  EXPECT_LT(row(-0.05), row(-0.3));
  EXPECT_NEAR(row(-0.2), row(0.2), 12);
}

}  // namespace
}  // namespace tsubu::render
