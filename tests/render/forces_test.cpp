// Contact forces as round bars: as thick as the force is large, and which of them are force chains.

#include <gtest/gtest.h>

#include <cmath>

#include "scene_helpers.h"

namespace tsubu::render {
namespace {

Style forceStyle(ShownForces which) {
  Style style = plainStyle(320, 240);
  style.forces = {which, ColourMap::viridis, Range{0, 10}, 0.5};
  return style;
}

const Box around(Vec3(-3, -3, -3), Vec3(3, 3, 3));

/// Bars along x, at these heights.
Snapshot bars(std::initializer_list<std::pair<double, double>> heightsAndForces) {
  Snapshot snapshot;
  for (const auto& [z, force] : heightsAndForces) snapshot.forces.push_back({Vec3(-1, 0, z), Vec3(1, 0, z), force});
  return snapshot;
}

int coveredRows(const Image& image, double zLow, double zHigh) {
  const auto row = [](double z) { return static_cast<int>(120 - 120 / std::tan(0.3) * z / 10); };
  int rows = 0;
  for (int k = row(zHigh); k < row(zLow); ++k) rows += isBackground(image.pixel(160, k)) ? 0 : 1;
  return rows;
}

// At distance D a bar of radius R fills 2 R/√(D² − R²) of the height 2 tan(fov/2); beyond the range no bar gets thicker.
TEST(ForcePicture, ThicknessIsProportionalToTheForce) {
  for (const double force : {2.0, 5.0, 10.0, 50.0}) {
    const Image image = Renderer(forceStyle(ShownForces::all), {}, around).draw(bars({{0, force}}));
    const double r = 0.5 * std::min(1.0, force / 10), expected = 240 * r / std::sqrt(100 - r * r) / std::tan(0.3);
    EXPECT_NEAR(coveredRows(image, -2, 2), expected, 1.5 + 0.03 * expected) << force;
  }
}

// Of 2, 3 and 10 N only the last is above the mean of 5 N. What pulls is not drawn at all.
TEST(ForcePicture, ChainsAreTheForcesAboveTheMean) {
  const Snapshot snapshot = bars({{-1.2, 2}, {0, 3}, {1.2, 10}});
  const Image chains = Renderer(forceStyle(ShownForces::chains), {}, around).draw(snapshot);
  EXPECT_EQ(coveredRows(chains, -1.8, 0.6), 0);
  EXPECT_GT(coveredRows(chains, 0.6, 1.8), 10);
  const Image all = Renderer(forceStyle(ShownForces::all), {}, around).draw(snapshot);
  EXPECT_GT(coveredRows(all, -1.8, -0.6), 3);
  EXPECT_GT(coveredRows(all, -0.6, 0.6), 5);
  const Image pulls = Renderer(forceStyle(ShownForces::all), {}, around).draw(bars({{0, -4}}));
  EXPECT_EQ(coveredRows(pulls, -2, 2), 0);
  const Image none = Renderer(forceStyle(ShownForces::none), {}, around).draw(snapshot);
  EXPECT_EQ(coveredRows(none, -2, 2), 0);
}

// Without a range of its own the frame has one that holds the largest force.
TEST(ForcePicture, RangeOfTheFrameHoldsTheLargestForce) {
  Style style = forceStyle(ShownForces::all);
  style.forces.range.reset();
  for (const double force : {0.02, 10.0, 5000.0}) {
    const Image image = Renderer(style, {}, around).draw(bars({{0, force}}));
    const int whole = static_cast<int>(240 * 0.5 / std::sqrt(100 - 0.25) / std::tan(0.3));
    EXPECT_GT(coveredRows(image, -2, 2), whole / 2) << force;
    EXPECT_LE(coveredRows(image, -2, 2), whole + 2) << force;
  }
}

}  // namespace
}  // namespace tsubu::render
