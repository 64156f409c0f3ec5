// Many grains at rest, and many that are shaken while they cannot move: deep columns do not creep, jammed packings do not warm up by
// themselves.

#include <gtest/gtest.h>

#include "verification/columns.h"

namespace tsubu::sim::test {
namespace {

// Eighteen layers deep. Last grains near their limit still give way by thousandths of a radius; no motion is left. The account's rest is
// that of hard damped collisions at this step, and of second order: 2.3e-2, 1.1e-3 and 5e-5 with steps of 1, 1/4 and 1/16.
TEST(Column, OfThreeHundredGrainsDoesNotCreep) {
  const Creep creep = creepOfColumn(300, 4, Integrator::velocityVerlet, 1.0, 0.1);
  EXPECT_LT(creep.moved, 5e-3);
  EXPECT_LT(creep.kinetic, 1e-6);
  EXPECT_LT(creep.deepest, 0.1);
  EXPECT_LT(creep.residual, 3e-2);
}

// Ten thousand grains one upon the other in their exact equilibrium, without any damping: the lowest contact carries ten thousand times
// what the topmost does, and only rounding moves anything. extremes_slow_test.cpp has a million steps.
TEST(Column, OfTenThousandGrainsStands) {
  for (const std::string_view law : {"linear", "hertz"}) {
    const std::uint64_t steps = 100000;
    const Stack stack{law, 10000};
    const Standing seen = watch(stack, steps);
    const double bound = roundedAway(seen.ulp, steps);
    EXPECT_GT(seen.waves, 1) << law;
    EXPECT_LT(seen.moved, bound) << law;
    EXPECT_EQ(seen.aside, 0) << law;
    EXPECT_LT(seen.fastest, 2 * stack.omega() * bound) << law;  // no grain swings faster than 2 √(k/m)
    EXPECT_LT(seen.residual, 1e-13) << law;                     // sums of 10⁴ terms
  }
}

// What the bounds are worth: overlaps of a weight that is wrong by a part in 10⁹ break them at once.
TEST(Column, ThatPressesOnItselfByAPartInABillionMoves) {
  const std::uint64_t steps = 5000;
  const Stack stack{"linear", 10000};
  const Standing seen = watch(stack, steps, 1e-9);
  EXPECT_GT(seen.moved, 2 * roundedAway(seen.ulp, steps));
}

// A closest packing, pressed into a box whose floor shakes with twenty g: nothing gets out, nothing blows up, and the account still closes.
TEST(Jammed, ShakenPackingKeepsItsAccount) {
  for (const Integrator integrator : {Integrator::symplecticEuler, Integrator::velocityVerlet}) {
    for (const double e : {1.0, 0.5}) {
      Scenario s;
      s.model.integrator = integrator;
      s.model.contact = {"linear", "spring", "elastic_plastic", false};
      s.model.gravity = {0, 0, -9.81};
      s.model.domain = Box(Vec3::Constant(-1), Vec3::Constant(1));
      s.pair[Property::normalStiffness] = 2e4;
      s.pair[Property::restitution] = e;
      s.pair[Property::friction] = 0.5;
      s.pair[Property::rollingFriction] = 0.1;
      const double r = 1e-3, a = 1.98 * r, layer = a * std::sqrt(2.0 / 3), row = a * std::sqrt(0.75);
      for (int z = 0; z < 4; ++z)
        for (int y = 0; y < 4; ++y)
          for (int x = 0; x < 4; ++x) s.grain(1e-5, r, Vec3(a * (x + 0.5 * ((y + z) % 2)), row * (y + (z % 2) / 3.0), layer * z));
      const double w = 0.99 * r, frequency = 150, amplitude = 20 * 9.81 / (4 * pi * pi * frequency * frequency);
      const MotionPart shake{Oscillation{{0, 0, amplitude}, frequency, 0}, 0, std::numeric_limits<double>::infinity()};
      s.plane({0, 0, -w}, {0, 0, 1}, WallMotion({shake}));
      s.plane({0, 0, 3 * layer + w}, {0, 0, -1}, WallMotion({shake}));
      s.plane({-w, 0, 0}, {1, 0, 0});
      s.plane({3.5 * a + w, 0, 0}, {-1, 0, 0});
      s.plane({0, -w, 0}, {0, 1, 0});
      s.plane({0, row * (3 + 1 / 3.0) + w, 0}, {0, -1, 0});
      Simulation sim = s.start(2e-6);
      const double before = sim.ledger().mechanical();
      double deepest = 0, fastest = 0;
      for (int n = 0; n < 100; ++n) {
        sim.advance(100);
        deepest = std::max(deepest, sim.contacts().deepestOverlap);
        fastest = std::max(fastest, std::sqrt(2 * sim.ledger().kinetic() / (64 * 1e-5)));
      }
      const Ledger after = sim.ledger();
      EXPECT_EQ(sim.counts().lost, 0u);
      EXPECT_LT(deepest, 0.2);
      EXPECT_LT(fastest, 5 * 2 * pi * frequency * amplitude);
      EXPECT_GT(after.dissipatedFriction, 0.01 * before);
      EXPECT_LT(after.residualFraction(), integrator == Integrator::symplecticEuler ? 3e-2 : 3e-3) << e;
    }
  }
}

}  // namespace
}  // namespace tsubu::sim::test
