// Grains that cross others or thin walls within a step: hard impacts (docs/physics.md, C) with the answers of the textbook.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "verification/models.h"
#include "verification/shapes.h"

namespace tsubu::sim::test {
namespace {

constexpr std::array integrators{Integrator::symplecticEuler, Integrator::velocityVerlet, Integrator::leapfrog};

Scenario swept(Integrator integrator, double e, double mu = 0) {
  Scenario s;
  s.model.integrator = integrator;
  s.model.watch = Watch{};
  s.model.continuous = true;
  s.model.domain = Box(Vec3::Constant(-1), Vec3::Constant(1));
  if (mu > 0) s.model.contact = {"linear", "spring", "none", false};
  s.pair[Property::normalStiffness] = 1e4;
  s.pair[Property::restitution] = e;
  s.pair[Property::friction] = mu;
  return s;
}

// Five radii in a step, of unequal mass and size: v' = v ± (1 + e) m*/m v_n, whatever the place in the step.
TEST(Continuous, HeadOn) {
  for (const Integrator integrator : integrators) {
    for (const double e : {1.0, 0.5, 0.05}) {
      for (int start = 0; start < 12; ++start) {
        const double m1 = 1e-5, m2 = 4e-5, dt = 1e-5, v = 500;
        Scenario s = swept(integrator, e);
        s.grain(m1, 1e-3, {-0.02 - 5e-3 * start / 12, 0, 0}, {v, 0, 0});
        s.grain(m2, 1.7e-3, {0, 0, 0}, {-20, 0, 0});
        Simulation sim = s.start(dt);
        const Ledger before = sim.ledger();
        sim.advance(12);
        const Snapshot now = look(sim);
        const double approach = v + 20, effective = m1 * m2 / (m1 + m2);
        EXPECT_NEAR(now.velocity[0].x(), v - (1 + e) * effective / m1 * approach, 1e-9 * v);
        EXPECT_NEAR(now.velocity[1].x(), -20 + (1 + e) * effective / m2 * approach, 1e-9 * v);
        const Ledger after = sim.ledger();
        EXPECT_EQ(sim.counts().impacts, 1u);
        EXPECT_LT((after.momentum - before.momentum).norm(), 1e-13 * m1 * v);
        EXPECT_NEAR(after.dissipatedNormal, 0.5 * effective * (1 - e * e) * approach * approach, 1e-9 * before.mechanical());
        EXPECT_LT(std::abs(after.residual()), 1e-12 * before.mechanical());
      }
    }
  }
}

Vec3 angular(const Ledger& ledger) { return ledger.angularMomentumBulk + ledger.angularMomentumRest; }

// Oblique, with friction and spins: both momenta and the account stay to rounding; e = 1 without friction keeps the energy.
TEST(Continuous, ObliqueKeepsBothMomentaAndTheAccount) {
  for (const Integrator integrator : integrators) {
    for (const double mu : {0.0, 0.2, 10.0}) {
      for (const double e : {1.0, 0.6}) {
        for (int n = 0; n < 20; ++n) {
          Random random(9, static_cast<std::uint64_t>(n));
          Scenario s = swept(integrator, e, mu);
          const Vec3 aim = Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)) * 1e-3;
          const Vec3 spin = mu > 0 ? Vec3(3e4, -2e4, 5e4) : Vec3(Vec3::Zero());
          s.grain(1e-5, 1e-3, Vec3(-0.015, 0.002, 0.001) + aim, {600, -80, -40}, spin);
          s.grain(3e-5, 1.9e-3, {0, 0, 0}, {0, 10, 0}, -0.3 * spin);
          Simulation sim = s.start(1e-5);
          const Ledger before = sim.ledger();
          sim.advance(6);
          const Ledger after = sim.ledger();
          ASSERT_EQ(sim.counts().impacts, 1u);
          EXPECT_LT((after.momentum - before.momentum).norm(), 1e-12 * before.momentum.norm());
          EXPECT_LT((angular(after) - angular(before)).norm(), 1e-11 * angular(before).norm());
          EXPECT_LT(std::abs(after.residual()), 1e-11 * before.mechanical());
          if (e == 1 && mu == 0) {
            EXPECT_NEAR(after.mechanical(), before.mechanical(), 1e-12 * before.mechanical());
          }
          EXPECT_GE(after.dissipatedFriction, 0);
        }
      }
    }
  }
}

// Gross sliding: v_t' = v_t − μ(1 + e) v_n, rω' = 5/2 μ(1 + e) v_n.
TEST(Continuous, SlidesOnAPlateAsTheTextbookSays) {
  const double e = 0.5, mu = 0.1, vn = 300, vt = 400, r = 1e-3;
  for (const double side : {1.0, -1.0}) {
    Scenario s = swept(Integrator::velocityVerlet, e, mu);
    s.grain(1e-5, r, {0, 0, side * 0.01}, {vt, 0, -side * vn});
    s.wall(Surface(rectangle(-0.1, 0.1, -0.1, 0.1, 0, 3, 3)));
    Simulation sim = s.start(1e-5);
    sim.advance(8);
    const Snapshot now = look(sim);
    EXPECT_NEAR(now.velocity[0].z(), side * e * vn, 1e-9 * vn);
    EXPECT_NEAR(now.velocity[0].x(), vt - mu * (1 + e) * vn, 1e-9 * vt);
    EXPECT_NEAR(std::abs(r * now.angularVelocity[0].y()), 2.5 * mu * (1 + e) * vn, 1e-9 * vt);
    EXPECT_LT(std::abs(sim.ledger().residual()), 1e-11 * sim.ledger().turnover);
  }
}

// A plate of no thickness, from both sides, at all places of the step and at all angles; standing still and moving towards the grain.
TEST(Continuous, NothingGoesThroughAThinPlate) {
  for (const Integrator integrator : integrators) {
    for (const double plateSpeed : {0.0, 40.0, -60.0}) {
      for (const double side : {1.0, -1.0}) {
        for (int start = 0; start < 15; ++start) {
          Scenario s = swept(integrator, 0.8);
          const double v = 450;
          s.grain(1e-5, 1e-3, {0.001, 0.002, side * (0.02 + 4e-4 * start)}, {7.0 * start, -3.0 * start, -side * v});
          WallMotion motion;
          if (plateSpeed != 0) motion = WallMotion({MotionPart{Translation{{0, 0, plateSpeed}}, 0, 1}});
          s.wall(Surface(rectangle(-0.1, 0.1, -0.1, 0.1, 0, 4, 4)), motion);
          Simulation sim = s.start(1e-5);
          const Ledger before = sim.ledger();
          sim.advance(12);
          const Snapshot now = look(sim);
          ASSERT_EQ(now.grains(), 1u);
          EXPECT_NEAR(now.velocity[0].z() - plateSpeed, 0.8 * side * (v + side * plateSpeed), 1e-9 * v);
          EXPECT_GT(side * (now.position[0].z() - plateSpeed * sim.time()), 0);
          EXPECT_LT(std::abs(sim.ledger().residual()), 1e-10 * before.mechanical());
          EXPECT_EQ(sim.counts().lost, 0u);
        }
      }
    }
  }
}

// On edges and corners of a cube: the energy is kept, and the grain ends outside.
TEST(Continuous, MeetsEdgesAndCorners) {
  for (int n = 0; n < 60; ++n) {
    Random random(3, static_cast<std::uint64_t>(n));
    Scenario s = swept(Integrator::velocityVerlet, 1);
    const Vec3 from = 0.02 * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)).normalized();
    const Vec3 to = 1e-3 * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    s.grain(1e-5, 1e-3, from, 700 * (to - from).normalized());
    s.wall(Surface(cube(1e-3)));
    Simulation sim = s.start(1e-5);
    const double before = sim.ledger().mechanical();
    sim.advance(5);
    EXPECT_EQ(sim.counts().impacts, 1u) << n;
    EXPECT_NEAR(sim.ledger().mechanical(), before, 1e-11 * before) << n;
    // Outside: as far from the cube as its radius at least.
    const Vec3 beside = (look(sim).position[0].cwiseAbs() - Vec3::Constant(1e-3)).cwiseMax(0);
    EXPECT_GT(beside.norm(), 1e-3 * (1 - 1e-9)) << n;
  }
}

// A crowd in a box, faster than springs could hold: nobody gets out, the account closes, and threads do not matter.
TEST(Continuous, ACrowdKeepsItsAccountAndItsBits) {
  const auto crowd = [](int threads) {
    Scenario s = swept(Integrator::velocityVerlet, 0.9, 0.3);
    s.model.watch.overlapLimit = 0.5;
    Random random(1, 1);
    for (int k = 0; k < 64; ++k)
      s.grain(1e-5 * (1 + k % 3), 1e-3, 4e-3 * Vec3(k % 4 + 1, k / 4 % 4 + 1, k / 16 + 1),
              200 * Vec3(random.normal(), random.normal(), random.normal()));
    for (int axis = 0; axis < 3; ++axis) {
      s.plane(Vec3::Zero(), Vec3::Unit(axis));
      s.plane(Vec3::Constant(0.02), -Vec3::Unit(axis));
    }
    return s.start(1e-5, threads);
  };
  Simulation one = crowd(1), two = crowd(2);
  const double before = one.ledger().mechanical();
  one.advance(200);
  two.advance(200);
  const Ledger after = one.ledger();
  fmt::print("  {} hard impacts, residual {:.1e} of the energy\n", one.counts().impacts, std::abs(after.residual()) / before);
  EXPECT_GT(one.counts().impacts, 500u);
  EXPECT_EQ(one.counts().lost, 0u);
  EXPECT_LT(std::abs(after.residual()), 2e-2 * before);
  EXPECT_LT(after.mechanical(), before);
  EXPECT_EQ(one.stateHash(), two.stateHash());
}

// Below the limit nothing is swept: the same bits as without.
TEST(Continuous, ChangesNothingForSlowGrains) {
  const auto pair = [](bool continuous) {
    Scenario s = swept(Integrator::velocityVerlet, 0.5, 0.3);
    s.model.continuous = continuous;
    s.grain(1e-5, 1e-3, {0, 0, 0}, {1, 0.2, 0});
    s.grain(1e-5, 1e-3, {2.1e-3, 0, 0});
    Simulation sim = s.start(1e-6);
    sim.advance(500);
    EXPECT_EQ(sim.counts().impacts, 0u);
    return sim.stateHash();
  };
  EXPECT_EQ(pair(true), pair(false));
}

TEST(Continuous, IsRefusedWhereItMakesNoSense) {
  for (const Integrator integrator : {Integrator::explicitEuler, Integrator::centralDifferences, Integrator::rungeKutta}) {
    Scenario s = swept(integrator, 0.5);
    s.grain(1e-5, 1e-3, {0, 0, 0});
    EXPECT_THROW(s.start(1e-6), Error);
  }
}

}  // namespace
}  // namespace tsubu::sim::test
