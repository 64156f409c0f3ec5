#include "sim/laws/hertz_normal.h"

#include <cmath>

#include <gtest/gtest.h>

#include "sim/laws/contacts.h"

namespace tsubu::sim {
namespace {

constexpr StepOf step{1e-7, 0.5};

PropertyValues stuff(double young, double poisson, double e = 0.7) {
  PropertyValues v;
  v[Property::youngModulus] = young;
  v[Property::poissonRatio] = poisson;
  v[Property::restitution] = e;
  return v;
}

Contact headOn(double overlap, double separationSpeed, double effectiveMass, double effectiveRadius) {
  Contact c{};
  c.n = {0, 0, 1};
  c.overlap = overlap;
  c.separationSpeed = separationSpeed;
  c.effectiveMass = effectiveMass;
  c.rootMass = std::sqrt(c.effectiveMass);
  c.effectiveRadius = effectiveRadius;
  return c;
}

// N8: two stuffs are springs in a row.
TEST(HertzNormal, EffectiveModulus) {
  const PropertyValues a = stuff(7e9, 0.22), b = stuff(0.4e9, 0.41);
  EXPECT_NEAR(effectiveModulus({a, a, b}), 1 / ((1 - 0.22 * 0.22) / 7e9 + (1 - 0.41 * 0.41) / 0.4e9), 1);
  EXPECT_EQ(effectiveModulus({a, a, b}), effectiveModulus({a, b, a}));
}

// N6, N7 by hand.
TEST(HertzNormal, ForceIsSpringPlusDashpot) {
  const PropertyValues v = stuff(3e9, 0.3);
  const auto pair = HertzNormal::prepare(test::same(v), true);
  const double modulus = 3e9 / (2 * (1 - 0.09)), radius = 7e-4, delta = 3e-6, mass = 4e-6, speed = -0.2;
  const NormalForce f = HertzNormal::force(pair, headOn(delta, speed, mass, radius), step);
  const double elastic = 4.0 / 3.0 * modulus * std::sqrt(radius) * std::pow(delta, 1.5),
               stiffness = 2 * modulus * std::sqrt(radius * delta);
  const double damping = 2 * std::sqrt(5.0 / 6.0) * dampingRatio(0.7, true) * std::sqrt(stiffness * mass);
  EXPECT_NEAR(f.elastic, elastic, 1e-12 * elastic);
  EXPECT_NEAR(f.stiffness, stiffness, 1e-12 * stiffness);
  EXPECT_NEAR(f.damping, damping, 1e-12 * damping);
  EXPECT_NEAR(f.force, elastic - damping * speed, 1e-12 * elastic);
  EXPECT_NEAR(f.dampingPerRootStiffness, damping / std::sqrt(stiffness), 1e-12 * damping);
  EXPECT_NEAR(HertzNormal::stiffness(pair, delta, radius), stiffness, 1e-12 * stiffness);
  EXPECT_NEAR(HertzNormal::damping(pair, mass, stiffness), damping, 1e-12 * damping);
}

// The energy is the integral of the elastic force, and the stiffness its derivative.
TEST(HertzNormal, EnergyAndStiffnessBelongToTheForce) {
  const auto pair = HertzNormal::prepare(test::same(stuff(3e9, 0.3, 1)), false);
  const auto at = [&](double delta) { return HertzNormal::force(pair, headOn(delta, 0, 4e-6, 7e-4), step); };
  const double delta = 5e-6, h = 1e-10;
  EXPECT_NEAR((at(delta + h).energy - at(delta - h).energy) / (2 * h), at(delta).force, 1e-6 * at(delta).force);
  EXPECT_NEAR((at(delta + h).force - at(delta - h).force) / (2 * h), at(delta).stiffness, 1e-6 * at(delta).stiffness);
}

TEST(HertzNormal, PullsOnlyWhenAllowed) {
  const Contact parting = headOn(1e-8, 3, 4e-6, 7e-4);
  EXPECT_EQ(HertzNormal::force(HertzNormal::prepare(test::same(stuff(3e9, 0.3, 0.2)), false), parting, step).force, 0.0);
  EXPECT_LT(HertzNormal::force(HertzNormal::prepare(test::same(stuff(3e9, 0.3, 0.2)), true), parting, step).force, 0.0);
}

// A contact that has just ended goes through the law once more, out of reach.
TEST(HertzNormal, OutOfReachIsNothing) {
  const NormalForce f = HertzNormal::force(HertzNormal::prepare(test::same(stuff(3e9, 0.3)), false), headOn(-1e-4, 0.1, 4e-6, 7e-4), step);
  EXPECT_EQ(f.force, 0.0);
  EXPECT_EQ(f.stiffness, 0.0);
}

}  // namespace
}  // namespace tsubu::sim
