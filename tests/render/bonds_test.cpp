// Bonds as round bars: where their outline falls, what hides what, how their colour tells the load, and how a break fades.

#include <gtest/gtest.h>

#include <cmath>

#include "render/colour_map.h"
#include "scene_helpers.h"

namespace tsubu::render {
namespace {

Style bondStyle() {
  Style style = plainStyle(320, 240);
  style.bonds.shown = true;
  return style;
}

Snapshot barOf(double radius, double load = 0, double sinceBroken = -1) {
  Snapshot snapshot;
  snapshot.bonds.push_back({Vec3(-1, 0, 0), Vec3(1, 0, 0), radius, load, sinceBroken});
  return snapshot;
}

int coveredRows(const Image& image, int column) {
  int rows = 0;
  for (int row = 0; row < image.height; ++row) rows += isBackground(image.pixel(column, row)) ? 0 : 1;
  return rows;
}

// At distance D a bar of radius R fills 2 R/√(D² − R²) of the height 2 tan(fov/2); a polygon of few corners a little less.
TEST(BondPicture, IsAsThickAsItShouldBe) {
  for (const double radius : {0.2, 0.5, 1.0}) {
    Style style = bondStyle();
    style.bonds.scale = 0.8;
    const Image image = Renderer(style, {}, Box(Vec3(-3, -3, -3), Vec3(3, 3, 3))).draw(barOf(radius));
    const double r = 0.8 * radius, expected = 240 * r / std::sqrt(100 - r * r) / std::tan(0.3);
    EXPECT_NEAR(coveredRows(image, 160), expected, 1.5 + 0.03 * expected) << radius;
    EXPECT_EQ(coveredRows(image, 5), 0);
  }
}

TEST(BondPicture, IsHiddenByGrainsBeforeItAndHidesThoseBehind) {
  Snapshot snapshot = barOf(0.3);
  addGrain(snapshot, Vec3(-0.6, -1, 0), 0.3, 0);
  addGrain(snapshot, Vec3(0.6, 2, 0), 0.3, 0);
  const Image image = Renderer(bondStyle(), {}).draw(snapshot);
  const auto column = [](double x, double y) { return static_cast<int>(160 + 120 / std::tan(0.3) * x / (10 + y)); };
  EXPECT_TRUE(isRed(image.pixel(column(-0.6, -1), 120)));
  EXPECT_FALSE(isRed(image.pixel(column(0.6, 2), 120)) && image.pixel(column(0.6, 2), 120)[0] > 2 * image.pixel(column(0.6, 2), 120)[1]);
  Style style = bondStyle();
  style.bonds.shown = false;
  const Image without = Renderer(style, {}).draw(snapshot);
  EXPECT_TRUE(isRed(without.pixel(column(0.6, 2), 120)));
  EXPECT_TRUE(isBackground(without.pixel(160, 120)));
}

TEST(BondPicture, ColourTellsTheLoad) {
  Style style = bondStyle();
  style.bonds.map = ColourMap::viridis;
  style.bonds.range = Range{0, 0.5};
  Renderer renderer(style, {});
  const auto hue = [&](double load) {
    const Image image = renderer.draw(barOf(0.5, load));
    const std::uint8_t* p = image.pixel(160, 120);
    return Vec3(p[0], p[1], p[2]).normalized();
  };
  const auto expected = [](double t) {
    const Vec3 light = toLinear(mapped(ColourMap::viridis, t));
    return light.normalized();
  };
  // Light has little hue of its own: what is shown is nearest to its own place on the map.
  for (const double load : {0.0, 0.2, 0.4}) {
    const auto asSeen = [&](const Vec3& c) { return Vec3(c.array().pow(1 / 2.2)).normalized(); };
    const Vec3 seen = hue(load);
    const double own = (seen - asSeen(expected(2 * load))).norm();
    for (const double other : {0.0, 0.2, 0.4}) {
      EXPECT_LE(own, (seen - asSeen(expected(2 * other))).norm()) << load << " " << other;
    }
  }
  EXPECT_EQ(renderer.draw(barOf(0.5, 0.5)).rgb, renderer.draw(barOf(0.5, 7)).rgb);  // beyond the range is its end
}

TEST(BondPicture, ABreakShrinksUntilItIsGone) {
  Style style = bondStyle();
  style.bonds.brokenFor = 2e-3;
  Renderer renderer(style, {}, Box(Vec3(-3, -3, -3), Vec3(3, 3, 3)));
  int before = 1000;
  for (const double age : {0.0, 0.5e-3, 1e-3, 1.5e-3}) {
    const Image image = renderer.draw(barOf(0.5, 0, age));
    const int rows = coveredRows(image, 160);
    EXPECT_GT(rows, 0);
    EXPECT_LT(rows, before);
    EXPECT_TRUE(isRed(image.pixel(160, 120)));
    before = rows;
  }
  EXPECT_EQ(coveredRows(renderer.draw(barOf(0.5, 0, 2e-3)), 160), 0);
}

TEST(BondPicture, GrainsCanBeSmallOrLeftOut) {
  Snapshot snapshot;
  addGrain(snapshot, Vec3(0, 0, 0), 1, 0);
  Style style = bondStyle();
  const int whole = coveredRows(Renderer(style, {}).draw(snapshot), 160);
  style.grains.scale = 0.5;
  const int half = coveredRows(Renderer(style, {}).draw(snapshot), 160);
  EXPECT_NEAR(half, 0.5 * whole, 2);
  style.grains.shown = false;
  EXPECT_EQ(coveredRows(Renderer(style, {}, Box(Vec3(-3, -3, -3), Vec3(3, 3, 3))).draw(snapshot), 160), 0);
}

TEST(BondPicture, ThrowsAShadow) {
  Style style = bondStyle();
  style.light.shadows = true;
  style.light.from = {0, 0, 1};
  std::get<FixedCamera>(style.camera).eye = {0, -10, 4};
  WallLook look;
  look.colour = {200, 200, 200};
  const VisibleWall floor{quadMesh({-4, -4, -1}, {4, -4, -1}, {4, 4, -1}, {-4, 4, -1}), look};
  const Box bounds(Vec3(-4, -4, -2), Vec3(4, 4, 2));
  Renderer renderer(style, {floor}, bounds);
  const Image with = renderer.draw(barOf(0.3)), without = renderer.draw(Snapshot{});
  int darker = 0;
  for (int row = 0; row < 240; ++row)
    if (brightness(with.pixel(160, row)) < brightness(without.pixel(160, row)) - 60) ++darker;
  EXPECT_GT(darker, 5);
}

}  // namespace
}  // namespace tsubu::render
