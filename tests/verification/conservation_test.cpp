// What closed systems keep, and whether the ledger's account closes, at the order of the scheme.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "verification/models.h"
#include "verification/shapes.h"

namespace tsubu::sim::test {
namespace {

constexpr std::array integrators{Integrator::symplecticEuler, Integrator::velocityVerlet};
const char* nameOf(Integrator integrator) { return integrator == Integrator::velocityVerlet ? "velocity Verlet" : "symplectic Euler"; }

/// A cloud of grains of very unequal size on a loose lattice that falls in upon itself, spinning.
Scenario cloud(Integrator integrator, const std::string& rolling, std::uint64_t seed) {
  Scenario s;
  s.model.integrator = integrator;
  s.model.contact = {"linear", "spring", rolling, false};
  s.pair[Property::normalStiffness] = 3e4;
  s.pair[Property::restitution] = 0.6;
  s.pair[Property::friction] = 0.5;
  s.pair[Property::rollingFriction] = 0.1;
  Random random(seed, 1);
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 3; ++j) {
      for (int l = 0; l < 3; ++l) {
        const double r = random.uniform(0.5e-3, 2.4e-3);
        const Vec3 x = 5e-3 * Vec3(i - 1.5, j - 1, l - 1) + randomVec(random, 1e-5);
        s.grain(2500 * 4.0 / 3.0 * pi * r * r * r * random.uniform(0.5, 2), r, x, -40 * x + randomVec(random, 0.3), randomVec(random, 200));
      }
    }
  }
  return s;
}

TEST(ClosedSystem, MomentaStayToRounding) {
  for (const Integrator integrator : integrators) {
    for (const char* rolling : {"none", "constant", "elastic_plastic"}) {
      Simulation sim = cloud(integrator, rolling, 3).start(1e-6);
      const Ledger before = sim.ledger();
      sim.advance(20000);
      const Ledger after = sim.ledger();
      EXPECT_LT(after.kinetic(), 0.5 * before.kinetic());  // something happened
      EXPECT_GT(after.dissipatedFriction, 0);
      const double momentum = std::sqrt(2 * before.kinetic() * 1e-3), angular = momentum * 0.01;  // scales: a gram, a centimetre
      EXPECT_LT((after.momentum - before.momentum).norm(), 1e-12 * momentum);
      EXPECT_LT((after.angularMomentumRest - before.angularMomentumRest).norm(), 1e-12 * angular) << nameOf(integrator) << ", " << rolling;
    }
  }
}

// Note (A.29): uniform gravity does not turn a system about its centre of mass; and dP/dt = M g.
TEST(ClosedSystem, GravityDoesNotTurnIt) {
  for (const Integrator integrator : integrators) {
    Scenario s = cloud(integrator, "elastic_plastic", 4);
    s.model.gravity = {1, -2, -9.81};
    Simulation sim = s.start(1e-6);
    const Ledger before = sim.ledger();
    sim.advance(20000);
    const Ledger after = sim.ledger();
    double mass = 0;
    for (std::size_t g = 0; g < s.model.grains.size(); ++g)
      mass += s.model.materials[g].values[Property::density] * 4.0 / 3.0 * pi * std::pow(s.model.grains[g].radius, 3);
    const double angular = std::sqrt(2 * before.kinetic() * mass) * 0.01;
    EXPECT_LT((after.angularMomentumRest - before.angularMomentumRest).norm(), 1e-12 * angular);
    EXPECT_LT((after.momentum - before.momentum - mass * sim.time() * s.model.gravity).norm(), 1e-11 * mass * 10 * sim.time());
  }
}

/// Largest relative error of the energy over `steps`, of eight grains in a box without loss; other grains for another seed.
double worstEnergyError(Integrator integrator, double dt, std::uint64_t steps, std::uint64_t seed) {
  Scenario s;
  s.model.integrator = integrator;
  s.pair[Property::normalStiffness] = 1000;
  s.pair[Property::restitution] = 1;
  Random random(8, seed);
  for (int n = 0; n < 8; ++n) {
    const double r = random.uniform(1e-3, 2e-3);
    s.grain(3e4 * r * r * r, r, 5e-3 * Vec3((n & 1) - 0.5, (n & 2) / 2 - 0.5, (n & 4) / 4 - 0.5), randomVec(random, 0.1));
  }
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) s.plane(-side * 5e-3 * Vec3::Unit(axis), side * Vec3::Unit(axis));
  Simulation sim = s.start(dt);
  const double start = sim.ledger().mechanical();
  double worst = 0;
  for (std::uint64_t done = 0; done < steps; done += 997) {
    sim.advance(997);
    worst = std::max(worst, std::abs(sim.ledger().mechanical() / start - 1));
  }
  return worst;
}

// A million steps in all. Within a contact the scheme keeps an energy of its own to rounding; where a contact begins and ends the spring
// has a kink, and each passage leaves an error of third order, up or down as it happens. The sum walks at random and does not drift: far
// better than second order at a given time, and small. One walk says little of the next: the mean square of several is compared.
TEST(ClosedSystem, EnergyOfElasticGrainsDoesNotDrift) {
  // ω Δt = 0.045 and twice that, for the lightest pair: ω² = 2k/m with m = 3e-5.
  const int walks = 6;
  double coarse = 0, fine = 0;
  for (std::uint64_t seed = 1; seed <= walks; ++seed) {
    coarse += std::pow(worstEnergyError(Integrator::velocityVerlet, 1e-5, 100000, seed), 2) / walks;
    fine += std::pow(worstEnergyError(Integrator::velocityVerlet, 5e-6, 200000, seed), 2) / walks;
  }
  coarse = std::sqrt(coarse), fine = std::sqrt(fine);
  fmt::print("  worst energy error of elastic grains in 1 s, velocity Verlet: {:.2e} at 10 µs, {:.2e} at 5 µs\n", coarse, fine);
  EXPECT_LT(fine, 5e-4);
  EXPECT_LT(fine, coarse / 3);
}

/// Share of the residual in the turnover for a cloud in a box with a moving floor, everything switched on.
double residualOfBox(Integrator integrator, const std::string& rolling, double dt, double until) {
  Scenario s = cloud(integrator, rolling, 5);
  s.model.gravity = {0, 0, -9.81};
  const double infinity = std::numeric_limits<double>::infinity();
  s.plane({0, 0, -8e-3}, {0, 0, 1}, WallMotion({{Oscillation{{0, 0, 1e-3}, 40, 0}, 0, infinity}}));
  s.wall(Surface(frustum(0.012, -0.02, 0.018, 0.02, 12)), WallMotion({{Rotation{Vec3::Zero(), Vec3::UnitZ(), 30}, 0, infinity}}));
  Simulation sim = s.start(dt);
  const int looks = 40;
  for (int n = 0; n < looks; ++n) {
    sim.advance(static_cast<std::uint64_t>(std::lround(until / looks / dt)));
    sim.ledger();
  }
  EXPECT_EQ(sim.counts().lost, 0u);
  EXPECT_NE(sim.ledger().workWalls, 0);
  return sim.ledger().residualFraction();
}

// Friction, rolling, damping, moving walls: what the ledger cannot explain shrinks with the step, to first order in symplectic Euler
// and to second in velocity Verlet. ω Δt of the smallest grain is 0.11 at 0.5 µs.
TEST(Ledger, ClosesAtTheOrderOfTheScheme) {
  for (const char* rolling : {"none", "constant", "elastic_plastic"}) {
    for (const Integrator integrator : integrators) {
      const double coarse = residualOfBox(integrator, rolling, 2e-6, 0.04), fine = residualOfBox(integrator, rolling, 5e-7, 0.04);
      const double order = std::log(coarse / fine) / std::log(4.0);
      fmt::print("  ledger residual, {}, rolling {}: {:.2e} at 2 µs, {:.2e} at 0.5 µs, order {:.2f}\n", nameOf(integrator), rolling, coarse,
                 fine, order);
      const bool verlet = integrator == Integrator::velocityVerlet;
      EXPECT_LT(fine, verlet ? 2e-4 : 1e-2);
      EXPECT_GT(order, verlet ? 1.5 : 0.7);
    }
  }
}

// Grains that come in and go out take their energy with them: an inlet above, a sink below, a funnel in between.
TEST(Ledger, ClosesWithInletsAndSinks) {
  for (const Integrator integrator : integrators) {
    double last = 0;
    for (const double dt : {4e-6, 2e-6}) {
      Scenario s;
      s.model.integrator = integrator;
      s.model.contact = {"linear", "spring", "elastic_plastic", false};
      s.model.gravity = {0, 0, -9.81};
      s.pair[Property::normalStiffness] = 2e4;
      s.pair[Property::restitution] = 0.5;
      s.pair[Property::friction] = 0.4;
      s.pair[Property::rollingFriction] = 0.05;
      Material glass{"glass", {}};
      glass.values[Property::density] = 2500;
      s.model.materials.push_back(glass);
      Stream stream;
      stream.name = "inlet";
      stream.region.shape = BoxRegion{{-0.01, -0.01, 0.01}, {0.01, 0.01, 0.02}};
      stream.grainsPerSecond = 1500;
      stream.radii.kind = UniformRadius{1e-3, 1.6e-3};
      stream.velocity = {0, 0, -0.5};
      s.model.streams.push_back(stream);
      s.model.sinks.push_back({"out", {BoxRegion{{-1, -1, -0.2}, {1, 1, -0.012}}}});
      s.model.domain = Box(Vec3::Constant(-0.5), Vec3::Constant(0.5));
      s.wall(Surface(frustum(0.004, -0.01, 0.02, 0.01, 24)));
      Simulation sim = s.start(dt);
      for (int n = 0; n < 30; ++n) {
        sim.advance(static_cast<std::uint64_t>(0.004 / dt));
        sim.ledger();
      }
      const Ledger end = sim.ledger();
      fmt::print("  ledger residual with inlet and sink, {}, {:.0e} s: {:.2e} ({} in, {} out)\n", nameOf(integrator), dt,
                 end.residualFraction(), sim.counts().inserted, sim.counts().removed);
      EXPECT_GT(sim.counts().removed, 5u);
      EXPECT_GT(end.inserted, 0);
      if (last > 0) {
        EXPECT_LT(end.residualFraction(), last / (integrator == Integrator::velocityVerlet ? 2.8 : 1.6));
      }
      last = end.residualFraction();
    }
  }
}

// A piston presses three grains against a stop until one of them is squeezed into a sink: the energy in its springs goes with it.
TEST(Ledger, SqueezedGrainTakesItsSpringsAlong) {
  for (const Integrator integrator : integrators) {
    Scenario s;
    s.model.integrator = integrator;
    s.model.contact = {"linear", "spring", "none", false};
    s.pair[Property::normalStiffness] = 1000;
    s.pair[Property::restitution] = 0.3;
    s.pair[Property::friction] = 0.3;
    s.model.domain = Box(Vec3::Constant(-0.1), Vec3::Constant(0.1));
    const double r = 1e-3;
    for (int n = 0; n < 3; ++n) s.grain(1e-5, r, {0, 0, (2 * n + 1) * r});
    s.plane({0, 0, 0}, {0, 0, 1});
    s.plane({0, 0, 6 * r}, {0, 0, -1}, WallMotion({{Translation{{0, 0, -0.01}}, 0, 0.03}}));
    s.model.sinks.push_back({"trap", {BoxRegion{{-1, -1, -1}, {1, 1, 0.95 * r}}}});
    Simulation sim = s.start(2e-6);
    for (int n = 0; n < 60; ++n) {
      sim.advance(500);
      sim.ledger();
    }
    const Ledger end = sim.ledger();
    EXPECT_GE(sim.counts().removed, 1u);
    EXPECT_GT(end.removed, 1e-6);  // 50 µm on 1 kN/m below, as much above
    EXPECT_LT(end.residualFraction(), 0.01) << nameOf(integrator);
  }
}

}  // namespace
}  // namespace tsubu::sim::test
