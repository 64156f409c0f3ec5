#include "sim/laws/linear_normal.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/laws/contacts.h"

namespace tsubu::sim {
namespace {

constexpr StepOf step{1e-6, 0.5};

Contact headOn(double overlap, double separationSpeed, double effectiveMass) {
  Contact c{};
  c.n = {0, 0, 1};
  c.overlap = overlap;
  c.separationSpeed = separationSpeed;
  c.effectiveMass = effectiveMass;
  c.rootMass = std::sqrt(c.effectiveMass);
  return c;
}

PropertyValues withRate() {
  PropertyValues values;
  values[Property::normalStiffness] = 1234;
  values[Property::normalDampingRate] = 777;
  return values;
}

TEST(LinearNormal, ForceIsSpringPlusDashpot) {
  const auto pair = LinearNormal::prepare(test::same(withRate()), true);
  const double m = 3e-5, delta = 2e-5, v = -0.04;
  const NormalForce f = LinearNormal::force(pair, headOn(delta, v, m), step);
  EXPECT_DOUBLE_EQ(f.elastic, 1234 * delta);
  EXPECT_DOUBLE_EQ(f.force, 1234 * delta - 777 * m * v);  // N1, N4; approach pushes harder
  EXPECT_DOUBLE_EQ(f.energy, 0.5 * 1234 * delta * delta);
  EXPECT_DOUBLE_EQ(f.stiffness, 1234);
  EXPECT_DOUBLE_EQ(f.damping, 777 * m);
  EXPECT_DOUBLE_EQ(LinearNormal::damping(pair, m, 1234), 777 * m);
}

// The Article's −k_n δ n with its own positive overlap would attract.
TEST(LinearNormal, OverlapRepels) {
  EXPECT_GT(LinearNormal::force(LinearNormal::prepare(test::same(withRate()), false), headOn(1e-6, 0, 1e-5), step).force, 0);
}

TEST(LinearNormal, PullsOnlyWhenAllowed) {
  const Contact parting = headOn(1e-6, 0.5, 3e-5);  // 1234e-6 N of spring against 0.0117 N of dashpot
  EXPECT_EQ(LinearNormal::force(LinearNormal::prepare(test::same(withRate()), false), parting, step).force, 0.0);
  const NormalForce pulling = LinearNormal::force(LinearNormal::prepare(test::same(withRate()), true), parting, step);
  EXPECT_DOUBLE_EQ(pulling.force, 1234e-6 - 777 * 3e-5 * 0.5);
  EXPECT_LT(pulling.force, 0);
}

// N3: η = 2ζ(e)√(m* k).
TEST(LinearNormal, DampingFollowsRestitutionAndEffectiveMass) {
  PropertyValues values;
  values[Property::normalStiffness] = 500;
  values[Property::restitution] = 0.4;
  for (const bool tension : {false, true}) {
    const auto pair = LinearNormal::prepare(test::same(values), tension);
    for (const double m : {1e-9, 2e-5, 3.0}) {
      const double expected = 2 * dampingRatio(0.4, tension) * std::sqrt(m * 500);
      EXPECT_NEAR(LinearNormal::force(pair, headOn(1e-5, 0.1, m), step).damping, expected, 1e-14 * expected);
    }
  }
}

TEST(LinearNormal, ElasticContactHasExactlyNoDashpot) {
  PropertyValues values;
  values[Property::normalStiffness] = 500;
  values[Property::restitution] = 1;
  EXPECT_EQ(LinearNormal::force(LinearNormal::prepare(test::same(values), false), headOn(1e-5, -3, 1), step).force, 500 * 1e-5);
}

// N5: a contact that began τ ago, τ below a step, has its dashpot at work for τ + ½ Δt of the step for which this force stands.
TEST(LinearNormal, DashpotActsForThePartOfTheStepThatIsContact) {
  const auto pair = LinearNormal::prepare(test::same(withRate()), true);
  const double m = 3e-5, eta = 777 * m, v = 0.04;
  for (const double tau : {0.05, 0.3, 0.5, 0.8, 0.999}) {
    const double delta = tau * v * step.dt;
    EXPECT_NEAR(LinearNormal::force(pair, headOn(delta, -v, m), step).force, 1234 * delta + eta * v * (tau + 0.5), 1e-12);
    EXPECT_NEAR(LinearNormal::force(pair, headOn(delta, v, m), step).force, 1234 * delta - eta * v * (tau + 0.5), 1e-12);
  }
  const double whole = 1.001 * v * step.dt;
  EXPECT_NEAR(LinearNormal::force(pair, headOn(whole, -v, m), step).force, 1234 * whole + eta * v, 1e-12);
}

}  // namespace
}  // namespace tsubu::sim
