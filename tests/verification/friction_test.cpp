// Sliding and sticking: the linear law with Coulomb friction against rigid-body formulas (Note; Chung & Ooi 2011, tests 5 to 8, as
// far as they do not ask for Hertz's stiffness).

#include <gtest/gtest.h>

#include "core/error.h"
#include "verification/models.h"

namespace tsubu::sim::test {
namespace {

constexpr double k = 5e5, kt = 2e5, mass = 2e-4, radius = 2.5e-3;

Scenario frictional(double mu, double e) {
  Scenario s;
  s.model.contact = {"linear", "spring", "none", false};
  s.pair[Property::normalStiffness] = k;
  s.pair[Property::tangentialStiffness] = kt;
  s.pair[Property::restitution] = e;
  s.pair[Property::friction] = mu;
  return s;
}

struct Impact {
  Vec3 velocity, spin;
};

/// One impact on the plane z = 0.
Impact onPlane(Scenario s, const Vec3& velocity, const Vec3& spin, double share = 0.01) {
  const double dt = share * contactDuration(k, mass, s.pair[Property::restitution], false);
  s.grain(mass, radius, {0, 0, radius - 0.4 * dt * velocity.z()}, velocity, spin);
  s.plane({0, 0, 0}, {0, 0, 1});
  Simulation sim = s.start(dt);
  sim.advance(static_cast<std::uint64_t>(1.5 / share));
  const Snapshot now = look(sim);
  return {now.velocity[0], now.angularVelocity[0]};
}

// Sliding all the way, the tangential impulse is μ times the normal one: v_t' = v_t − μ(1 + e) v_n, rω' = rω + 5/2 μ(1 + e) v_n,
// when v_t is above 7/2 μ(1 + e) v_n. Lever arms are shorter than r by the overlap, here by 3e-3 r.
TEST(Oblique, GrossSliding) {
  for (const double e : {0.4, 0.9, 1.0}) {
    for (const double mu : {0.05, 0.2}) {
      const double vn = 0.35, jump = mu * (1 + e) * vn;
      const Vec3 along = Vec3(0.6, -0.8, 0), axis = Vec3::UnitZ().cross(along);
      for (const double vt : {3.8 * jump, 20 * jump}) {
        const Impact after = onPlane(frictional(mu, e), vt * along + Vec3(0, 0, -vn), Vec3::Zero());
        EXPECT_NEAR(after.velocity.dot(along), vt - jump, 3e-3 * jump);
        EXPECT_NEAR(after.spin.dot(axis) * radius, 2.5 * jump, 5e-3 * 2.5 * jump);
        EXPECT_NEAR(after.velocity.z(), e * vn, 1e-3 * vn);
        EXPECT_NEAR(after.velocity.dot(axis), 0, 1e-12);
      }
    }
  }
}

// A sticking contact is a pair of springs: the slip swings as cos √(7k_t/2m) t over the π√(m/k) of the contact, so
// v_t' = v_t − 2/7 (s_0 − s_1) with s_1 = s_0 cos(π √(7k_t/2k)), rω' = rω + 5/7 (s_0 − s_1) with s the slip, v_t − rω.
TEST(Oblique, StickingElastic) {
  for (const double spin : {0.0, 120.0, -55.0}) {
    const double vt = 0.21, vn = 0.05;
    Scenario s = frictional(1e9, 1);
    const Impact after = onPlane(s, {vt, 0, -vn}, {0, spin, 0}, 0.0025);
    const double before = vt - radius * spin, left = before * std::cos(pi * std::sqrt(3.5 * kt / k));
    EXPECT_NEAR(after.velocity.x(), vt - 2.0 / 7 * (before - left), 3e-3 * std::abs(before));
    EXPECT_NEAR(after.spin.y() * radius, radius * spin + 5.0 / 7 * (before - left), 6e-3 * std::abs(before));
  }
}

// The same, with two grains of different mass and radius, their line oblique in space. m*: the slip obeys 7/2 k_t/m* for any radii.
TEST(Oblique, StickingElasticPair) {
  const double m1 = 1.1e-4, m2 = 5e-4, r1 = 1.9e-3, r2 = 3.4e-3, effective = m1 * m2 / (m1 + m2), vn = 0.03;
  const Vec3 n = Vec3(0.5, 0.4, -0.7).normalized(), t = n.unitOrthogonal(), axis = n.cross(t);
  const double dt = contactDuration(k, effective, 1, false) / 400;
  Scenario s = frictional(1e9, 1);
  s.grain(m1, r1, (r1 + r2 + 0.5 * dt * vn) * n, -vn * n + 0.11 * t, 30 * axis);
  s.grain(m2, r2, Vec3::Zero(), Vec3::Zero(), -12 * axis);
  Simulation sim = s.start(dt);
  sim.advance(500);
  const Snapshot now = look(sim);
  // v_t = v·t − (r1 ω1 + r2 ω2)·(n × t): a spin about `axis` moves the surface of 1 along −n × … = t at its contact point.
  const double before = 0.11 - (r1 * 30 + r2 * -12) * axis.cross(n).dot(t), left = before * std::cos(pi * std::sqrt(3.5 * kt / k));
  const double impulse = 2.0 / 7 * effective * (left - before);
  EXPECT_NEAR(now.velocity[0].dot(t), 0.11 + impulse / m1, 5e-3 * std::abs(impulse) / m1);
  EXPECT_NEAR(now.velocity[1].dot(t), -impulse / m2, 5e-3 * std::abs(impulse) / m2);
  // T_i = −l_i n × F_t on both (the Article and Bond (12) give j the opposite sign).
  EXPECT_NEAR(now.angularVelocity[0].dot(axis), 30 - impulse * r1 / (0.4 * m1 * r1 * r1), 1e-2 * std::abs(impulse / (0.4 * m1 * r1)));
  EXPECT_NEAR(now.angularVelocity[1].dot(axis), -12 - impulse * r2 / (0.4 * m2 * r2 * r2), 1e-2 * std::abs(impulse / (0.4 * m2 * r2)));
}

// A pair that rolls on each other like gears has no slip: v_t of (1.12) vanishes, where the Article's plus sign would brake it.
TEST(Oblique, MeshingGrainsFeelNothing) {
  const double r1 = 1e-3, r2 = 3e-3, dt = 1e-6;
  Scenario s = frictional(0.5, 0.5);
  s.grain(1e-5, r1, {0, 0, 0}, {0, 0, 0}, {0, 0, 30});
  s.grain(1e-3, r2, {r1 + r2 - 1e-8, 0, 0}, {0, 0, 0}, {0, 0, -10});
  Simulation sim = s.start(dt);
  sim.advance(50);
  const Snapshot now = look(sim);
  EXPECT_NEAR(now.angularVelocity[0].z(), 30, 1e-3);
  EXPECT_NEAR(now.angularVelocity[1].z(), -10, 1e-3);
  EXPECT_NEAR(now.velocity[0].y(), 0, 1e-6);
}

// Chung & Ooi 6: a spinning sphere dropped on a plane; sliding limit rω'/(μv_n) → rω/(μv_n) − 5/2 (1 + e).
TEST(ChungOoi, SpinningSphereOnPlane) {
  const double vn = 0.2, mu = 0.4, e = 0.5, spin = -12 * mu * vn / radius;
  const Impact after = onPlane(frictional(mu, e), {0, 0, -vn}, {0, spin, 0});
  EXPECT_NEAR(after.spin.y() * radius / (mu * vn), -12 + 2.5 * (1 + e), 2e-2);
  EXPECT_NEAR(after.velocity.x() / (mu * vn), -(1 + e), 1e-2);
}

// Chung & Ooi 7: equal spheres with opposite spins meet head-on: their surfaces move alike, and nothing happens across.
TEST(ChungOoi, OppositeSpinsMeetWithoutSlip) {
  Scenario s = frictional(0.4, 0.5);
  const double dt = contactDuration(k, mass / 2, 0.5, false) / 100;
  s.grain(mass, radius, {0, 0, 0}, {0.2, 0, 0}, {0, 0, 175});
  s.grain(mass, radius, {2 * radius + 1e-6, 0, 0}, {-0.2, 0, 0}, {0, 0, -175});
  Simulation sim = s.start(dt);
  sim.advance(200);
  const Snapshot now = look(sim);
  for (int i : {0, 1}) {
    EXPECT_NEAR(now.velocity[static_cast<std::size_t>(i)].y(), 0, 1e-15);
    EXPECT_NEAR(now.angularVelocity[static_cast<std::size_t>(i)].z(), i == 0 ? 175 : -175, 1e-10);
  }
  EXPECT_NEAR(now.velocity[0].x(), -0.1, 1e-3);
}

// Chung & Ooi 8: on a sphere a million times heavier the small one bounces as on a plane.
TEST(ChungOoi, SmallOnLargeIsSmallOnPlane) {
  const double vn = 0.2, mu = 0.4, e = 0.5, spin = 80, dt = contactDuration(k, mass, e, false) / 100;
  const Impact plane = onPlane(frictional(mu, e), {0.05, 0, -vn}, {0, spin, 0});
  Scenario s = frictional(mu, e);
  s.grain(mass, radius, {0, 0, radius + 0.4 * dt * vn}, {0.05, 0, -vn}, {0, spin, 0});
  s.grain(1e6 * mass, 100 * radius, {0, 0, -100 * radius});
  Simulation sim = s.start(dt);
  sim.advance(150);
  const Snapshot now = look(sim);
  EXPECT_LT((now.velocity[0] - plane.velocity).norm(), 2e-3 * vn);
  EXPECT_LT((now.angularVelocity[0] - plane.spin).norm() * radius, 5e-3 * vn);
}

// A sphere thrown along a plane slides with u = u0 − μgt, rω = 5/2 μgt, and rolls from t = 2u0/(7μg) on at 5/7 u0.
TEST(Plane, SlipTurnsIntoRolling) {
  const double g = 9.81, mu = 0.3, u0 = 0.5, sink = mass * g / k, dt = 1e-6;
  Scenario s = frictional(mu, 0.5);
  s.model.gravity = {0, 0, -g};
  s.grain(mass, radius, {0, 0, radius - sink}, {u0, 0, 0});
  s.plane({0, 0, 0}, {0, 0, 1});
  Simulation sim = s.start(dt);
  const double rolling = 2 * u0 / (7 * mu * g);
  sim.advance(static_cast<std::uint64_t>(0.5 * rolling / dt));
  Snapshot now = look(sim);
  EXPECT_NEAR(now.velocity[0].x(), u0 - mu * g * sim.time(), 1e-3 * u0);
  EXPECT_NEAR(now.angularVelocity[0].y() * radius, 2.5 * mu * g * sim.time(), 1e-3 * u0);
  sim.advance(static_cast<std::uint64_t>(1.0 * rolling / dt));
  now = look(sim);
  EXPECT_NEAR(now.velocity[0].x(), 5.0 / 7 * u0, 1e-3 * u0);
  EXPECT_NEAR(now.angularVelocity[0].y() * radius, 5.0 / 7 * u0, 1e-3 * u0);
}

// On an incline a sphere rolls with 5/7 g sin θ below tan θ = 7/2 μ, and slips with g (sin θ − μ cos θ) above.
TEST(Plane, InclineRollsOrSlips) {
  const double g = 9.81, dt = 2e-6;
  for (const double mu : {0.1, 0.4}) {
    for (const double degrees : {5.0, 15.0, 25.0, 50.0}) {
      const double theta = degrees * pi / 180;
      Scenario s = frictional(mu, 0.5);
      const Vec3 n(std::sin(theta), 0, std::cos(theta)), down(std::cos(theta), 0, -std::sin(theta));
      s.model.gravity = {0, 0, -g};
      s.grain(mass, radius, (radius - mass * g * std::cos(theta) / k) * n);
      s.plane({0, 0, 0}, n);
      Simulation sim = s.start(dt);
      sim.advance(20000);
      const double first = look(sim).velocity[0].dot(down), t0 = sim.time();
      sim.advance(20000);
      const double acceleration = (look(sim).velocity[0].dot(down) - first) / (sim.time() - t0);
      const bool rolls = std::tan(theta) < 3.5 * mu;
      const double expected = rolls ? 5.0 / 7 * g * std::sin(theta) : g * (std::sin(theta) - mu * std::cos(theta));
      EXPECT_NEAR(acceleration, expected, 1e-3 * expected) << "mu " << mu << ", " << degrees << " degrees";
    }
  }
}

// Random impacts, oblique and spinning, grazing and head-on, on planes and between unequal grains: energy never grows, and what
// friction took is never less than nothing.
TEST(Oblique, EnergyNeverGrows) {
  for (const Integrator integrator : {Integrator::velocityVerlet, Integrator::symplecticEuler}) {
    Random random(11, 4);
    for (int n = 0; n < 300; ++n) {
      const double e = n % 3 == 0 ? 1 : random.uniform(0.1, 1), mu = std::pow(10.0, random.uniform(-2, 1));
      Scenario s = frictional(mu, e);
      s.model.integrator = integrator;
      s.model.contact.tension = n % 2 == 0;
      if (n % 5 == 0) s.pair[Property::tangentialDampingRate] = random.uniform(0, 2e4);
      const double m2 = mass * std::pow(10.0, random.uniform(-2, 2)), r2 = radius * random.uniform(0.2, 3);
      const double dt = contactDuration(k, mass * m2 / (mass + m2), e, true) / 100;
      const double angle = random.uniform(0, 0.5 * pi) * (n % 4 == 0 ? 0.05 : 1), v = 0.5;  // every fourth grazes
      const Vec3 axis = Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)).normalized(),
                 across = axis.unitOrthogonal();
      const double gap = 0.5 * v * std::sin(angle) * dt;
      const auto spin = [&] { return Vec3(random.uniform(-200, 200), random.uniform(-200, 200), random.uniform(-200, 200)); };
      s.grain(mass, radius, (radius + r2 + gap) * axis, v * (std::cos(angle) * across - std::sin(angle) * axis), spin());
      s.grain(m2, r2, Vec3::Zero(), Vec3::Zero(), spin());
      Simulation sim = s.start(dt);
      const double before = sim.ledger().kinetic();
      sim.advance(400);
      const Ledger after = sim.ledger();
      // The scheme's own errors: (ωΔt)²/24 = 4e-5 for Verlet, ωΔt/2 of what is exchanged for Euler.
      const double error = integrator == Integrator::velocityVerlet ? 1e-4 : 3e-3;
      EXPECT_LE(after.kinetic() + after.elastic(), before * (1 + error)) << n;
      EXPECT_GE(after.dissipatedFriction, -1e-12 * before) << n;
      EXPECT_GE(after.dissipatedNormal, -1e-12 * before) << n;
      EXPECT_GE(after.dissipatedTangential, -1e-12 * before) << n;
    }
  }
}

/// A sphere on an incline that is held from turning.
Scenario onIncline(Integrator integrator, double angle, double mu) {
  Scenario s = frictional(mu, 0.3);
  s.model.contact.rotation = false;
  s.model.integrator = integrator;
  const double g = 9.81;
  s.model.gravity = {g * std::sin(angle), 0, -g * std::cos(angle)};
  s.model.domain = Box(Vec3::Constant(-1), Vec3::Constant(1));
  s.grain(mass, radius, {0, 0, radius - mass * g * std::cos(angle) / k}, {0, 0, 0}, {30, 40, 50});
  s.plane({0, 0, 0}, {0, 0, 1});
  return s;
}

// A block: a = g (sin α − μ cos α) above the angle of friction, at rest below it.
TEST(Held, SlidesAsABlockAndSticks) {
  for (const Integrator integrator :
       {Integrator::symplecticEuler, Integrator::velocityVerlet, Integrator::leapfrog, Integrator::rungeKutta}) {
    for (const double mu : {0.2, 0.5}) {
      const double g = 9.81, angle = std::atan(mu) + 0.15;
      Simulation sim = onIncline(integrator, angle, mu).start(5e-6);
      sim.advance(4000);
      const double expected = g * (std::sin(angle) - mu * std::cos(angle)) * sim.time();
      // Friction builds up while the spring is drawn: a time of √(m/k_t).
      EXPECT_NEAR(look(sim).velocity[0].x(), expected, 5e-3 * expected) << schemeOf(integrator).name;
      const Ledger ledger = sim.ledger();
      Simulation finer = onIncline(integrator, angle, mu).start(1.25e-6);
      finer.advance(16000);
      const bool secondOrder = integrator == Integrator::velocityVerlet || integrator == Integrator::rungeKutta;
      EXPECT_LT(ledger.residualFraction(), secondOrder ? 5e-3 : 6e-2) << schemeOf(integrator).name;
      EXPECT_LT(finer.ledger().residualFraction(), (secondOrder ? 0.12 : 0.3) * ledger.residualFraction() + 1e-6)
          << schemeOf(integrator).name;
      EXPECT_EQ(ledger.kineticRotation, 0);
      EXPECT_TRUE(look(sim).angularVelocity.empty());

      Simulation still = onIncline(integrator, std::atan(mu) - 0.05, mu).start(5e-6);
      still.advance(8000);
      EXPECT_LT(look(still).velocity[0].norm(), 1e-4) << schemeOf(integrator).name;
      EXPECT_LT(std::abs(look(still).position[0].x()), 3 * mass * g / kt);
      EXPECT_LT(still.ledger().residualFraction(), 2e-2);
    }
  }
}

// A sticking contact without dashpot swings with k_t/m*, and not with 7/2 of it.
TEST(Held, SwingsWithAllOfItsMass) {
  Scenario s = frictional(1e9, 1);
  s.model.contact.rotation = false;
  const double vt = 0.02, dt = 1e-7;
  s.model.contact.tension = true;
  s.grain(mass, radius, {0, 0, 0}, {vt, 0, 0});
  s.plane({0, 0, -0.99 * radius}, {0, 0, 1});
  s.plane({0, 0, 0.99 * radius}, {0, 0, -1});
  Simulation sim = s.start(dt);
  const double omega = std::sqrt(2 * kt / mass);
  sim.advance(static_cast<std::uint64_t>(std::llround(pi / omega / dt)));
  EXPECT_NEAR(look(sim).velocity[0].x(), -vt, 2e-2 * vt);
}

TEST(Held, IsRefusedWhereTurningIsWhatItIsAbout) {
  Scenario s = frictional(0.5, 0.5);
  s.model.contact.rotation = false;
  s.model.contact.rolling = "constant";
  s.pair[Property::rollingFriction] = 0.1;
  s.grain(mass, radius, {0, 0, 0});
  EXPECT_THROW(s.start(1e-6), Error);
}

}  // namespace
}  // namespace tsubu::sim::test
