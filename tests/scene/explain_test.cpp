#include "scene/explain.h"

#include <gtest/gtest.h>

#include "scene/reader.h"
#include "scenes.h"

namespace tsubu::scene {
namespace {

std::string explained(const Overrides& overrides = {}) { return explain(readText(shortScene, "scene.toml", overrides)); }

bool says(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(Explain, NamesLawsGrainsAndFrames) {
  const std::string text = explained();
  EXPECT_TRUE(says(text, "linear: ")) << text;
  EXPECT_TRUE(says(text, "spring: ")) << text;
  EXPECT_TRUE(says(text, "grains         10 at the start\n")) << text;
  EXPECT_TRUE(says(text, "frames         31 of 1280 x 720")) << text;  // 30 a second, one second, and the first
}

TEST(Explain, SaysWhatSetsTheTimeStep) {
  EXPECT_TRUE(says(explained(), "stiffness of glass–glass"));
  // Eight contacts instead of one, and m* = m/2 between grains: 2√(m/k) is √(8 × 2) = 4 times too long.
  EXPECT_TRUE(says(explained(), "rules for a single contact would allow "));
  EXPECT_TRUE(says(explained({"simulation.integrator=symplectic_euler", "pairs.restitution=1", "contact.tangential=none"}),
                   "4 (Note), 4 (2√(m/k)), 6.3 (π√(m/k)) times"));
  EXPECT_TRUE(says(explained({"simulation.time_step=1e-6"}), "set by the scene (time_step)"));
  EXPECT_TRUE(says(explained({"grains.bed.velocity=[1000,0,0]"}), "speed: up to "));
  EXPECT_TRUE(says(explained({"simulation.time_step=1e-3"}), "above the stability limit"));
}

// 10 grains with friction keep memory per contact; without there is none, and nothing turns.
TEST(Explain, WithoutFrictionThereIsNoMemoryPerContact) {
  EXPECT_FALSE(says(explained(), " 0 per contact"));
  const std::string text = explained({"contact.tangential=none"});
  EXPECT_TRUE(says(text, " 0 per contact")) << text;
}

}  // namespace
}  // namespace tsubu::scene
