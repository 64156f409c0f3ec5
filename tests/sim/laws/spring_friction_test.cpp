#include "sim/laws/spring_friction.h"

#include <cmath>

#include <gtest/gtest.h>

#include "sim/laws/contacts.h"

namespace tsubu::sim {
namespace {

using test::tangentTo;
using test::vec;

constexpr double normalStiffness = 2000, dt = 1e-6;

PropertyValues values(double kt, double mu, double tangentialRate = -1) {
  PropertyValues v;
  v[Property::normalStiffness] = normalStiffness;
  v[Property::tangentialStiffness] = kt;
  v[Property::friction] = mu;
  if (tangentialRate >= 0) v[Property::tangentialDampingRate] = tangentialRate;
  return v;
}

Contact sliding(V3 slip) {
  Contact c{};
  c.n = {0, 0, 1};
  c.slip = slip;
  c.effectiveMass = 2e-5;
  c.rootMass = std::sqrt(c.effectiveMass);
  return c;
}

NormalForce pressing(double force, double damping = 0) {
  return {force, force, 0, normalStiffness, damping, damping / std::sqrt(normalStiffness)};
}

// T1: while the contact sticks, the force is k_t times the displacement so far plus the dashpot.
TEST(SpringFriction, SticksLikeASpringWithADashpot) {
  const auto pair = SpringFriction::prepare(test::same(values(900, 0.5)), normalStiffness, true);
  const double normalDamping = 0.03, damping = normalDamping * std::sqrt(900 / (3.5 * normalStiffness));  // T4
  for (const double lead : {0.5, 1.0}) {
    VectorMemory memory{};
    double displacement = 0;
    for (int n = 0; n < 40; ++n) {
      const double v = 0.02 * std::cos(0.1 * n);
      const TangentialForce f = SpringFriction::force(pair, sliding({v, 0, 0}), pressing(1, normalDamping), {dt, lead}, memory);
      EXPECT_NEAR(f.force.x, -900 * (displacement + lead * v * dt) - damping * v, 1e-15);
      displacement += v * dt;
      EXPECT_NEAR(memory.spring.x, 900 * displacement, 1e-15);
      EXPECT_NEAR(f.dashpot, damping * v * v * dt, 1e-20);
    }
  }
}

TEST(SpringFriction, DefaultStiffnessIsTwoSeventhsOfTheNormalOne) {
  PropertyValues v;
  v[Property::friction] = 0.5;
  EXPECT_DOUBLE_EQ(SpringFriction::prepare(test::same(v), 700, true).stiffness, 200);
}

TEST(SpringFriction, DampingFromARateGrowsWithTheEffectiveMass) {
  const auto pair = SpringFriction::prepare(test::same(values(900, 1e9, 50)), normalStiffness, true);
  VectorMemory memory{};
  const TangentialForce f = SpringFriction::force(pair, sliding({0, 0.3, 0}), pressing(1, 123), {dt, 1}, memory);
  EXPECT_NEAR(f.force.y, -900 * 0.3 * dt - 50 * 2e-5 * 0.3, 1e-15);
}

// T2: never more than μ|F_n|, opposite to the slip in steady sliding. Scan 1 of the Note, (1.17), has μ|f_t|.
TEST(SpringFriction, SlidesAtTheCoulombLimit) {
  const auto pair = SpringFriction::prepare(test::same(values(900, 0.35, 50)), normalStiffness, true);
  VectorMemory memory{};
  const V3 slip{0.3, -0.4, 0};
  TangentialForce f{};
  for (int n = 0; n < 2000; ++n) f = SpringFriction::force(pair, sliding(slip), pressing(0.2), {dt, 0.5}, memory);
  EXPECT_NEAR(f.force.x, -0.35 * 0.2 * 0.6, 1e-12);
  EXPECT_NEAR(f.force.y, 0.35 * 0.2 * 0.8, 1e-12);
  // A pulling normal force limits like a pushing one.
  f = SpringFriction::force(pair, sliding(slip), pressing(-0.2), {dt, 0.5}, memory);
  EXPECT_NEAR(norm(f.force), 0.35 * 0.2, 1e-12);
}

// Luding 2008: cut back so that spring and dashpot together are the limit. In steady sliding the spring is then limit − η_t v_t.
TEST(SpringFriction, SpringIsCutBackToWhatTheDashpotLeaves) {
  const double rate = 400, v = 0.5, dashpot = rate * 2e-5 * v, limit = 0.35 * 0.2;  // 0.004 N of 0.07 N
  const auto pair = SpringFriction::prepare(test::same(values(900, 0.35, rate)), normalStiffness, true);
  for (const double lead : {0.5, 1.0}) {
    VectorMemory memory{};
    for (int n = 0; n < 5000; ++n) SpringFriction::force(pair, sliding({v, 0, 0}), pressing(0.2), {dt, lead}, memory);
    EXPECT_NEAR(memory.spring.x, limit - dashpot, 900 * v * dt);  // to what one step stretches
  }
}

// A spring that is longer than it has been stretched, or turned round, would push the grain later with energy nobody gave it.
TEST(SpringFriction, CuttingBackNeverCharges) {
  Random random(7, 1);
  const auto pair = SpringFriction::prepare(test::same(values(900, 0.35, 3000)), normalStiffness, true);
  for (int n = 0; n < 10000; ++n) {
    const Contact c = test::randomContact(random);
    VectorMemory memory{test::v3(tangentTo(vec(c.n), test::randomVec(random, 0.03)))};
    const StepOf step{1e-5, random.uniform() < 0.5 ? 0.5 : 1.0};
    const V3 before = memory.spring;
    const NormalForce normal = pressing(random.uniform(0, 0.1));
    const TangentialForce f = SpringFriction::force(pair, c, normal, step, memory);
    const double work = -dot(f.force, c.slip) * step.dt;
    EXPECT_GE(work - (f.storedAfter - f.storedBefore) - f.dashpot, -1e-12 * (std::abs(work) + f.storedBefore));
    EXPECT_GE(f.dashpot, 0);
    EXPECT_LE(norm(memory.spring), norm(before + (900 * step.dt) * c.slip) * (1 + 1e-12));
  }
}

// A grain that slides fast under a light load, is stopped, pressed hard and led on: the pressed spring must not push it along. With
// Luding's cut-back it would give back (η_t v)²/2k_t, seventy times what the slide has cost.
TEST(SpringFriction, FastLightSlideBuysNoEnergy) {
  const double rate = 3e4, v = 0.1, light = 1e-3;  // dashpot 0.06 N against a limit of 0.00035 N
  const auto pair = SpringFriction::prepare(test::same(values(900, 0.35, rate)), normalStiffness, true);
  for (const double lead : {0.5, 1.0}) {
    VectorMemory memory{};
    double work = 0;
    const auto lead_on = [&](double speed, double load, int steps) {
      for (int n = 0; n < steps; ++n)
        work += SpringFriction::force(pair, sliding({speed, 0, 0}), pressing(load), {dt, lead}, memory).force.x * speed * dt;
    };
    lead_on(v, light, 100);
    lead_on(1e-4, 1, 300000);
    EXPECT_LT(work, 0);
  }
}

// T3: turning the contact turns the spring, with n and with the mean spin about n, and does not stretch it.
TEST(SpringFriction, IsCarriedAtUnchangedLength) {
  const auto pair = SpringFriction::prepare(test::same(values(900, 1e9)), normalStiffness, true);
  const Vec3 axis = Vec3(0.2, 1, -0.4).normalized();
  const int steps = 20000;
  Vec3 n = Vec3(1, 0.3, 0.5).normalized(), b = axis.cross(n).normalized();
  const Vec3 start = 0.03 * b + 0.05 * n.cross(b);
  VectorMemory memory{test::v3(start)};
  const double angle = 1.3 / steps;  // rigid rotation of the pair about `axis` by 1.3 rad in all
  for (int k = 1; k <= steps; ++k) {
    n = Eigen::AngleAxisd(angle, axis) * n;
    Contact c{};
    c.n = test::v3(n);
    c.effectiveMass = 2e-5;
    c.rootMass = std::sqrt(c.effectiveMass);
    c.frameAngle = angle * axis.dot(n);
    memory.carry(c.n, c.frameAngle);
    SpringFriction::force(pair, c, pressing(1), {dt, 1}, memory);
    ASSERT_NEAR(norm(memory.spring), start.norm(), 1e-12);
    ASSERT_NEAR(vec(memory.spring).dot(n), 0, 1e-15);
  }
  // In a rigid rotation spring and grains turn alike. Carrying is of first order in the step, 1.3²/2/steps at most.
  EXPECT_LT((vec(memory.spring) - Eigen::AngleAxisd(1.3, axis) * start).norm(), start.norm() * 1.3 * 1.3 / steps);
}

// T5: with the force read in the middle of the step the work of a sticking spring is the change of its energy, exactly.
TEST(SpringFriction, StickingSpringLeaksNothing) {
  const auto pair = SpringFriction::prepare(test::same(values(900, 1e9, 0)), normalStiffness, true);
  Random random(3, 3);
  VectorMemory memory{};
  double work = 0;
  for (int n = 0; n < 1000; ++n) {
    Contact c = sliding({random.uniform(-1, 1), random.uniform(-1, 1), 0});
    const TangentialForce f = SpringFriction::force(pair, c, pressing(1), {1e-4, 0.5}, memory);
    work -= dot(f.force, c.slip) * 1e-4;
    ASSERT_NEAR(work, SpringFriction::stored(pair, memory), 1e-12);
  }
}

TEST(SpringFriction, WithoutASpringOnlyTheDashpotActs) {
  const auto pair = SpringFriction::prepare(test::same(values(0, 0.5, 100)), normalStiffness, true);
  VectorMemory memory{};
  const TangentialForce f = SpringFriction::force(pair, sliding({0.1, 0, 0}), pressing(1), {dt, 0.5}, memory);
  EXPECT_NEAR(f.force.x, -100 * 2e-5 * 0.1, 1e-18);
  EXPECT_EQ(memory.spring.x, 0);
  EXPECT_EQ(f.storedAfter, 0);
}

}  // namespace
}  // namespace tsubu::sim
