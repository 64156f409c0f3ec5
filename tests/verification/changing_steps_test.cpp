// Steps of changing length (docs/physics.md, I8): the order of the scheme stays, and what it keeps is kept.

#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "verification/models.h"

namespace tsubu::sim::test {
namespace {

/// A grain between two planes that hold it, swinging along the normal and drawn across, where it sticks.
Scenario held(Integrator integrator) {
  Scenario s;
  s.model.integrator = integrator;
  s.model.contact = {"linear", "spring", "none", true};
  s.model.gravity = {3, 0, -9.81};
  const double r = 2e-3;
  s.pair[Property::normalStiffness] = 1000;
  s.pair[Property::restitution] = 0.6;
  s.pair[Property::friction] = 1e3;
  s.grain(1e-5, r, {0, 0, 0}, {0, 0, 0.05});
  s.plane({0, 0, -0.9 * r}, {0, 0, 1});
  s.plane({0, 0, 0.9 * r}, {0, 0, -1});
  return s;
}

/// Two grains that a bond joins, turning and swinging.
Scenario joined(Integrator integrator) {
  Scenario s;
  s.model.integrator = integrator;
  s.model.contact = {"linear", "spring", "none", false};
  s.pair[Property::normalStiffness] = 100;
  s.pair[Property::restitution] = 1;
  s.pair[Property::friction] = 0.3;
  Bonding bonding;
  bonding.name = "glue";
  bonding.distance = 1.1;
  bonding.radius = 0.8;
  bonding.stiffness = 1e9;
  bonding.stiffnessRatio = 1.7;
  s.model.bonds = {bonding};
  s.grain(8e-6, 1e-3, {0, 0, 0}, {0.2, -0.1, 0.3}, {100, -300, 50});
  s.grain(3e-5, 1.5e-3, {2.55e-3, 0, 0}, {0, 0.4, -0.1}, {-200, 100, 0});
  return s;
}

struct End {
  Vec3 position, spin;
  double residual, time;
};

End endOf(Simulation& sim) {
  const Snapshot now = look(sim);
  return {now.position[0], now.angularVelocity[0], std::abs(sim.ledger().residual()), sim.time()};
}

/// Steps of 1, 0.6, 1.4 … times dt, changed every seven.
End changing(Scenario s, double dt, int rounds) {
  Simulation sim = s.start(dt);
  for (int n = 0; n < rounds; ++n) {
    for (const double factor : {0.6, 1.4, 0.8, 1.0}) {
      sim.setTimeStep(factor * dt);
      sim.advance(7);
      if (n % 3 == 0) sim.ledger();  // looking changes nothing
    }
  }
  return endOf(sim);
}

struct Orders {
  double way, residual;
};

Orders ordersOf(Scenario (*make)(Integrator), Integrator integrator, double dt, int rounds) {
  std::array<double, 2> error{}, residual{};
  for (int k = 0; k < 2; ++k) {
    const int finer = 1 << k;
    const End end = changing(make(integrator), dt / finer, rounds * finer);
    const auto steps = static_cast<std::uint64_t>(std::ceil(end.time / (dt / 128)));
    Simulation exact = make(Integrator::velocityVerlet).start(end.time / static_cast<double>(steps));
    exact.advance(steps);
    error[static_cast<std::size_t>(k)] = (endOf(exact).position - end.position).norm();
    residual[static_cast<std::size_t>(k)] = end.residual;
  }
  const Orders orders{std::log2(error[0] / error[1]), std::log2(residual[0] / residual[1])};
  fmt::print("  {}: errors {:.1e} {:.1e} m, order {:.2f}; residuals {:.1e} {:.1e} J, order {:.2f}\n", schemeOf(integrator).name, error[0],
             error[1], orders.way, residual[0], residual[1], orders.residual);
  return orders;
}

TEST(ChangingSteps, KeepTheOrderOfContacts) {
  const Orders verlet = ordersOf(held, Integrator::velocityVerlet, 4e-6, 12), euler = ordersOf(held, Integrator::symplecticEuler, 4e-6, 12);
  EXPECT_GT(verlet.way, 1.8);
  EXPECT_GT(verlet.residual, 1.8);
  EXPECT_GT(euler.way, 0.8);
}

TEST(ChangingSteps, KeepTheOrderOfBonds) {
  const Orders verlet = ordersOf(joined, Integrator::velocityVerlet, 2e-6, 12),
               euler = ordersOf(joined, Integrator::symplecticEuler, 2e-6, 12);
  EXPECT_GT(verlet.way, 1.8);
  EXPECT_GT(euler.way, 0.8);
}

// The times are those that were asked for, from the second step on.
TEST(ChangingSteps, BeginWithTheSecondStep) {
  for (const Integrator integrator :
       {Integrator::explicitEuler, Integrator::symplecticEuler, Integrator::velocityVerlet, Integrator::rungeKutta}) {
    Simulation sim = held(integrator).start(1e-6);
    sim.advance(10);
    sim.setTimeStep(3e-6);
    sim.advance(3);
    EXPECT_NEAR(sim.time(), 17e-6, 1e-18) << schemeOf(integrator).name;
    EXPECT_EQ(sim.timeStep(), 3e-6);
  }
}

// Somebody looks, which evaluates the forces of a step that changes, and asks for another length only then. In free fall velocity Verlet is
// exact, whatever the steps.
TEST(ChangingSteps, OneIsFinishedBeforeTheNext) {
  for (const Integrator integrator : {Integrator::explicitEuler, Integrator::symplecticEuler, Integrator::velocityVerlet}) {
    Scenario s;
    s.model.integrator = integrator;
    s.model.gravity = Vec3(0, 0, -9.81);
    s.pair[Property::normalStiffness] = 1000;
    s.pair[Property::restitution] = 1;
    s.grain(1e-5, 1e-3, {0, 0, 0}, {0, 0, 2});
    Simulation sim = s.start(1e-6);
    sim.advance(10);
    sim.setTimeStep(3e-6);
    sim.advance(1);
    sim.ledger();
    sim.setTimeStep(2e-6);
    sim.advance(3);
    EXPECT_NEAR(sim.time(), 18e-6, 1e-18) << schemeOf(integrator).name;
    EXPECT_EQ(sim.timeStep(), 2e-6);
    if (integrator != Integrator::velocityVerlet) continue;
    const Snapshot end = look(sim);
    EXPECT_NEAR(end.velocity[0].z(), 2 - 9.81 * sim.time(), 1e-14);
    EXPECT_NEAR(end.position[0].z(), 2 * sim.time() - 0.5 * 9.81 * sim.time() * sim.time(), 1e-19);
  }
}

TEST(ChangingSteps, AreRefusedWhereVelocitiesBelongToOneLength) {
  for (const Integrator integrator : {Integrator::leapfrog, Integrator::centralDifferences}) {
    Simulation sim = held(integrator).start(1e-6);
    EXPECT_THROW(sim.setTimeStep(2e-6), Error);
  }
}

}  // namespace
}  // namespace tsubu::sim::test
