// Who is bonded: by distance, by group and material, by chance, when; and that the number of threads is not felt.

#include <gtest/gtest.h>

#include <set>

#include "sim/bonds/bond_limit.h"
#include "verification/models.h"
#include "verification/shapes.h"

namespace tsubu::sim {
namespace {

using test::Scenario;

Bonding glue(double stiffness = 1e11) {
  Bonding bonding;
  bonding.name = "glue";
  bonding.distance = 1.05;
  bonding.stiffness = stiffness;
  bonding.stiffnessRatio = 2;
  return bonding;
}

/// n × n × n grains of unequal size on a cubic lattice, nearly touching.
Scenario block(int n, double gap = 1.02) {
  Scenario s;
  s.model.contact = {"linear", "spring", "none", false};
  s.pair[Property::normalStiffness] = 3e4;
  s.pair[Property::restitution] = 0.6;
  s.pair[Property::friction] = 0.4;
  Material stone{"stone", {}};
  stone.values[Property::density] = 2500;
  s.model.materials.push_back(stone);
  Random random(7, 7);
  for (int k = 0; k < n * n * n; ++k) {
    Grain g;
    g.radius = random.uniform(0.9e-3, 1e-3);
    g.position = 2e-3 * gap * Vec3(k % n, k / n % n, k / (n * n));
    s.model.grains.push_back(g);
  }
  return s;
}

std::uint64_t bondsOf(Scenario& s, std::uint64_t steps = 1) {
  Simulation sim = s.start(1e-7);
  sim.advance(steps);
  return sim.counts().bonds;
}

TEST(BondMaking, JoinsWhoIsNearEnough) {
  Scenario s = block(3, 1.0);
  s.model.bonds = {glue()};
  s.model.bonds[0].distance = 1.12;  // all 54 neighbours along the edges of the lattice (largest gap 10 %), none across
  EXPECT_EQ(bondsOf(s), 54u);
  s.model.bonds[0].distance = 1.6;  // and the 72 across faces
  EXPECT_EQ(bondsOf(s), 54u + 72u);
  s.model.bonds[0].distance = 0.9;
  EXPECT_EQ(bondsOf(s), 0u);
}

TEST(BondMaking, JoinsGroupsAndMaterials) {
  Scenario s = block(2, 1.0);  // ids 0 to 7; 0–1, 2–3, 4–5, 6–7 along x
  Material other{"other", s.model.materials[0].values};
  s.model.materials.push_back(other);
  for (std::size_t g = 4; g < 8; ++g) s.model.grains[g].material = 1;
  Bonding bonding = glue();
  bonding.distance = 1.12;
  s.model.bonds = {bonding};
  EXPECT_EQ(bondsOf(s), 12u);
  s.model.bonds[0].first.material = s.model.bonds[0].second.material = 1;
  EXPECT_EQ(bondsOf(s), 4u);
  s.model.bonds[0].second.material = 0;
  EXPECT_EQ(bondsOf(s), 4u);  // between the layers
  s.model.bonds = {bonding};
  s.model.bonds[0].first = {std::nullopt, 0, 2};
  s.model.bonds[0].second = {std::nullopt, 2, 8};
  EXPECT_EQ(bondsOf(s), 4u);
  // Two kinds: a pair belongs to the first that claims it.
  s.model.bonds.push_back(bonding);
  EXPECT_EQ(bondsOf(s), 12u);
}

TEST(BondMaking, ChanceIsKeyedByTheGrains) {
  Scenario s = block(8);
  s.model.bonds = {glue()};
  s.model.bonds[0].distance = 1.2;
  const auto all = static_cast<double>(bondsOf(s));
  s.model.bonds[0].probability = 0.4;
  const std::uint64_t some = bondsOf(s);
  EXPECT_NEAR(static_cast<double>(some), 0.4 * all, 4 * std::sqrt(0.24 * all));
  EXPECT_EQ(bondsOf(s), some);
  Simulation one = s.start(1e-7, 1), three = s.start(1e-7, 3);
  one.advance(3);
  three.advance(3);
  EXPECT_EQ(one.stateHash(), three.stateHash());
  s.model.seed = 2;
  Simulation other = s.start(1e-7, 1);
  other.advance(3);
  EXPECT_NE(one.stateHash(), other.stateHash());
}

TEST(BondMaking, WaitsForItsTime) {
  Scenario s = block(2, 1.0);
  s.model.bonds = {glue()};
  s.model.bonds[0].distance = 1.12;
  s.model.bonds[0].start = s.model.bonds[0].end = 5e-6;
  EXPECT_EQ(bondsOf(s, 50), 0u);
  EXPECT_EQ(bondsOf(s, 51), 12u);
}

// Grains that come near while bonds are made stick, those that come later do not.
TEST(BondMaking, GoesOnWhileItIsToldTo) {
  for (const double end : {1.0, 0.02}) {
    Scenario s;
    s.model.contact = {"linear", "spring", "none", false};
    s.pair[Property::normalStiffness] = 3e3;
    s.pair[Property::restitution] = 0.5;
    s.pair[Property::friction] = 0.4;
    s.grain(1e-5, 1e-3, {0, 0, 0}, {0.05, 0, 0});
    s.grain(1e-5, 1e-3, {3.1e-3, 0, 0});  // reached at 1.1 mm/0.05 m/s, 22 ms (1.05: 20 ms)
    s.model.bonds = {glue(1e8)};
    s.model.bonds[0].end = end;
    s.model.bonds[0].distance = 1.03;
    Simulation sim = s.start(1e-5);
    sim.advance(2000);
    EXPECT_EQ(sim.counts().bonds, 0u);
    sim.advance(200);
    EXPECT_EQ(sim.counts().bonds, end == 1.0 ? 1u : 0u);
  }
}

/// A block that shatters on a plane.
Scenario shatters(Integrator integrator) {
  Scenario s = block(6);
  s.model.integrator = integrator;
  s.model.watch.stop = false;
  for (Grain& g : s.model.grains) g.velocity = {1, 0, -12};
  s.plane({0, 0, -1.2e-3}, {0, 0.1, 1});
  Bonding bonding = glue(2e10);
  bonding.distance = 1.2;
  bonding.damping = BondDamping::viscous;
  bonding.dampingOf = {0.05, 0.05, 0.05, 0.05};
  bonding.strength.tension = 3e5;
  bonding.strength.shear = 4e5;
  s.model.bonds = {bonding};
  Bonding wall = glue(1e9);
  wall.wall = 0;
  wall.distance = 1.3;
  wall.strength.tension = 1e6;
  s.model.bonds.push_back(wall);
  return s;
}

TEST(SameBonds, ForAnyNumberOfThreadsAndAnySkin) {
  for (const Integrator integrator : {Integrator::symplecticEuler, Integrator::velocityVerlet}) {
    Scenario s = shatters(integrator);
    std::uint64_t hash = 0, broken = 0;
    for (const int threads : {1, 2, 3}) {
      Simulation sim = s.start(4e-7, threads);
      sim.advance(500);
      if (threads == 1) hash = sim.stateHash(), broken = sim.counts().broken;
      EXPECT_GT(sim.counts().broken, 20u);
      EXPECT_GT(sim.counts().bonds, 20u);
      EXPECT_EQ(sim.stateHash(), hash) << threads;
      EXPECT_EQ(sim.counts().broken, broken);
    }
    // Lists made anew in every step: the order of sums differs, so the two agree to rounding as long as nothing is chaotic.
    Simulation often = (s.model.skin = 1e-7, s.start(4e-7)), seldom = (s.model.skin = 5e-4, s.start(4e-7));
    often.advance(300);
    seldom.advance(300);
    EXPECT_EQ(often.counts().broken, seldom.counts().broken);
    const Snapshot a = test::look(often), b = test::look(seldom);
    for (std::size_t g = 0; g < a.grains(); ++g) EXPECT_LT((a.position[g] - b.position[g]).norm(), 1e-12);
  }
}

// Bonds longer than a slab is thick take another way through the pass.
TEST(SameBonds, HoweverLongTheyAre) {
  Scenario s = block(4);
  s.model.bonds = {glue(1e9)};
  s.model.bonds[0].distance = 3.1;
  for (Grain& g : s.model.grains) g.velocity = 5 * Vec3(g.position.y(), -g.position.x(), 0.3 * g.position.x());
  Simulation one = s.start(2e-7, 1), three = s.start(2e-7, 3);
  const Ledger before = one.ledger();
  one.advance(1000);
  three.advance(1000);

  EXPECT_EQ(one.stateHash(), three.stateHash());
  const Ledger after = one.ledger();
  EXPECT_GT(after.elasticBonds, 1e-3 * before.kinetic());
  EXPECT_LT(std::abs(after.residual()), 1e-4 * before.kinetic());
  EXPECT_LT((after.momentum - before.momentum).norm(), 1e-12 * before.momentum.norm());
}

// A block that lies across two faces of a periodic domain, turns, swings and drifts on is that in the open.
TEST(SameBonds, AcrossThePeriodicBoundary) {
  const double size = 0.02;
  std::vector<Snapshot> seen;
  std::vector<std::uint64_t> bonds;
  for (const bool periodic : {false, true}) {
    Scenario s = block(4, 0.97);  // some are pressed into each other: their contacts must be off on the boundary as well
    s.model.bonds = {glue(1e9)};
    s.model.bonds[0].distance = 1.2;
    s.model.watch.stop = false;
    for (Grain& g : s.model.grains) {
      g.velocity = Vec3(3, -2, 0.1) + 100 * Vec3(-g.position.y(), g.position.x(), 0);
      if (!periodic) continue;
      for (int axis = 0; axis < 2; ++axis) g.position[axis] -= g.position[axis] > 3e-3 ? size : 0;  // the same place, on the other side
    }
    s.model.domain = Box(Vec3(-0.017, -0.017, -1), Vec3(0.003, 0.003, 1));
    if (periodic)
      s.model.periodic = {true, true, false};
    else
      s.model.domain = Box(Vec3(-1, -1, -1), Vec3(1, 1, 1));
    Simulation sim = s.start(1e-6, periodic ? 2 : 1);
    sim.advance(2500);
    bonds.push_back(sim.counts().bonds);
    seen.push_back(test::look(sim));
  }
  EXPECT_EQ(bonds[0], bonds[1]);
  for (std::size_t g = 0; g < seen[0].grains(); ++g) {
    Vec3 d = seen[0].position[g] - seen[1].position[g];
    for (int axis = 0; axis < 2; ++axis) d[axis] -= size * std::round(d[axis] / size);
    EXPECT_LT(d.norm(), 1e-10) << g;
    EXPECT_LT((seen[0].angularVelocity[g] - seen[1].angularVelocity[g]).norm(), 1e-5) << g;
  }
}

// S5 is rigorous: at it nothing grows, whatever the network. And it is not idle: at thrice it everything does.
TEST(BondLimit, IsSafeAndNotIdle) {
  for (const double factor : {0.98, 3.0}) {
    Scenario s = block(4);
    for (std::size_t g = 0; g < s.model.grains.size(); ++g)
      s.model.grains[g].velocity = 1e-6 * Vec3(std::sin(3.0 * static_cast<double>(g)), std::cos(5.0 * static_cast<double>(g)), 0.3);
    s.model.bonds = {glue()};
    s.model.bonds[0].distance = 1.2;
    s.model.watch.travelLimit = 1e9;
    s.model.watch.stop = false;
    const double limit = 2 / std::sqrt(swingOfBonds([&] {
                                         Model m = s.model;
                                         m.timeStep = 1;
                                         return m;
                                       }())
                                           .stiffness);
    Simulation sim = s.start(factor * limit);
    const double start = sim.ledger().kinetic();
    double most = 0;
    for (int k = 0; k < 20; ++k) {
      try {
        sim.advance(50);
      } catch (const std::exception&) {
        most = 1e300;
        break;
      }
      const double now = sim.ledger().kinetic();
      most = std::isfinite(now) && sim.grains() == 64 ? std::max(most, now) : 1e300;
    }
    if (factor < 1)
      EXPECT_LT(most, 3 * start);
    else
      EXPECT_GT(most, 1e6 * start);
  }
}

}  // namespace
}  // namespace tsubu::sim
