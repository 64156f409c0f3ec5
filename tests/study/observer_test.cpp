#include "study/observer.h"

#include <cmath>
#include <numbers>

#include "scenes.h"
#include "study/measure.h"

namespace tsubu::study {
namespace {

/// Ten grains one above the other that fall through a counter, one every 10 ms: grain k is g t_k²/2 above it, t_k = 0.1 s + 10 ms k.
std::string falling(const std::string& observe) {
  std::string places;
  for (int k = 0; k < 10; ++k)
    places += (k ? ", " : "") + std::string("[0, 0, ") + std::to_string(0.5 * 9.81 * std::pow(0.1 + 0.01 * k, 2)) + "]";
  return R"(
[simulation]
end = 0.3
[materials.ball]
density = 1200
[pairs]
normal_stiffness = 1000
restitution = 0.5
friction = 0.4
[grains.drops]
source = "list"
radius = "1 mm"
positions = [)" +
         places + R"(]
[walls.far]
plane = { point = [0, 0, -10] }
[counters.gate]
point = [0, 0, 0]
[output]
frame_interval = "10 ms"
ledger_interval = "0.5 ms"
[observe]
)" + observe;
}

Outcome measured(const std::string& text) {
  const Folder folder("observer");
  const auto outcome = run({folder.file("scene.toml", text), {}});
  EXPECT_TRUE(outcome && outcome->complete());
  return *outcome;
}

TEST(Observer, CountersOfFallingDrops) {
  const Outcome o = measured(falling(R"(
rate = { kind = "discharge_rate", counter = "gate", from = 0.1, to = 0.19 }
half = { kind = "time_to_empty", counter = "gate", share = 0.5 }
never = { kind = "time_to_empty", box = { min = [-1, -1, -20], max = [1, 1, 1] }, share = 0.5 }
box = { kind = "time_to_empty", box = { min = [-1, -1, 0], max = [1, 1, 1] }, share = 0.8 }
)"));
  EXPECT_NEAR(valueOf(o, "rate"), 100, 3);
  EXPECT_NEAR(valueOf(o, "half"), 0.14, 6e-4);
  EXPECT_NEAR(valueOf(o, "box"), 0.17, 6e-4);
  EXPECT_TRUE(std::isnan(valueOf(o, "never")));
}

TEST(Observer, FreeFall) {
  const Outcome o = measured(falling(R"(
down = { kind = "centre_of_mass", axis = [0, 0, -2] }
front = { kind = "run_out", direction = [0, 0, -1], share = 1 }
motion = { kind = "kinetic_energy" }
overlap = { kind = "largest_overlap" }
residual = { kind = "energy_residual" }
same = { kind = "centre_of_mass", axis = [0, 0, -1], material = "ball" }
)"));
  double mean = 0;
  for (int k = 0; k < 10; ++k) mean += 0.05 * 9.81 * std::pow(0.1 + 0.01 * k, 2);
  const double drop = 0.5 * 9.81 * 0.09, mass = 10 * 1200 * 4.0 / 3 * std::numbers::pi * 1e-9;
  EXPECT_NEAR(valueOf(o, "down"), drop - mean, 1e-6);
  EXPECT_NEAR(valueOf(o, "front"), drop, 1e-6);
  EXPECT_NEAR(valueOf(o, "motion") / (0.5 * mass * std::pow(9.81 * 0.3, 2)), 1, 1e-6);
  EXPECT_EQ(valueOf(o, "same"), valueOf(o, "down"));
  EXPECT_EQ(valueOf(o, "overlap"), 0);
  EXPECT_LT(valueOf(o, "residual"), 1e-6);
}

// At rest the floor carries m g and the spring is pressed in by m g/k.
TEST(Observer, WeightOnTheFloor) {
  std::string text = swinging;
  const std::string end = "end = \"40 ms\"";
  text.replace(text.find(end), end.size(), "end = \"400 ms\"");
  const Outcome o = measured(text + "force = { kind = \"peak_force\", wall = \"floor\" }\noverlap = { kind = \"largest_overlap\" }\n");
  const double weight = 1000 * 4.0 / 3 * std::numbers::pi * 1e-6 * 9.81;
  EXPECT_NEAR(valueOf(o, "height"), 0.01 - weight / 2000, 1e-7);
  EXPECT_NEAR(valueOf(o, "overlap"), 0.04, 1e-12);        // the start is the deepest
  EXPECT_NEAR(valueOf(o, "force"), 2000 * 0.4e-3, 1e-6);  // and presses hardest
}

TEST(Observer, ASceneThatNamesNothingHasDefaults) {
  const std::string text = falling("");
  const Outcome o = measured(text.substr(0, text.find("[observe]")));
  std::vector<std::string> names;
  for (const Measured& value : o.values) names.push_back(value.name);
  EXPECT_EQ(names, (std::vector<std::string>{"energy_residual", "largest_overlap", "centre_of_mass", "kinetic_energy"}));
}

// Looking changes nothing: the same bits whatever is observed and how often.
TEST(Observer, LookingChangesNothing) {
  const Folder folder("observer");
  const std::string scene = folder.file("heap.toml", heap);
  const Outcome plain = *run({scene, {"simulation.time_step=10 us"}});
  const std::string more = folder.file("more.toml", heap + "force = { kind = \"peak_force\", wall = \"floor\" }\n");
  const Outcome seen = *run({more, {"simulation.time_step=10 us", "output.ledger_interval=2.5 ms"}});
  ASSERT_EQ(plain.timeStep, seen.timeStep);
  EXPECT_EQ(plain.stateHash, seen.stateHash);
  EXPECT_EQ(valueOf(plain, "height"), valueOf(seen, "height"));
}

}  // namespace
}  // namespace tsubu::study
