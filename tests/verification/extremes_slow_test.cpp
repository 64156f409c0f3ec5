// The same extremes for longer than a quick suite has time: scripts/test --slow.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "verification/columns.h"

namespace tsubu::sim::test {
namespace {

// A grain without any loss between two walls, for ten million times the duration of a contact: docs/physics.md has the table for all
// integrators.
TEST(ExtremesSlow, ElasticContactsForTenMillionContactTimes) {
  const double mass = 1e-5, k = 1000, r = 2e-3, W = 0.1, omega = std::sqrt(k / mass);
  for (const Integrator integrator : {Integrator::symplecticEuler, Integrator::velocityVerlet}) {
    Scenario s;
    s.model.integrator = integrator;
    s.pair[Property::normalStiffness] = k;
    s.pair[Property::restitution] = 1;
    s.grain(mass, r, {0, 0, 0}, {0, 0, 0.3});
    s.plane({0, 0, -1.01 * r}, {0, 0, 1});
    s.plane({0, 0, 1.01 * r}, {0, 0, -1});
    Simulation sim = s.start(W / omega);
    const double start = sim.ledger().mechanical();
    double worst = 0;
    for (double done = 0; done < 1e7 * pi / W; done += 99731) {
      sim.advance(99731);
      worst = std::max(worst, std::abs(sim.ledger().mechanical() / start - 1));
    }
    fmt::print("  {}: {:.1e}\n", schemeOf(integrator).name, worst);
    EXPECT_LT(worst, integrator == Integrator::symplecticEuler ? 0.1 : 0.02);
  }
}

TEST(ExtremesSlow, ColumnOfTenThousandGrainsDoesNotCreep) {
  const Creep creep = creepOfColumn(10000, 10, Integrator::velocityVerlet, 1.0, 0.1);
  fmt::print("  moved {:.1e} radii in 0.1 s, kinetic over dissipated {:.1e}, deepest overlap {:.3f}, residual {:.1e}\n", creep.moved,
             creep.kinetic, creep.deepest, creep.residual);
  EXPECT_LT(creep.moved, 5e-2);
  EXPECT_LT(creep.kinetic, 1e-5);
  EXPECT_LT(creep.deepest, 0.2);
  EXPECT_LT(creep.residual, 6e-2);  // of hard damped collisions at this step, and of second order: crowds_at_extremes_test.cpp
}

// Eighteen layers at rest, for a million steps.
TEST(ExtremesSlow, ColumnAtRestForAMillionSteps) {
  const Creep creep = creepOfColumn(300, 4, Integrator::velocityVerlet, 1.0, 1e6);
  fmt::print("  moved {:.1e} radii in {} steps, kinetic over dissipated {:.1e}, residual {:.1e}\n", creep.moved, creep.steps, creep.kinetic,
             creep.residual);
  EXPECT_GE(creep.steps, 1000000u);
  EXPECT_LT(creep.moved, 1e-2);
  EXPECT_LT(creep.kinetic, 1e-6);
}

// Twenty times as long as a wave takes from the floor to the top.
TEST(ExtremesSlow, ColumnOfTenThousandGrainsStandsForAMillionSteps) {
  for (const std::string_view law : {"linear", "hertz"}) {
    const std::uint64_t steps = 1000000;
    const Stack stack{law, 10000};
    const Standing seen = watch(stack, steps);
    const double bound = roundedAway(seen.ulp, steps);
    fmt::print("  {}: {:.0f} waves, moved {:.1e} of a radius or {:.0f} units of the last place, fastest {:.1e} m/s, residual {:.1e}\n", law,
               seen.waves, seen.moved / Stack::r, seen.moved / seen.ulp, seen.fastest, seen.residual);
    EXPECT_GT(seen.waves, 10) << law;
    EXPECT_LT(seen.moved, bound) << law;
    EXPECT_EQ(seen.aside, 0) << law;
    EXPECT_LT(seen.fastest, 2 * stack.omega() * bound) << law;
    EXPECT_LT(seen.residual, 1e-13) << law;
  }
}

// A million grains where a boulder's cell is: none of them touches, all are found, and the step is taken.
TEST(ExtremesSlow, AMillionGrainsInTheCellOfABoulder) {
  Scenario s;
  s.pair[Property::normalStiffness] = 1;
  s.pair[Property::restitution] = 0.5;
  Material dust;
  dust.name = "dust";
  dust.values[Property::density] = 2500;
  s.model.materials.push_back(dust);
  s.model.ledger = false;
  const double r = 1e-4;
  Grain boulder;
  boulder.radius = 0.1;
  boulder.position = {-0.2, 0, 0};
  s.model.grains.push_back(boulder);
  Grain grain;
  grain.radius = r;
  for (int n = 0; n < 1000000; ++n) {
    grain.position = 2.2 * r * Vec3(n % 100, n / 100 % 100, n / 10000);
    s.model.grains.push_back(grain);
  }
  Simulation sim = s.start(1e-6);
  sim.advance(3);
  EXPECT_EQ(sim.grains(), 1000001u);
  EXPECT_EQ(sim.contacts().touching, 0u);
  EXPECT_TRUE(look(sim).position.back().allFinite());
}

}  // namespace
}  // namespace tsubu::sim::test
