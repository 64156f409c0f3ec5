// Drag, buoyancy and global damping against the closed forms of a lone grain; the account of energy; the limit of the time step.

#include "sim/fields/drag.h"

#include <complex>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "verification/models.h"

namespace tsubu::sim::test {
namespace {

const double mass = 3e-5, radius = 1.7e-3;
const Vec3 gravity{0.5, -1, -9.5};

Scenario lone(const Vec3& position, const Vec3& velocity, const Vec3& spin = Vec3::Zero()) {
  Scenario s;
  s.model.contact = {"linear", "spring", "none", false};
  s.pair[Property::normalStiffness] = 1000;
  s.pair[Property::restitution] = 0.5;
  s.pair[Property::friction] = 0.5;
  s.model.domain = Box(Vec3::Constant(-10), Vec3::Constant(10));
  s.model.watch.travelLimit = 1;
  s.grain(mass, radius, position, velocity, spin);
  return s;
}

Snapshot after(const Scenario& scenario, double dt, double until) {
  Scenario s = scenario;
  Simulation sim = s.start(dt);
  sim.advance(static_cast<std::uint64_t>(std::lround(until / dt)));
  return look(sim);
}

// Stokes' drag, a constant coefficient, wind, weight and buoyancy: v − v∞ falls off as exp(−t/τ), τ = m/c, v∞ = u + τ g (1 − ρ_f/ρ).
TEST(Drag, LinearApproachesTheTerminalVelocity) {
  const Vec3 wind{0.3, 0, 0.1}, v0{-0.2, 0.4, 0.6};
  Scenario s = lone({0.1, 0.2, 0.3}, v0);
  s.model.gravity = gravity;
  Drag drag;
  drag.flow = UniformFlow{wind};
  drag.viscosity = 0.02, drag.coefficient = 2e-4, drag.density = 400;
  s.model.fields.drag = drag;
  const double volume = 4.0 / 3.0 * pi * std::pow(radius, 3), c = 6 * pi * 0.02 * radius + 2e-4, tau = mass / c;
  const Vec3 terminal = wind + tau * (1 - 400 * volume / mass) * gravity;
  const double t = 0.06;
  ASSERT_LT(t, 2 * tau);
  const Vec3 v = terminal + std::exp(-t / tau) * (v0 - terminal);
  const Vec3 x = Vec3(0.1, 0.2, 0.3) + t * terminal + tau * (1 - std::exp(-t / tau)) * (v0 - terminal);
  double before = 0;
  for (const double dt : {1e-3, 2.5e-4}) {
    const Snapshot end = after(s, dt, t);
    const double error = (end.velocity[0] - v).norm() / v.norm() + (end.position[0] - x).norm() / x.norm();
    if (before > 0) {
      EXPECT_GT(before / error, 13);  // second order
      EXPECT_LT(error, 5e-5);
    }
    before = error;
  }
  EXPECT_LT((after(s, 1e-3, 40 * tau).velocity[0] - terminal).norm(), 1e-12);
}

// From rest under quadratic drag: v = v∞ tanh(g' t/v∞), v∞² = 2 m g'/(ρ_f C_d π r²).
TEST(Drag, QuadraticFallsAsAHyperbolicTangent) {
  Scenario s = lone(Vec3::Zero(), Vec3::Zero());
  s.model.gravity = gravity;
  Drag drag;
  drag.dragCoefficient = 0.44, drag.density = 300;
  s.model.fields.drag = drag;
  const double volume = 4.0 / 3.0 * pi * std::pow(radius, 3), g = gravity.norm() * (1 - 300 * volume / mass);
  const double terminal = std::sqrt(2 * mass * g / (300 * 0.44 * pi * radius * radius));
  double before = 0;
  for (const double dt : {8e-4, 2e-4}) {
    const double error = std::abs(after(s, dt, 0.08).velocity[0].norm() / (terminal * std::tanh(g * 0.08 / terminal)) - 1);
    if (before > 0) {
      EXPECT_GT(before / error, 13);
      EXPECT_LT(error, 1e-5);
    }
    before = error;
  }
  EXPECT_NEAR(after(s, 1e-3, 4).velocity[0].norm() / terminal, 1, 1e-10);
  s.model.fields.drag->buoyancy = false;
  EXPECT_NEAR(after(s, 1e-3, 4).velocity[0].norm(), terminal * std::sqrt(gravity.norm() / g), 1e-10);
}

// A grain in a rigid vortex: z″ = −γ (z′ − iΩz) in the complex plane, two exponentials; it drifts outward.
TEST(Drag, SpiralsOutOfAVortex) {
  using Complex = std::complex<double>;
  Scenario s = lone({0.02, 0.01, 0}, {0.05, -0.1, 0.2});
  Drag drag;
  drag.flow = VortexFlow{{0, 0, 5}, {0, 0, 2}, 30};
  drag.viscosity = 0.02;
  s.model.fields.drag = drag;
  const double gamma = 6 * pi * 0.02 * radius / mass, t = 0.1;
  const Complex root = std::sqrt(Complex(0.25 * gamma * gamma, gamma * 30)), l1 = -0.5 * gamma + root, l2 = -0.5 * gamma - root;
  const Complex z0(0.02, 0.01), w0(0.05, -0.1), a = (w0 - l2 * z0) / (l1 - l2), z = a * std::exp(l1 * t) + (z0 - a) * std::exp(l2 * t);
  double before = 0;
  for (const double dt : {8e-4, 2e-4}) {
    const Snapshot end = after(s, dt, t);
    const double error = std::abs(Complex(end.position[0].x(), end.position[0].y()) - z);
    if (before > 0) {
      EXPECT_GT(before / error, 13);
      EXPECT_LT(error, 1e-6);
    }
    before = error;
  }
}

// In the end a grain goes with the layer of a pipe or of a shear flow in which it floats, and turns with half the curl.
TEST(Drag, FloatsAndTurnsWithItsLayer) {
  Drag drag;
  drag.viscosity = 0.05;
  drag.flow = PipeFlow{{0, 0, 0}, {1, 0, 0}, 0.03, 0.4};
  Scenario s = lone({-1, 0.01, 0.02}, {0.1, 0, 0}, {5, -7, 9});
  s.model.fields.drag = drag;
  const Snapshot pipe = after(s, 2e-4, 0.4);
  EXPECT_LT((pipe.velocity[0] - 0.4 * (1 - 5.0 / 9) * Vec3::UnitX()).norm(), 1e-9);
  // ½∇×u = −(U/R²) ρ × a
  EXPECT_LT((pipe.angularVelocity[0] + 0.4 / 9e-4 * Vec3(0, 0.01, 0.02).cross(Vec3::UnitX())).norm(), 1e-7);

  s.model.fields.drag->flow = ShearFlow{{0, 0, -1}, {0, 1, 0}, {0, 0, 1}, 0.5};
  const Snapshot shear = after(s, 2e-4, 0.4);
  EXPECT_LT((shear.velocity[0] - Vec3(0, 0.51, 0)).norm(), 1e-9);
  EXPECT_LT((shear.angularVelocity[0] - Vec3(-0.25, 0, 0)).norm(), 1e-7);
}

// 8πμr³ (Kirchhoff) against I: the spin falls off as exp(−20πμr t/m); without the torque it stays.
TEST(Drag, TheFluidStopsTheSpin) {
  Scenario s = lone(Vec3::Zero(), Vec3::Zero(), {30, -40, 10});
  Drag drag;
  drag.viscosity = 0.01;
  s.model.fields.drag = drag;
  const double t = 0.02, fall = std::exp(-20 * pi * 0.01 * radius / mass * t);
  EXPECT_LT((after(s, 1e-4, t).angularVelocity[0] - fall * Vec3(30, -40, 10)).norm(), 2e-4 * 51);
  s.model.fields.drag->torque = false;
  EXPECT_LT((after(s, 1e-4, t).angularVelocity[0] - Vec3(30, -40, 10)).norm(), 1e-12);
}

// Article's m x″ + C x′ = 0 and I θ″ + D θ′ = 0.
TEST(GlobalDamping, TakesSpeedAndSpin) {
  Scenario s = lone(Vec3::Zero(), {1, -2, 0.5}, {30, -40, 10});
  const double inertia = 0.4 * mass * radius * radius, t = 0.1;
  s.model.fields.damping = GlobalDamping{1e-4, 0.3 * inertia / t, 4};
  const Snapshot end = after(s, 1e-4, t);
  EXPECT_LT((end.velocity[0] - std::exp(-1e-4 / mass * t - 4 * t) * Vec3(1, -2, 0.5)).norm(), 1e-6);
  EXPECT_LT((end.angularVelocity[0] - std::exp(-0.3 - 4 * t) * Vec3(30, -40, 10)).norm(), 1e-4);
}

/// Grains of two sizes in a box that turns in the sense of gravity, in a vortex, with everything of this file.
Scenario crowd(Integrator integrator) {
  Scenario s = lone({0, 0, 8e-3}, {0.3, 0.2, 0.1}, {50, 0, 0});
  s.model.integrator = integrator;
  s.model.gravity = {0, 0, -9.81};
  Random random(5, 2);
  for (int n = 0; n < 26; ++n) {
    const double r = n % 2 ? 1.2e-3 : 0.8e-3;
    const Vec3 x = 4e-3 * Vec3(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
    s.grain(8000 * r * r * r, r, x, Vec3(random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3)), {0, 60, 0});
  }
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) s.plane(-side * 0.011 * Vec3::Unit(axis), side * Vec3::Unit(axis));
  Drag drag;
  drag.flow = VortexFlow{Vec3::Zero(), {0, 0, 1}, 40};
  drag.viscosity = 2e-3, drag.dragCoefficient = 0.44, drag.density = 900;
  s.model.fields.drag = drag;
  s.model.fields.damping = GlobalDamping{2e-6, 1e-13, 0.5};
  const double never = std::numeric_limits<double>::infinity();
  s.model.fields.gravity = {{GravityTurn{{0, 1, 0}, 20, never}, 0, never}, {GravityShake{{0, 4, 0}, 30, 0.4}, 0.01, never}};
  return s;
}

double residual(Integrator integrator, double dt) {
  Simulation sim = crowd(integrator).start(dt);
  for (int n = 0; n < 20; ++n) {
    sim.advance(static_cast<std::uint64_t>(std::lround(3e-3 / dt)));
    sim.ledger();
  }
  const Ledger end = sim.ledger();
  EXPECT_GT(end.dissipatedDrag, 0.01 * end.turnover);
  EXPECT_GT(std::abs(end.workFields), 0.01 * end.turnover);
  return end.residualFraction();
}

TEST(Drag, LedgerClosesAtTheOrderOfTheScheme) {
  for (const Integrator integrator : {Integrator::symplecticEuler, Integrator::velocityVerlet}) {
    const double coarse = residual(integrator, 4e-6), fine = residual(integrator, 1e-6), order = std::log(coarse / fine) / std::log(4.0);
    const bool verlet = integrator == Integrator::velocityVerlet;
    fmt::print("  ledger residual with drag, damping and gravity that changes, {}: {:.2e} at 4 µs, {:.2e} at 1 µs, order {:.2f}\n",
               verlet ? "velocity Verlet" : "symplectic Euler", coarse, fine, order);
    EXPECT_LT(fine, verlet ? 1e-4 : 1e-2);
    EXPECT_GT(order, verlet ? 1.5 : 0.7);
  }
}

TEST(Drag, AnyNumberOfThreadsTheSameBits) {
  std::uint64_t hash = 0;
  for (const int threads : {1, 2, 3}) {
    Simulation sim = crowd(Integrator::velocityVerlet).start(4e-6, threads);
    sim.advance(1500);
    if (threads == 1) hash = sim.stateHash();
    EXPECT_EQ(sim.stateHash(), hash) << threads;
  }
}

// S2 without a spring: c Δt/m < 1 in velocity Verlet, < 2 in symplectic Euler; the program blows up just beyond.
TEST(Drag, LimitsTheTimeStep) {
  for (const Integrator integrator : {Integrator::symplecticEuler, Integrator::velocityVerlet}) {
    Scenario s = lone(Vec3::Zero(), {0.1, 0, 0});
    s.model.integrator = integrator;
    s.pair[Property::normalStiffness] = 1e-3;
    s.model.pairs = PairTable(1);
    s.model.pairs.set(0, 0, s.pair);
    s.model.watch.stop = false;
    Drag drag;
    drag.coefficient = 50;
    s.model.fields.drag = drag;
    const TimeStepChoice choice = chooseTimeStep(s.model);
    EXPECT_EQ(choice.limitedBy, "drag of m0, smallest grains");
    EXPECT_NEAR(choice.limit, (integrator == Integrator::velocityVerlet ? 1 : 2) * mass / 50, 1e-10);
    EXPECT_LT(after(s, 0.99 * choice.limit, 5000 * choice.limit).velocity[0].norm(), 1e-10);
    EXPECT_THROW(after(s, 1.01 * choice.limit, 5000 * choice.limit), Error);
  }
}

// Quadratic drag grows with the speed: a grain that becomes too fast for the step is named.
TEST(Drag, TooFastForTheStepIsNamed) {
  Scenario s = lone(Vec3::Zero(), {400, 0, 0});
  s.model.watch.stop = false;
  Drag drag;
  drag.dragCoefficient = 1, drag.density = 1000;
  s.model.fields.drag = drag;
  try {
    after(s, 1e-4, 1e-3);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.diagnostics().front().message, "The drag would reverse a grain within one step: grain 0 at (0, 0, 0) m, t = 0 s.");
  }
}

}  // namespace
}  // namespace tsubu::sim::test
