// Gravity that turns and shakes: the flight of a free grain is a formula, and the ledger books the work of whoever changes it.

#include "sim/fields/gravity.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "verification/models.h"

namespace tsubu::sim::test {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();
const Vec3 x0{0.3, -0.2, 0.1}, v0{0.4, 0.2, -0.1}, g0{1, -2, -9};

/// ∫∫ of a gravity that turns with w about the unit axis a for the time t, from rest at the origin.
Vec3 flightUnderTurning(const Vec3& g, const Vec3& a, double w, double t) {
  const Vec3 along = g.dot(a) * a, e1 = g - along, e2 = a.cross(e1);
  return 0.5 * t * t * along + ((1 - std::cos(w * t)) * e1 + (w * t - std::sin(w * t)) * e2) / (w * w);
}
Vec3 speedUnderTurning(const Vec3& g, const Vec3& a, double w, double t) {
  const Vec3 along = g.dot(a) * a, e1 = g - along, e2 = a.cross(e1);
  return t * along + (std::sin(w * t) * e1 + (1 - std::cos(w * t)) * e2) / w;
}

Scenario freeGrain(Integrator integrator, const GravityChange& change) {
  Scenario s;
  s.model.integrator = integrator;
  s.pair[Property::normalStiffness] = 1000;
  s.pair[Property::restitution] = 1;
  s.model.gravity = g0;
  s.model.fields.gravity = {change};
  s.model.domain = Box(Vec3::Constant(-100), Vec3::Constant(100));
  s.model.watch.travelLimit = 1;
  s.grain(0.02, 0.01, x0, v0);
  return s;
}

struct Missed {
  double place, residual;
};
Missed missed(const Scenario& scenario, double dt, double until, const Vec3& expected) {
  Scenario s = scenario;
  Simulation sim = s.start(dt);
  const auto steps = static_cast<std::uint64_t>(std::lround(until / dt));
  sim.advance(steps / 2);
  sim.ledger();
  sim.advance(steps - steps / 2);
  EXPECT_NE(sim.ledger().workFields, 0);
  return {(look(sim).position[0] - expected).norm(), std::abs(sim.ledger().residual())};
}

void fliesAsTheFormula(const GravityChange& change, double until, const Vec3& expected) {
  for (const Integrator integrator : {Integrator::symplecticEuler, Integrator::velocityVerlet}) {
    const Scenario s = freeGrain(integrator, change);
    const Missed coarse = missed(s, 1e-3, until, expected), fine = missed(s, 2.5e-4, until, expected);
    const bool verlet = integrator == Integrator::velocityVerlet;
    EXPECT_LT(fine.place, verlet ? 1e-5 : 4e-3);
    EXPECT_GT(coarse.place / fine.place, verlet ? 14 : 3.7);
    // In velocity Verlet the account differs by ⅛mΔt²|g|² between its ends: nothing at all while gravity only turns.
    EXPECT_LT(fine.residual, verlet ? 1e-9 : 2e-4);
    if (!verlet || fine.residual > 1e-13) {
      EXPECT_GT(coarse.residual / fine.residual, verlet ? 14 : 3.7);
    }
  }
}

TEST(Gravity, TurnsFromATimeOn) {
  const Vec3 axis{1, 2, 2};  // of length 3
  const double w = -2.3, start = 0.2, until = 1;
  const Vec3 v = v0 + start * g0, x = x0 + start * v0 + 0.5 * start * start * g0;
  const double t = until - start;
  fliesAsTheFormula({GravityTurn{axis, w, never}, start, never}, until, x + t * v + flightUnderTurning(g0, axis / 3, w, t));
}

TEST(Gravity, StaysWhereItHasTurnedTo) {
  const Vec3 a = Vec3::UnitY();
  const double w = 1.7, angle = 0.85, until = 1, turning = angle / w;
  const Vec3 x = x0 + turning * v0 + flightUnderTurning(g0, a, w, turning), v = v0 + speedUnderTurning(g0, a, w, turning);
  const Vec3 turned = Eigen::AngleAxisd(angle, a) * g0;
  const double rest = until - turning;
  fliesAsTheFormula({GravityTurn{a, w, angle}, 0, never}, until, x + rest * v + 0.5 * rest * rest * turned);
}

TEST(Gravity, Shakes) {
  const Vec3 amplitude{3, 0, 5};
  const double f = 1.3, phase = 0.7, w = 2 * pi * f, t = 1;
  const Vec3 shaken = (t * std::cos(phase) / w - (std::sin(w * t + phase) - std::sin(phase)) / (w * w)) * amplitude;
  fliesAsTheFormula({GravityShake{amplitude, f, phase}, 0, never}, t, x0 + t * v0 + 0.5 * t * t * g0 + shaken);
}

TEST(Gravity, ChangesFollowOneAnother) {
  const std::vector<GravityChange> changes{{GravityTurn{Vec3::UnitY(), pi, never}, 0, 0.5}, {GravityShake{{0, 3, 0}, 0.25, 0}, 0, 2}};
  // After half a second gravity along −z has turned by 90° about y, and a quarter of a swing later the shake is at its height.
  EXPECT_LT((gravityAt({0, 0, -9}, changes, 1.0) - Vec3(-9, 3, 0)).norm(), 1e-14);
  EXPECT_LT((gravityAt({0, 0, -9}, changes, 2.0) - Vec3(-9, 0, 0)).norm(), 1e-14);  // the shake is over
  EXPECT_EQ(strongestGravity({0, 0, -9}, changes), 12);
}

// Gravity that does not change costs no time and books no work.
TEST(Gravity, StaysWithoutChanges) {
  GravityClock clock(g0, {});
  EXPECT_FALSE(clock.changes());
  EXPECT_EQ(clock.now(), g0);
  EXPECT_EQ(clock.work(), 0);
}

}  // namespace
}  // namespace tsubu::sim::test
