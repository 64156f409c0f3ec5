#include "scene/pace.h"

#include <gtest/gtest.h>

#include "scene/reader.h"

namespace tsubu::scene {
namespace {

const std::string pouring = R"(
[simulation]
end = "95 ms"
safety = 0.4
limit = "spectral"
[materials.sand]
density = 2500
[pairs]
normal_stiffness = "2 kN/m"
restitution = 0.8
friction = 0.5
[grains.sand]
source = "packing"
box = { min = [0, 0, "1 mm"], max = ["6 mm", "6 mm", "4 cm"] }
count = 80
radius = { min = "0.9 mm", max = "1.1 mm" }
[walls.floor]
plane = {}
[walls.left]
plane = { normal = [1, 0, 0] }
[walls.right]
plane = { point = ["6 mm", 0, 0], normal = [-1, 0, 0] }
[walls.front]
plane = { normal = [0, 1, 0] }
[walls.back]
plane = { point = [0, "6 mm", 0], normal = [0, -1, 0] }
[output]
ledger_interval = "2 ms"
frame_interval = "10 ms"
)";

struct Gone {
  std::uint64_t hash, steps;
  std::vector<double> rows, frames;
  Pace pace;
};

Gone go(const Scene& scene, int threads, std::uint64_t portion, bool look) {
  Built built = build(scene);
  Gone gone{0, 0, {}, {}, Pace(built.plan)};
  sim::Simulation sim(std::move(built.model), threads);
  for (;;) {
    if (gone.pace.rowDue()) gone.rows.push_back(sim.time());
    if (gone.pace.frameDue()) gone.frames.push_back(sim.time());
    if (gone.pace.ended()) break;
    do {
      gone.pace.advance(sim, portion);
      if (look) sim.ledger();
    } while (gone.pace.underWay());
  }
  gone.hash = sim.stateHash();
  gone.steps = sim.steps();
  return gone;
}

// Outputs come at their times whatever the steps are, and neither threads nor onlookers change a bit.
TEST(Pace, FollowsTheNetwork) {
  const Scene scene = readText(pouring, "pouring.toml");
  const Gone one = go(scene, 1, 1000, false), two = go(scene, 2, 37, true);
  EXPECT_EQ(one.hash, two.hash);
  EXPECT_EQ(one.steps, two.steps);
  ASSERT_EQ(one.rows.size(), 49u);  // 0, 2 … 94 and 95 ms
  ASSERT_EQ(one.frames.size(), 10u);
  for (std::size_t k = 0; k < 48; ++k) EXPECT_NEAR(one.rows[k], 2e-3 * static_cast<double>(k), 1e-12);
  EXPECT_NEAR(one.rows.back(), 0.095, 1e-5);
  EXPECT_LT(one.pace.shortest(), 0.9 * one.pace.longest());
  EXPECT_LE(one.pace.shortest(), 0.4 * one.pace.limit().step);
  EXPECT_NE(one.pace.limit().by.find("contacts"), std::string::npos) << one.pace.limit().by;
  const Gone packing = go(readText(pouring, "pouring.toml", {"simulation.limit=packing"}), 1, 1000, false);
  EXPECT_LT(one.steps, packing.steps);
  EXPECT_EQ(packing.rows.size(), 49u);
}

}  // namespace
}  // namespace tsubu::scene
