// Walls with a mass: falling plates, pistons, a wall held at a constant force.

#include "sim/walls/moving_wall.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "verification/models.h"

namespace tsubu::sim::test {
namespace {

constexpr std::array integrators{Integrator::symplecticEuler, Integrator::velocityVerlet};

Scenario elastic(Integrator integrator, double stiffness, double restitution = 1) {
  Scenario s;
  s.model.integrator = integrator;
  s.pair[Property::normalStiffness] = stiffness;
  s.pair[Property::restitution] = restitution;
  s.pair[Property::friction] = 0.4;
  s.model.watch.travelLimit = 1;
  s.model.domain = Box(Vec3::Constant(-10), Vec3::Constant(10));
  return s;
}

// Nothing in the way: s = v₀ t + ½ (a·g + F/M) t² along an oblique axis; with a damping in the guide it approaches a constant speed.
TEST(MovingWall, FliesAsAProjectile) {
  const Vec3 g{1, -2, -9}, axis{1, 2, -2};  // of length 3
  const double t = 0.3, pull = g.dot(axis) / 3 + 0.9 / 0.4;
  for (const Integrator integrator : integrators) {
    Scenario s = elastic(integrator, 1000);
    s.model.gravity = g;
    s.plane({0, 0, -1}, {0, 0, 1}).body = WallBody{axis, 0.4, 0.9, true, 0, -0.7, 0};
    s.plane({0, 0, -2}, {0, 0, 1}).body = WallBody{{0, 0, 1}, 0.4, 0.9, false, 3.1, 0, 0.05};
    Simulation sim = s.start(1e-4);
    sim.advance(3000);
    const auto walls = sim.movingWalls();
    const double error = integrator == Integrator::velocityVerlet ? 1e-10 : 1e-3;
    EXPECT_NEAR(walls[0].way, -0.7 * t + 0.5 * pull * t * t, error);
    EXPECT_NEAR(walls[0].speed, -0.7 + pull * t, error);
    const double terminal = 0.9 / 3.1, tau = 0.4 / 3.1, since = t - 0.05;
    EXPECT_NEAR(walls[1].speed, terminal * (1 - std::exp(-since / tau)), 1e-4);
    EXPECT_NEAR(walls[1].way, terminal * (since - tau * (1 - std::exp(-since / tau))), 1e-4);
    EXPECT_LT((look(sim).walls[0].translation - walls[0].way * axis / 3).norm(), 1e-15);  // the picture follows
    EXPECT_LT(std::abs(sim.ledger().residual()), integrator == Integrator::velocityVerlet ? 1e-6 : 1e-3);
  }
}

// A plate hits a grain that floats: both momenta along the axis and, without loss, the energy, as two masses on a line.
TEST(MovingWall, CollidesAsAMass) {
  const double mass = 0.013, plate = 0.007, speed = -0.6;
  for (const Integrator integrator : integrators) {
    for (const double restitution : {1.0, 0.55}) {
      Scenario s = elastic(integrator, 2e4, restitution);
      s.grain(mass, 0.01, {0, 0, 0}, {0.1, 0, 0.2});
      s.plane({0, 0, 0.0101}, {0, 0, -1}).body = WallBody{{0, 0, 1}, plate, 0, false, 0, speed, 0};
      Simulation sim = s.start(1e-6);
      sim.advance(20000);
      const double v = look(sim).velocity[0].z(), w = sim.movingWalls()[0].speed;
      EXPECT_NEAR(mass * v + plate * w, mass * 0.2 + plate * speed, 1e-12);
      EXPECT_GT(w, v);
      EXPECT_NEAR(look(sim).velocity[0].x(), 0.1, 1e-14);
      EXPECT_NEAR((w - v) / (0.2 - speed), restitution, 5e-4);
      const Ledger end = sim.ledger();
      EXPECT_LT(std::abs(end.residual()), (integrator == Integrator::velocityVerlet ? 1e-5 : 2e-3) * end.initial);
    }
  }
}

/// The time between two passages of the mean height upwards.
double periodOf(Simulation& sim, double mean, double dt) {
  double first = 0, last = 0, before = sim.movingWalls()[0].way;
  int passages = 0;
  for (int n = 0; n < 40000; ++n) {
    sim.advance(1);
    const double now = sim.movingWalls()[0].way;
    if (before < mean && now >= mean) {
      const double t = sim.time() - dt * (now - mean) / (now - before);
      if (passages == 0) first = t;
      last = t;
      ++passages;
    }
    before = now;
  }
  return (last - first) / (passages - 1);
}

// A piston of mass M on a grain of mass m ≪ M on a floor: two springs in series under the piston. The exact period is that of the slow
// mode of the chain: M s″ = −k (s − x), m x″ = −k (2x − s).
TEST(MovingWall, PistonOnAGrainSwings) {
  const double k = 3000, m = 0.002, piston = 0.11, g = 9.3, dt = 2e-5;
  const double a = k / piston, b = 2 * k / m, c = k / m;  // (ω² − a)(ω² − b) = a c
  const double slow = 0.5 * (a + b) - std::sqrt(0.25 * (a - b) * (a - b) + a * c);
  for (const Integrator integrator : integrators) {
    Scenario s = elastic(integrator, k);
    s.model.gravity = {0, 0, -g};
    const double sunk = piston * g / k;
    s.grain(m, 0.01, {0, 0, 0.01 - 1.4 * sunk});
    s.plane({0, 0, 0}, {0, 0, 1});
    s.plane({0, 0, 0.02 - 2.8 * sunk}, {0, 0, -1}).body = WallBody{{0, 0, 1}, piston, 0, true, 0, 0, 0};
    Simulation sim = s.start(dt);
    // At rest the floor carries both, the piston's contact the piston alone.
    const double rest = 0.8 * sunk - m * g / k;
    EXPECT_NEAR(periodOf(sim, rest, dt), 2 * pi / std::sqrt(slow), 2e-4 * 2 * pi / std::sqrt(slow));
    EXPECT_LT(sim.ledger().residualFraction(), integrator == Integrator::velocityVerlet ? 1e-4 : 1e-2);
  }
}

// Held at a constant force: at rest the overlap is F/k, whatever the wall weighs.
TEST(MovingWall, HoldsAConstantForce) {
  Scenario s = elastic(Integrator::velocityVerlet, 5000, 0.3);
  s.model.gravity = {0, 0, -9.81};
  const double r = 0.008;
  s.grain(0.004, r, {r, 0, 0});
  s.plane({0, 0, -r}, {0, 0, 1});
  s.plane({0, 0, 0}, {1, 0, 0});
  s.plane({2 * r, 0, 0}, {-1, 0, 0}).body = WallBody{{-1, 0, 0}, 0.05, 2.7, false, 8, 0, 0};
  Simulation sim = s.start(1e-5);
  sim.advance(60000);
  const WallState wall = sim.movingWalls()[0];
  EXPECT_NEAR(wall.load, -2.7, 1e-9);
  EXPECT_NEAR(wall.speed, 0, 1e-12);
  EXPECT_NEAR(wall.way, 2 * 2.7 / 5000, 1e-9);  // two contacts, each F/k
  EXPECT_LT(sim.ledger().residualFraction(), 1e-4);
}

/// A lid falls into a cloud in a box that shakes, everything switched on.
Scenario lidOnACloud(Integrator integrator) {
  Scenario s = elastic(integrator, 3e4, 0.6);
  s.model.contact = {"linear", "spring", "none", false};
  s.model.gravity = {0, 0, -9.81};
  s.model.fields.gravity = {{GravityShake{{0, 0, 6}, 35, 0.3}, 0, std::numeric_limits<double>::infinity()}};
  Random random(9, 1);
  for (int n = 0; n < 27; ++n) {
    const double r = random.uniform(0.7e-3, 1.6e-3);
    s.grain(9000 * r * r * r, r, 4e-3 * Vec3(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1),
            Vec3(random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), -0.2), {0, 90, 0});
  }
  for (int axis = 0; axis < 2; ++axis)
    for (const double side : {-1.0, 1.0}) s.plane(-side * 0.009 * Vec3::Unit(axis), side * Vec3::Unit(axis));
  s.plane({0, 0, -7e-3}, {0, 0, 1});
  s.plane({0, 0, 8e-3}, {0, 0, -1}).body = WallBody{{0, 0, 2}, 4e-4, -1e-3, true, 2e-3, -0.1, 0};
  return s;
}

double residual(Integrator integrator, double dt) {
  Simulation sim = lidOnACloud(integrator).start(dt);
  for (int n = 0; n < 20; ++n) {
    sim.advance(static_cast<std::uint64_t>(std::lround(3e-3 / dt)));
    sim.ledger();
  }
  EXPECT_GT(std::abs(sim.movingWalls()[0].way), 1e-3);
  return sim.ledger().residualFraction();
}

TEST(MovingWall, LedgerClosesAtTheOrderOfTheScheme) {
  for (const Integrator integrator : integrators) {
    const double coarse = residual(integrator, 2e-6), fine = residual(integrator, 5e-7), order = std::log(coarse / fine) / std::log(4.0);
    const bool verlet = integrator == Integrator::velocityVerlet;
    fmt::print("  ledger residual under a lid, {}: {:.2e} at 2 µs, {:.2e} at 0.5 µs, order {:.2f}\n",
               verlet ? "velocity Verlet" : "symplectic Euler", coarse, fine, order);
    EXPECT_LT(fine, verlet ? 1e-4 : 1e-2);
    EXPECT_GT(order, verlet ? 1.5 : 0.7);
  }
}

TEST(MovingWall, AnyNumberOfThreadsTheSameBits) {
  std::uint64_t hash = 0;
  for (const int threads : {1, 2, 3}) {
    Simulation sim = lidOnACloud(Integrator::velocityVerlet).start(2e-6, threads);
    sim.advance(8000);
    if (threads == 1) hash = sim.stateHash();
    EXPECT_EQ(sim.stateHash(), hash) << threads;
  }
}

// A lid lighter than what its contacts and the step can bear together is named instead of taking off.
TEST(MovingWall, TooLightIsNamed) {
  Scenario s = elastic(Integrator::velocityVerlet, 5000);
  for (int n = 0; n < 9; ++n) s.grain(0.004, 0.008, 0.017 * Vec3(n % 3, n / 3, 0));
  s.plane({0, 0, -0.0079}, {0, 0, 1}).body = WallBody{{0, 0, 1}, 1e-6, 0, false, 0, 0, 0};
  try {
    s.start(1e-5);  // ω Δt = √(9·5000/1e-6)·1e-5 = 2.1
    FAIL();
  } catch (const Error& error) {
    EXPECT_TRUE(error.diagnostics().front().message.starts_with("Wall 'plane0' is too light for 9 contacts at once"))
        << error.diagnostics().front().message;
  }
}

}  // namespace
}  // namespace tsubu::sim::test
