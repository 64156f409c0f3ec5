// The shipped scenes, simulated for a short time and drawn small. A change of the picture is either wanted, then look at it and renew the
// golden (TSUBU_UPDATE_GOLDEN=1), or a defect. Also what every shipped scene promises: nothing lost, a ledger that closes.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "render/renderer.h"
#include "scene/build.h"
#include "scene/reader.h"
#include "sim/simulation.h"
#include "support/golden.h"

namespace tsubu {
namespace {

namespace fs = std::filesystem;

const fs::path root = TSUBU_SOURCE_DIR;
const fs::path pictures = root / "tests/golden/pictures";

struct Shot {
  std::string scene;
  double early, late;  // s
};

// Early enough to be quick, late enough for something to have happened.
const std::vector<Shot> shots{{"hopper", 0.0, 0.12}, {"avalanche", 0.0, 0.12},   {"drum", 0.0, 0.12},       {"bouncing", 0.2, 1.0},
                              {"cradle", 0.0, 0.4},  {"silo", 0.1, 0.3},         {"sediment", 0.0, 0.3},    {"brazil_nut", 0.0, 0.3},
                              {"toner", 0.0, 0.02},  {"bonded_beam", 0.0, 0.12}, {"fracture", 0.0, 0.0032}, {"kiln", 0.0, 0.4},
                              {"piston", 0.1, 0.21}};

class ShippedScene : public testing::TestWithParam<Shot> {};

void advanceTo(sim::Simulation& simulation, double time) {
  const auto target = static_cast<std::uint64_t>(std::llround(time / simulation.timeStep()));
  simulation.advance(target - simulation.steps());
}

Image drawNow(sim::Simulation& simulation, render::Renderer& renderer) {
  Snapshot snapshot;
  simulation.fill(snapshot);
  return renderer.draw(snapshot);
}

TEST_P(ShippedScene, LooksAsItDid) {
  const Shot& shot = GetParam();
  const scene::Scene scene = scene::read((root / "scenes" / (shot.scene + ".toml")).string(), {"picture.width=320", "picture.height=180"});
  scene::Built built = scene::build(scene);
  render::Renderer renderer(built.style, built.walls, built.bounds);
  sim::Simulation simulation(std::move(built.model), 2);

  advanceTo(simulation, shot.early);
  const Image early = drawNow(simulation, renderer);
  EXPECT_TRUE(test::matchesGolden(pictures / (shot.scene + "_early.png"), early, renderer.description(), TSUBU_GOLDEN_REPORTS));
  advanceTo(simulation, shot.late);
  const Image late = drawNow(simulation, renderer);
  EXPECT_TRUE(test::matchesGolden(pictures / (shot.scene + "_late.png"), late, renderer.description(), TSUBU_GOLDEN_REPORTS));

  EXPECT_FALSE(test::compareImages(early, late).reaches(test::Tier::perceptual)) << "nothing has happened";
  EXPECT_EQ(simulation.counts().lost, 0U);
  EXPECT_LT(simulation.ledger().residualFraction(), 0.005);
}

INSTANTIATE_TEST_SUITE_P(All, ShippedScene, testing::ValuesIn(shots), [](const auto& shot) { return shot.param.scene; });

// A scene that ships without a golden would change unseen.
TEST(Goldens, EveryShippedSceneHasOne) {
  std::set<std::string> shipped, shot;
  for (const auto& entry : fs::directory_iterator(root / "scenes"))
    if (entry.path().extension() == ".toml") shipped.insert(entry.path().stem().string());
  for (const Shot& each : shots) shot.insert(each.scene);
  EXPECT_EQ(shipped, shot);
}

// A tolerance so wide that different pictures pass for each other would prove nothing.
TEST(Goldens, NoTwoOfThemPassForEachOther) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(pictures)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  ASSERT_EQ(files.size(), 2 * shots.size());
  for (std::size_t a = 0; a < files.size(); ++a) {
    for (std::size_t b = a + 1; b < files.size(); ++b) {
      const test::Comparison comparison = test::compareImages(io::readPng(files[a]).image, io::readPng(files[b]).image);
      EXPECT_EQ(comparison.tier, test::Tier::different) << files[a] << " and " << files[b] << ": " << comparison.text();
    }
  }
}

Snapshot first(scene::Built& built) {
  Snapshot snapshot;
  sim::Simulation simulation(std::move(built.model), 1);
  simulation.fill(snapshot);
  return snapshot;
}

// The picture of a scene at its start, and the same with its highest grain moved up by its radius.
test::Comparison afterMovingOneGrain(const std::string& name) {
  const scene::Scene scene = scene::read((root / "scenes" / (name + ".toml")).string(), {"picture.width=320", "picture.height=180"});
  scene::Built built = scene::build(scene);
  render::Renderer renderer(built.style, built.walls, built.bounds);
  Snapshot snapshot = first(built);
  const Image before = renderer.draw(snapshot);
  const auto top =
      std::max_element(snapshot.position.begin(), snapshot.position.end(), [](const Vec3& a, const Vec3& b) { return a.z() < b.z(); });
  top->z() += snapshot.radius[static_cast<std::size_t>(top - snapshot.position.begin())];
  return test::compareImages(before, renderer.draw(snapshot));
}

// One grain, moved by one of its radii, must not pass: not even for an eye where a grain is a ball, and not for the tight tier where it
// is one of eight thousand and smaller than two pixels.
TEST(Goldens, OneGrainMovedByOneRadiusFails) {
  EXPECT_FALSE(afterMovingOneGrain("bouncing").reaches(test::Tier::perceptual));
  EXPECT_FALSE(afterMovingOneGrain("hopper").reaches(test::Tier::tight));
}

}  // namespace
}  // namespace tsubu
