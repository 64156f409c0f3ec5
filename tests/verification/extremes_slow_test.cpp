// The same extremes for longer than a quick suite has time: scripts/test --slow.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "verification/columns.h"

namespace tsubu::sim::test {
namespace {

// A grain without any loss between two walls, for a million times the duration of a contact: docs/physics.md has the table for all
// integrators.
TEST(ExtremesSlow, ElasticContactsForAMillionContactTimes) {
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
    for (double done = 0; done < 1e6 * pi / W; done += 9973) {
      sim.advance(9973);
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

}  // namespace
}  // namespace tsubu::sim::test
