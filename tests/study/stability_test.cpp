#include "study/stability.h"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "core/error.h"
#include "scenes.h"

namespace tsubu::study {
namespace {

Stability found(const std::string& text, const scene::Overrides& overrides = {}, double at = 0) {
  const Folder folder("stability");
  StabilityRequest request;
  request.scene = folder.file("scene.toml", text);
  request.overrides = overrides;
  request.at = at;
  request.steps = 400;
  return *findStability(request, {});
}

/// Grains in a row between two walls, pressed a little (much, and it would buckle); everything of one stiffness, and grains of one mass.
constexpr double spacing = 0.02 - 2e-7, atWall = 0.01 - 2e-7;
std::string chain(int grains, const std::string& contact, const std::string& pairs) {
  std::string places;
  for (int k = 0; k < grains; ++k) places += fmt::format("{}[{:.12g}, 0, 0]", k ? ", " : "", spacing * k);
  return fmt::format(R"(
[simulation]
end = 0.1
gravity = [0, 0, 0]
overlap_limit = 0.5
[contact]
tension = true
{}
[materials.ball]
density = 1000
[pairs]
normal_stiffness = 3000
{}
[grains.row]
source = "list"
radius = "1 cm"
positions = [{}]
[walls.left]
plane = {{ point = [{:.12g}, 0, 0], normal = [1, 0, 0] }}
[walls.right]
plane = {{ point = [{:.12g}, 0, 0], normal = [-1, 0, 0] }}
)",
                     contact, pairs, places, -atWall, spacing * (grains - 1) + atWall);
}

constexpr double mass = 1000 * 4.0 / 3 * std::numbers::pi * 1e-6, stiffness = 3000;

// n equal masses on n + 1 equal springs between walls: ω² = (4k/m) sin²(π n/(2(n + 1))).
double stiffestOf(int n) { return 2 * std::sqrt(stiffness / mass) * std::sin(std::numbers::pi * n / (2.0 * (n + 1))); }

TEST(Stability, ChainsWithoutDashpotsBlowUpAtTwoOverOmega) {
  for (const int n : {1, 2, 5, 12}) {
    for (const char* integrator : {"velocity_verlet", "symplectic_euler"}) {
      const Stability s = found(chain(n, "tangential = \"none\"", "restitution = 1"), {std::string("simulation.integrator=") + integrator});
      EXPECT_EQ(s.contacts, static_cast<std::size_t>(n + 1));
      EXPECT_NEAR(s.predicted.spectral * stiffestOf(n) / 2, 1, 1e-4) << n;
      EXPECT_NEAR(s.measured / s.predicted.spectral, 1, 0.01) << n << " " << integrator;
      EXPECT_LE(s.predicted.gershgorin, s.predicted.spectral * 1.0001);
      EXPECT_LE(s.predicted.sum, s.predicted.spectral * 1.0001);
    }
  }
}

// With dashpots of one rate per effective mass: those at the walls have half the share of the springs between grains, so that damping is
// not proportional to stiffness. The prediction holds all the same.
TEST(Stability, DashpotsThatAreNotProportional) {
  for (const char* rate : {"normal_damping_rate = \"300 1/s\"", "normal_damping_rate = \"3000 1/s\"", "restitution = 0.1"}) {
    for (const char* integrator : {"velocity_verlet", "symplectic_euler"}) {
      const Stability s = found(chain(4, "tangential = \"none\"", rate), {std::string("simulation.integrator=") + integrator});
      EXPECT_NEAR(s.measured / s.predicted.spectral, 1, 0.03) << rate << " " << integrator;
      EXPECT_LT(s.predicted.spectral, 2 / stiffestOf(4));
    }
  }
}

// Springs across and rolling grains: the network bears what the stiffest of its coupled modes allows.
TEST(Stability, FrictionAndRolling) {
  for (const char* tangential : {"0.5", "857", "2500", "6000"}) {
    for (const char* integrator : {"velocity_verlet", "symplectic_euler"}) {
      for (const char* e : {"0.8", "0.2"}) {
        const std::string pairs = std::string("restitution = ") + e + std::string("\nfriction = 10\ntangential_stiffness = ") + tangential;
        const Stability s = found(chain(3, "", pairs), {std::string("simulation.integrator=") + integrator});
        EXPECT_NEAR(s.measured / s.predicted.spectral, 1, 0.03) << tangential << " " << integrator << " e " << e;
      }
    }
  }
}

// A row of grains that bonds join to each other: they shear, bend and twist as well as stretch.
TEST(Stability, Bonds) {
  const std::string text = R"(
[simulation]
end = 0.1
gravity = [0, 0, 0]
[contact]
tangential = "none"
[materials.ball]
density = 1000
[pairs]
normal_stiffness = 1
restitution = 1
[grains.row]
source = "list"
radius = "1 cm"
positions = [[0, 0, 0], [0.021, 0, 0], [0.042, 0, 0], [0.042, 0.021, 0], [0.042, 0.042, 0]]
[bonds.glue]
distance = 1.1
stiffness = "1e8 N/m^3"
stiffness_ratio = 1.5
)";
  for (const char* damping : {"", "damping = { kind = \"viscous\", ratio = 0.2 }\n"}) {
    for (const char* integrator : {"velocity_verlet", "symplectic_euler"}) {
      const Stability s = found(text + damping, {std::string("simulation.integrator=") + integrator});
      EXPECT_NEAR(s.measured / s.predicted.spectral, 1, 0.03) << integrator << damping;
      EXPECT_LT(s.automatic, s.measured);
    }
  }
}

// The rules for single contacts allow too much as soon as a grain has two neighbours; the duration of a contact does at once.
TEST(Stability, RulesForOneContactAreTooLong) {
  const Stability one = found(chain(1, "tangential = \"none\"", "restitution = 1"));
  const Stability many = found(chain(8, "tangential = \"none\"", "restitution = 1"));
  EXPECT_NEAR(one.predicted.undamped / one.measured, std::sqrt(2), 0.02);  // two walls
  EXPECT_NEAR(many.predicted.undamped / many.measured, 2, 0.05);           // ω² → 4k/m
  EXPECT_NEAR(many.predicted.duration / many.predicted.undamped, std::numbers::pi / 2, 1e-12);
  EXPECT_LT(many.automatic, many.measured);
}

// Grains that still fall collide whatever the step: what parts two copies is no fault of it.
TEST(Stability, RainIsJudgedByEnergy) {
  const std::string rain = R"(
[simulation]
end = 1
safety = 0.5
[materials.sand]
density = 2500
[pairs]
normal_stiffness = "5000 N/m"
restitution = 0.4
friction = 0.6
[grains.rain]
source = "stream"
cylinder = { base = [0, 0, 0.03], top = [0, 0, 0.05], radius = "6 mm" }
rate = "800 grains/s"
radius = "2 mm"
[walls.floor]
plane = {}
)";
  const Stability s = found(rain, {}, 0.2);
  EXPECT_TRUE(s.found);
  EXPECT_LT(s.automatic, s.measured);
  EXPECT_GT(s.measured, 0.6 * s.predicted.spectral);
  EXPECT_LT(s.measured, 2 * s.predicted.spectral);
  if (s.restless) {
    EXPECT_NE(tableOf(s).find("does not stay as it is"), std::string::npos);
  }
}

TEST(Stability, OneThatBouncesHasNothingToBlowUp) {
  const Folder folder("stability");
  StabilityRequest request;
  request.scene = folder.file("scene.toml", heap);
  request.at = 0;
  EXPECT_THROW(findStability(request, {}), Error);
  request.at = 0.2;
  request.overrides = {"simulation.end=0.2"};
  const auto settled = findStability(request, {});
  ASSERT_TRUE(settled);
  EXPECT_TRUE(settled->found);
  EXPECT_GT(settled->contacts, 3u);
  EXPECT_NEAR(settled->measured / settled->predicted.spectral, 1, 0.1);
  EXPECT_NE(tableOf(*settled).find("blows up at"), std::string::npos);
}

}  // namespace
}  // namespace tsubu::study
