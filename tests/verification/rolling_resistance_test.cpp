// Rolling resistance of a sphere on a plane: spin about the normal, rolling to a stop, and an incline.

#include <gtest/gtest.h>

#include "verification/models.h"

namespace tsubu::sim::test {
namespace {

constexpr double k = 5e4, mass = 2e-4, radius = 2.5e-3, g = 9.81, dt = 2e-6;

/// A sphere that rests on a plane inclined by `theta`, downhill along +x turned.
Scenario resting(const std::string& law, double rollingFriction, double theta, double speed) {
  Scenario s;
  s.model.contact = {"linear", "spring", law, false};
  s.model.gravity = {0, 0, -g};
  s.pair[Property::normalStiffness] = k;
  s.pair[Property::restitution] = 0.5;
  s.pair[Property::friction] = 0.9;
  s.pair[Property::rollingFriction] = rollingFriction;
  const Vec3 n(std::sin(theta), 0, std::cos(theta)), down(std::cos(theta), 0, -std::sin(theta));
  s.grain(mass, radius, (radius - mass * g * std::cos(theta) / k) * n, speed * down, {0, speed / radius, 0});
  s.plane({0, 0, 0}, n);
  return s;
}

Vec3 downhill(double theta) { return {std::cos(theta), 0, -std::sin(theta)}; }

// Spin about the normal: constant torque μ_r r m g against 2/5 m r²: ω = ω0 − 5 μ_r g t/2r (R1).
TEST(RollingResistance, ConstantTorqueBrakesSpin) {
  const double mu = 0.05, spin = 300;
  Scenario s = resting("constant", mu, 0, 0);
  s.model.grains[0].angularVelocity = {0, 0, spin};
  Simulation sim = s.start(dt);
  sim.advance(20000);
  EXPECT_NEAR(look(sim).angularVelocity[0].z(), spin - 2.5 * mu * g * sim.time() / radius, 0.01 * spin);
  sim.advance(800000);  // 0.61 s to stop
  EXPECT_NEAR(look(sim).angularVelocity[0].z(), 0, 1e-9 * spin);
}

// Rolling: the deceleration is 5/7 μ_r g, the way to a stop v0²/(2·5/7 μ_r g).
TEST(RollingResistance, BothLawsRollToAStop) {
  const double mu = 0.1, v0 = 0.2, deceleration = 5.0 / 7 * mu * g;
  for (const char* law : {"constant", "elastic_plastic"}) {
    Simulation sim = resting(law, mu, 0, v0).start(dt);
    const double stop = v0 / deceleration;
    sim.advance(static_cast<std::uint64_t>(0.5 * stop / dt));
    EXPECT_NEAR(look(sim).velocity[0].x(), 0.5 * v0, 0.01 * v0) << law;
    sim.advance(static_cast<std::uint64_t>(1.0 * stop / dt));
    const Snapshot now = look(sim);
    EXPECT_NEAR(now.velocity[0].norm(), 0, 2e-3 * v0) << law;
    EXPECT_NEAR(now.position[0].x(), 0.5 * v0 * v0 / deceleration, 0.01 * 0.5 * v0 * v0 / deceleration) << law;
  }
}

// On an incline: at rest for μ_r ≥ tan θ, else 5/7 g (sin θ − μ_r cos θ).
TEST(RollingResistance, InclineHoldsOrRolls) {
  const double mu = 0.2;
  for (const char* law : {"constant", "elastic_plastic"}) {
    const double steep = std::atan(0.3);
    Simulation rolls = resting(law, mu, steep, 0).start(dt);
    rolls.advance(25000);
    const double v0 = look(rolls).velocity[0].dot(downhill(steep)), t0 = rolls.time();
    rolls.advance(25000);
    const double acceleration = (look(rolls).velocity[0].dot(downhill(steep)) - v0) / (rolls.time() - t0);
    EXPECT_NEAR(acceleration, 5.0 / 7 * g * (std::sin(steep) - mu * std::cos(steep)), 0.01 * g * std::sin(steep)) << law;
  }
  // Only the law with a memory stands still; constant torque acts against a spin that is there and lets the grain creep.
  const double gentle = std::atan(0.15);
  Simulation stands = resting("elastic_plastic", mu, gentle, 0).start(dt);
  stands.advance(200000);
  const Snapshot before = look(stands);
  stands.advance(200000);
  const Snapshot after = look(stands);
  EXPECT_LT((after.position[0] - before.position[0]).norm(), 1e-9 * radius);
  EXPECT_LT(after.velocity[0].norm(), 1e-9);
  EXPECT_NEAR(after.position[0].dot(downhill(gentle)), 0, 0.05 * radius);
}

}  // namespace
}  // namespace tsubu::sim::test
