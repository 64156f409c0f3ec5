#include "sim/laws/twisting.h"

#include <cmath>

#include <gtest/gtest.h>

#include "sim/laws/contacts.h"

namespace tsubu::sim {
namespace {

constexpr double dt = 1e-6, radius = 2e-3, mass = 8e-5, inertia = 0.4 * mass * radius * radius, stiffness = 2000;

Contact twisting(V3 spin) {
  Contact c{};
  c.n = {0, 0.6, 0.8};
  c.relativeSpin = spin;
  c.effectiveMass = mass;
  c.rootMass = std::sqrt(c.effectiveMass);
  c.effectiveRadius = radius;
  c.inverseSpinInertia = 1 / inertia;
  return c;
}
NormalForce pressing(double force, double k = stiffness) { return {force, force, 0, k, 0, 0}; }

SpringTwisting::Pair pairWith(double mu) {
  PropertyValues v;
  v[Property::twistingFriction] = mu;
  return SpringTwisting::prepare(test::same(v));
}

// R7, R8: the part of the spin along n winds up the spring; the rest does nothing.
TEST(SpringTwisting, WindsUpAboutTheNormal) {
  const double mu = 0.2, k = 2.25 * stiffness * std::pow(mu * radius, 2), damping = 2 * 0.3 * std::sqrt(k * inertia);
  ScalarMemory memory{};
  const double spin = 5 * 0.6 - 3 * 0.8;  // (1, 5, −3)·n
  RollingMoment m{};
  for (int step = 0; step < 3; ++step) m = SpringTwisting::moment(pairWith(mu), twisting({1, 5, -3}), pressing(1), {dt, 0.5}, memory);
  const double expected = -(k * spin * 2.5 * dt + damping * spin);
  EXPECT_NEAR(m.moment.y, 0.6 * expected, 1e-15);
  EXPECT_NEAR(m.moment.z, 0.8 * expected, 1e-15);
  EXPECT_NEAR(m.moment.x, 0, 1e-20);
}

TEST(SpringTwisting, YieldsAtItsLimitAndHoldsThere) {
  ScalarMemory memory{};
  const double limit = 0.2 * radius * 0.5;
  RollingMoment m{};
  for (int step = 0; step < 20000; ++step)
    m = SpringTwisting::moment(pairWith(0.2), twisting({0, 60, 80}), pressing(0.5), {dt, 0.5}, memory);
  EXPECT_NEAR(norm(m.moment), limit, 1e-12 * limit);
  const RollingMoment held = SpringTwisting::moment(pairWith(0.2), twisting({0, 0, 0}), pressing(0.5), {dt, 0.5}, memory);
  EXPECT_NEAR(norm(held.moment), limit, 1e-12 * limit);
}

// On a contact whose stiffness falls the spring relaxes with it and never holds more than it was given (T8).
TEST(SpringTwisting, FollowsAGrowingStiffness) {
  GrowingScalarMemory memory{};
  double given = 0;
  for (int step = 0; step < 100; ++step) {
    const RollingMoment m =
        SpringTwisting::moment(pairWith(0.2), twisting({0, 0, 4}), pressing(5, stiffness * (1 + 0.01 * step)), {dt, 0.5}, memory);
    given -= m.moment.z * 4 * dt;
  }
  const double held = 0.5 * memory.spring * memory.spring / memory.stiffness;
  EXPECT_LT(held, given);
  const RollingMoment eased = SpringTwisting::moment(pairWith(0.2), twisting({0, 0, 0}), pressing(5, stiffness), {dt, 0.5}, memory);
  EXPECT_LT(eased.storedAfter, held);
  EXPECT_GE(eased.dissipated, 0);
}

}  // namespace
}  // namespace tsubu::sim
