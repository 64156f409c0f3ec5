#include "scene/place_grains.h"

#include <gtest/gtest.h>

#include <numbers>

#include "scene/reader.h"
#include "scenes.h"
#include "sim/insertion/packing.h"

namespace tsubu::scene {
namespace {

std::vector<sim::Grain> placed(const std::string& source) {
  const std::string text = shortScene.substr(0, shortScene.find("[grains.bed]")) + "[grains.bed]\n" + source;
  const Scene scene = readText(text, "scene.toml");
  std::vector<sim::Grain> grains;
  placeGrains(scene, scene.grains[0], grains);
  return grains;
}

double closest(const std::vector<sim::Grain>& grains) {
  double smallest = 1e300;
  for (std::size_t i = 0; i < grains.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) smallest = std::min(smallest, (grains[i].position - grains[j].position).norm());
  }
  return smallest;
}

std::string lattice(const std::string& kind, const std::string& more = "") {
  return "source = \"lattice\"\nlattice = \"" + kind + "\"\nradius = 0.5\nbox = { min = [0, 0, 0], max = [10, 10, 10] }\n" + more;
}

// A box of ten diameters: 10 × 10 × 10 simple cubic, neighbours exactly one diameter apart.
TEST(PlaceGrains, SimpleCubicFillsTheBox) {
  const auto grains = placed(lattice("sc"));
  EXPECT_EQ(grains.size(), 1000u);
  EXPECT_DOUBLE_EQ(closest(grains), 1);
}

// Twelve nearest neighbours at the spacing for an inner grain of both close packings.
TEST(PlaceGrains, ClosePackingsHaveTwelveNeighbours) {
  for (const char* kind : {"fcc", "hcp"}) {
    SCOPED_TRACE(kind);
    const auto grains = placed(lattice(kind));
    EXPECT_NEAR(closest(grains), 1, 1e-12);
    const sim::Grain* inner = nullptr;
    for (const sim::Grain& g : grains) {
      if (!inner || (g.position - Vec3::Constant(5)).norm() < (inner->position - Vec3::Constant(5)).norm()) inner = &g;
    }
    int neighbours = 0;
    for (const sim::Grain& g : grains) neighbours += &g != inner && (g.position - inner->position).norm() < 1 + 1e-9;
    EXPECT_EQ(neighbours, 12);
  }
}

TEST(PlaceGrains, JitterNeverMakesOverlaps) {
  const auto grains = placed(lattice("hcp", "spacing = 1.2\njitter = 1\n"));
  EXPECT_GE(closest(grains), 1);
  EXPECT_LT(closest(grains), 1.19);  // but it does move them
}

// 50 g of 2500 kg/m³ is 2e-5 m³, to within half a grain of radius 2 mm.
TEST(PlaceGrains, PackingsByMassHaveTheMass) {
  const auto grains = placed(
      "source = \"packing\"\nmass = \"50 g\"\nbox = { min = [0, 0, 0], max = [0.1, 0.1, 0.1] }\nradius = { min = \"1 mm\", max = \"2 mm\" "
      "}\n");
  double volume = 0;
  for (const sim::Grain& g : grains) volume += 4.0 / 3.0 * std::numbers::pi * std::pow(g.radius, 3);
  EXPECT_NEAR(volume, 2e-5, 0.5 * 4.0 / 3.0 * std::numbers::pi * 8e-9);
}

TEST(PlaceGrains, AnotherSourceBeforeDoesNotChangeTheGrains) {
  const std::string other = "[grains.other]\nsource = \"packing\"\ncount = 5\nbox = { min = [1, 1, 1], max = [2, 2, 2] }\nradius = 0.01\n";
  const std::size_t at = shortScene.find("[grains.bed]");
  const Scene alone = readText(shortScene, "scene.toml"),
              second = readText(shortScene.substr(0, at) + other + shortScene.substr(at), "scene.toml");
  std::vector<sim::Grain> a, b;
  placeGrains(alone, alone.grains[0], a);
  placeGrains(second, second.grains[1], b);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(a[i].position, b[i].position);
}

TEST(PlaceGrains, TheSeedChangesTheGrains) {
  const Scene one = readText(shortScene, "scene.toml"), two = readText(shortScene, "scene.toml", {"simulation.seed=2"});
  std::vector<sim::Grain> a, b;
  placeGrains(one, one.grains[0], a);
  placeGrains(two, two.grains[0], b);
  EXPECT_NE(a[0].position, b[0].position);
}

}  // namespace
}  // namespace tsubu::scene
