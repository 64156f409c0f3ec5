#include <cmath>

#include <gtest/gtest.h>

#include "sim/laws/contacts.h"

namespace tsubu::sim {
namespace {

using test::vec;

constexpr double dt = 1e-6, radius = 2e-3, mass = 8e-5;
constexpr double inertia = 0.4 * mass * radius * radius;

PropertyValues values(double mu) {
  PropertyValues v;
  v[Property::rollingFriction] = mu;
  return v;
}

// A sphere on a wall: R* = r, 1/I of the wall = 0.
Contact rolling(V3 spin) {
  Contact c{};
  c.n = {0, 0, 1};
  c.relativeSpin = spin;
  c.effectiveMass = mass;
  c.rootMass = std::sqrt(c.effectiveMass);
  c.effectiveRadius = radius;
  c.inverseSpinInertia = 1 / inertia;
  return c;
}

NormalForce pressing(double force) { return {force, force, 0, 2000, 0, 0}; }

// R1
TEST(ConstantRolling, TorqueOpposesTheRelativeSpin) {
  const auto pair = ConstantRolling::prepare(test::same(values(0.1)));
  NoMemory<Family::rolling> none;
  const RollingMoment m = ConstantRolling::moment(pair, rolling({30, 0, 40}), pressing(0.5), {dt, 0.5}, none);
  const double size = 0.1 * radius * 0.5;
  EXPECT_NEAR(m.moment.x, -0.6 * size, 1e-18);
  EXPECT_NEAR(m.moment.z, -0.8 * size, 1e-18);
}

// R2: a sixteenth of the torque that would stop the spin in one step is the most.
TEST(ConstantRolling, NeverReverses) {
  const auto pair = ConstantRolling::prepare(test::same(values(0.1)));
  NoMemory<Family::rolling> none;
  for (const double spin : {1e-12, 1e-6, 1e-3, 1.0, 100.0}) {
    const RollingMoment m = ConstantRolling::moment(pair, rolling({0, spin, 0}), pressing(0.5), {dt, 0.5}, none);
    EXPECT_GE(spin / 16 + m.moment.y / inertia * dt, -1e-15 * spin);
  }
  const RollingMoment still = ConstantRolling::moment(pair, rolling({0, 0, 0}), pressing(0.5), {dt, 0.5}, none);
  EXPECT_EQ(norm(still.moment), 0);
}

// The Note's r_i in (1.20) would give the partners of unequal radius different moments. Here R* is the same for both.
TEST(ConstantRolling, BothPartnersGetTheSameMoment) {
  const auto pair = ConstantRolling::prepare(test::same(values(0.1)));
  NoMemory<Family::rolling> none;
  Contact c = rolling({3, 4, 0});
  const V3 onI = ConstantRolling::moment(pair, c, pressing(0.5), {dt, 0.5}, none).moment;
  c.relativeSpin = -c.relativeSpin;
  c.n = -c.n;
  const V3 onJ = ConstantRolling::moment(pair, c, pressing(0.5), {dt, 0.5}, none).moment;
  EXPECT_EQ(norm(onI + onJ), 0);
}

// R3, R5: below the limit a spring of k_r = 2.25 k_n (μ_r R*)² with a dashpot of 2ζ_r√(I_r k_r), I_r = 7/2 I.
TEST(ElasticPlasticRolling, ElasticBelowTheLimit) {
  PropertyValues v = values(0.1);
  v[Property::rollingDamping] = 0.25;
  const auto pair = ElasticPlasticRolling::prepare(test::same(v));
  const double k = 2.25 * 2000 * 0.1 * 0.1 * radius * radius;
  const double damping = 2 * 0.25 * std::sqrt(3.5 * inertia * k);
  for (const double lead : {0.5, 1.0}) {
    VectorMemory memory{};
    double angle = 0;
    for (int n = 0; n < 50; ++n) {
      const double spin = 0.3 * std::cos(0.2 * n);
      const RollingMoment m = ElasticPlasticRolling::moment(pair, rolling({0, spin, 0}), pressing(0.5), {dt, lead}, memory);
      EXPECT_NEAR(m.moment.y, -k * (angle + lead * spin * dt) - damping * spin, 1e-20);
      angle += spin * dt;
    }
  }
}

TEST(ElasticPlasticRolling, DampingRatioIsThreeTenthsWhenAbsent) {
  EXPECT_EQ(ElasticPlasticRolling::prepare(test::same(values(0.1))).dampingRatio, 0.3);
}

// R3, R4: beyond the limit the moment is μ_r R* |F_n| and the dashpot is silent.
TEST(ElasticPlasticRolling, YieldsAtTheLimit) {
  const auto pair = ElasticPlasticRolling::prepare(test::same(values(0.1)));
  VectorMemory memory{};
  RollingMoment m{};
  for (int n = 0; n < 20000; ++n) m = ElasticPlasticRolling::moment(pair, rolling({30, 40, 0}), pressing(0.5), {dt, 0.5}, memory);
  EXPECT_NEAR(norm(m.moment), 0.1 * radius * 0.5, 1e-12 * radius);
  EXPECT_NEAR(m.moment.x / m.moment.y, 0.75, 1e-9);
}

// A pile stands: the moment stays when the spin is gone.
TEST(ElasticPlasticRolling, HoldsAMomentAtRest) {
  const auto pair = ElasticPlasticRolling::prepare(test::same(values(0.1)));
  VectorMemory memory{};
  for (int n = 0; n < 20000; ++n) ElasticPlasticRolling::moment(pair, rolling({0, 50, 0}), pressing(0.5), {dt, 0.5}, memory);
  const RollingMoment m = ElasticPlasticRolling::moment(pair, rolling({0, 0, 0}), pressing(0.5), {dt, 0.5}, memory);
  EXPECT_NEAR(m.moment.y, -0.1 * radius * 0.5, 1e-3 * 0.1 * radius * 0.5);
}

TEST(ElasticPlasticRolling, SpinAboutTheNormalIsFree) {
  const auto pair = ElasticPlasticRolling::prepare(test::same(values(0.1)));
  VectorMemory memory{};
  EXPECT_EQ(norm(ElasticPlasticRolling::moment(pair, rolling({0, 0, 50}), pressing(0.5), {dt, 0.5}, memory).moment), 0);
}

TEST(ElasticPlasticRolling, NeverGivesEnergy) {
  Random random(7, 2);
  PropertyValues v = values(0.1);
  const auto pair = ElasticPlasticRolling::prepare(test::same(v));
  for (int n = 0; n < 10000; ++n) {
    const Contact c = test::randomContact(random);
    VectorMemory memory{test::v3(test::tangentTo(vec(c.n), test::randomVec(random, 1e-5)))};
    const StepOf step{1e-5, random.uniform() < 0.5 ? 0.5 : 1.0};
    const RollingMoment m = ElasticPlasticRolling::moment(pair, c, pressing(random.uniform(0, 0.1)), step, memory);
    const double work = -dot(m.moment, c.relativeSpin) * step.dt;
    EXPECT_GE(work - (m.storedAfter - m.storedBefore), -1e-12 * (std::abs(work) + m.storedBefore));
  }
}

// R6: proportional to load and rolling speed, without the part about n.
TEST(ViscousRolling, GrowsWithSpeedAndLoad) {
  PropertyValues v;
  v[Property::rollingViscosity] = 0.7;
  const auto pair = ViscousRolling::prepare(test::same(v));
  NoMemory<Family::rolling> none;
  const RollingMoment m = ViscousRolling::moment(pair, rolling({3, -4, 9}), pressing(-0.5), {dt, 0.5}, none);
  const double per = 0.7 * radius * radius * 0.5;
  EXPECT_NEAR(m.moment.x, -3 * per, 1e-18);
  EXPECT_NEAR(m.moment.y, 4 * per, 1e-18);
  EXPECT_NEAR(m.moment.z, 0, 1e-20);
  EXPECT_NEAR(m.dissipated, 25 * per * dt, 1e-20);
}

// R2
TEST(ViscousRolling, NeverReverses) {
  PropertyValues v;
  v[Property::rollingViscosity] = 1e12;
  NoMemory<Family::rolling> none;
  const RollingMoment m =
      ViscousRolling::moment(ViscousRolling::prepare(test::same(v)), rolling({0, 30, 0}), pressing(0.5), {dt, 0.5}, none);
  EXPECT_NEAR(m.moment.y / inertia * dt, -30.0 / 16, 1e-13);
}

}  // namespace
}  // namespace tsubu::sim
