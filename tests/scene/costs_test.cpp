// A scene pays for what it names: nothing of the rest is allocated, listed or run. What the rest costs is measured, and known by its name.

#include "scene/costs.h"

#include <gtest/gtest.h>

#include "core/snapshot.h"
#include "scene/build.h"
#include "scene/reader.h"
#include "scenes.h"
#include "sim/laws/catalogue.h"
#include "sim/pass.h"
#include "sim/simulation.h"

namespace tsubu::scene {
namespace {

const Overrides lean{"contact.tangential=none", "simulation.ledger=false", "simulation.integrator=symplectic_euler", "simulation.end=1e-3"};

Built builtWith(Overrides more) {
  Overrides all = lean;
  all.insert(all.end(), more.begin(), more.end());
  return build(readText(shortScene, "scene.toml", all));
}

TEST(Costs, WhatIsNotNamedIsNeitherAllocatedNorRun) {
  Built built = builtWith({});
  const sim::LawTraits& traits = sim::lawFunctions(sim::lawIndex(built.model.contact)).traits;
  EXPECT_EQ(traits.stateSize, 0);
  EXPECT_FALSE(traits.turns);
  EXPECT_FALSE(traits.rolls);
  EXPECT_TRUE(sim::makePasses(built.model).empty());
  const sim::Plan plan = sim::Simulation::plan(built.model);
  EXPECT_EQ(plan.passes,
            (std::vector<std::string>{"neighbour lists (when grains have moved)", "pair contacts", "integrate: symplectic Euler"}));
  EXPECT_EQ(plan.bytesPerContact, 0u);
  // A row, a force, the id, the material, and where it was when lists were made.
  EXPECT_EQ(plan.bytesPerGrain, 12 * 8u + 8 * 8u + 4u + 2u + 3 * 8u + 2 * 4u);  // the last: the skin
  sim::Simulation simulation(std::move(built.model), 1);
  simulation.advance(5);
  Snapshot snapshot;
  simulation.fill(snapshot);
  EXPECT_TRUE(snapshot.orientation.empty());
  EXPECT_TRUE(snapshot.angularVelocity.empty());
  EXPECT_TRUE(snapshot.temperature.empty());
  EXPECT_TRUE(snapshot.bonds.empty());
  EXPECT_TRUE(snapshot.forces.empty());
}

// Each feature brings its own columns and passes, and no others.
TEST(Costs, EachFeatureBringsItsOwn) {
  const sim::Plan base = sim::Simulation::plan(builtWith({}).model);
  struct Case {
    Overrides overrides;
    std::size_t perGrain, passes;
  };
  const Case cases[] = {{{"simulation.integrator=velocity_verlet"}, 64, 0},
                        {{"simulation.integrator=central_differences"}, 32, 0},
                        {{"simulation.ledger=true"}, 0, 0},
                        {{"simulation.continuous=true"}, 0, 0},
                        {{"simulation.precision=mixed"}, 64 + 32, 0},
                        {{"contact.normal=hertz", "materials.glass.young_modulus=1e7", "materials.glass.poisson_ratio=0.2"}, 0, 0},
                        {{"contact.tangential=viscous", "pairs.tangential_damping_rate=10"}, 0, 0},
                        {{"contact.tangential=viscous", "pairs.tangential_damping_rate=10", "colours.pattern=stripes"}, 32 + 16, 0},
                        {{"colours.pattern=stripes"}, 0, 0},
                        {{"contact.tangential=viscous", "pairs.tangential_damping_rate=10", "contact.rotation=false"}, 0, 0},
                        {{"fields.drag.viscosity=1e-3"}, 0, 1},
                        {{"fields.damping.rate=1"}, 0, 1},
                        {{"heat.temperature=300", "materials.glass.conductivity=1", "materials.glass.heat_capacity=800"}, 16, 1}};
  for (const Case& c : cases) {
    const sim::Plan plan = sim::Simulation::plan(builtWith(c.overrides).model);
    EXPECT_EQ(plan.bytesPerGrain, base.bytesPerGrain + c.perGrain) << c.overrides[0];
    EXPECT_EQ(plan.passes.size(), base.passes.size() + c.passes) << c.overrides[0];
    EXPECT_EQ(plan.bytesPerContact, 0u) << c.overrides[0];
  }
}

// How far grains have turned only shows: kept or not, they go the same way.
TEST(Costs, PaintedGrainsGoTheSameWay) {
  const auto after = [](Overrides how, const char* pattern) {
    how.insert(how.end(), {"contact.tangential=spring", "grains.bed.count=400", std::string("colours.pattern=") + pattern,
                           "grains.bed.spin=[3, -5, 7]", "grains.bed.velocity=[0.1, 0.05, -0.5]"});
    how.insert(how.begin(), lean.begin(), lean.end());
    Built built = build(readText(shortScene + "[walls.floor]\nplane = { point = [0, 0, 0], normal = [0, 0, 1] }\n", "scene.toml", how));
    sim::Simulation simulation(std::move(built.model), 1);
    simulation.advance(400);
    Snapshot snapshot;
    simulation.fill(snapshot);
    return snapshot;
  };
  for (const Overrides& how :
       {Overrides{}, Overrides{"simulation.integrator=velocity_verlet"}, Overrides{"simulation.integrator=leapfrog"},
        Overrides{"simulation.integrator=central_differences"}, Overrides{"simulation.integrator=explicit_euler"},
        Overrides{"simulation.integrator=rk4"}, Overrides{"simulation.precision=mixed"}, Overrides{"simulation.continuous=true"}}) {
    const Snapshot plain = after(how, "none"), painted = after(how, "stripes");
    const std::string name = how.empty() ? "" : how.front();
    ASSERT_EQ(plain.grains(), painted.grains()) << name;
    EXPECT_TRUE(plain.orientation.empty()) << name;
    EXPECT_EQ(painted.orientation.size(), painted.grains()) << name;
    std::size_t touched = 0;
    for (std::size_t g = 0; g < plain.grains(); ++g) {
      EXPECT_EQ(plain.position[g], painted.position[g]) << name;
      EXPECT_EQ(plain.velocity[g], painted.velocity[g]) << name;
      EXPECT_EQ(plain.angularVelocity[g], painted.angularVelocity[g]) << name;
      touched += (plain.angularVelocity[g] - Vec3(3, -5, 7)).norm() > 1;
    }
    EXPECT_GT(touched, 3u) << name;
  }
}

// To say that something is off is to say nothing.
TEST(Costs, OffIsTheSameAsNotNamed) {
  const auto hashOf = [](const Overrides& more) {
    Built built = builtWith(more);
    sim::Simulation simulation(std::move(built.model), 1);
    simulation.advance(100);
    return simulation.stateHash();
  };
  EXPECT_EQ(hashOf({}), hashOf({"contact.rolling=none", "contact.twisting=none", "contact.rotation=true", "contact.tension=false",
                                "simulation.continuous=false", "simulation.limit=packing"}));
}

TEST(Costs, EveryFeatureHasBeenMeasured) {
  const MeasuredCosts& costs = measuredCosts();
  for (const sim::LawFamily& family : sim::lawFamilies())
    for (const sim::LawInfo& law : family.laws) {
      const std::string feature = std::string(family.key) + ": " + std::string(law.name);
      if (law.name != "none" && law.name != "linear") {
        EXPECT_NE(costs.of(feature), nullptr) << feature << ": run bench/costs.py";
      }
    }
  for (const std::string& feature : featuresOf(build(readText(shortScene, "scene.toml")).model))
    EXPECT_NE(costs.of(feature), nullptr) << feature;
  for (const char* feature : {"rotation held", "bonds", "drag", "global damping", "magnets", "heat conduction", "periodic domain",
                              "mesh wall", "moving wall", "walls that move under load", "sizes of grains", "continuous collisions",
                              "energy ledger", "orientation of grains", "mixed precision"})
    EXPECT_NE(costs.of(feature), nullptr) << feature;
  const FeatureCost *plain = costs.of("contacts, motion, lists"), *off = costs.of("everything off, said so");
  ASSERT_TRUE(plain && off);
  EXPECT_EQ(off->bytesPerGrain, 0);
  EXPECT_EQ(off->bytesPerContact, 0);
  EXPECT_GT(plain->nanoseconds, 0);
}

}  // namespace
}  // namespace tsubu::scene
