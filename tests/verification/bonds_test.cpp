// Bonded grains with known answers: beams, vibrations, rotation, breakage, and what they keep.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "verification/models.h"
#include "verification/shapes.h"

namespace tsubu::sim::test {
namespace {

constexpr std::array integrators{Integrator::symplecticEuler, Integrator::velocityVerlet};

/// Grains that only bonds join: contacts are there, but soft, and never reached.
Scenario bonded(const Bonding& bonding) {
  Scenario s;
  s.model.contact = {"linear", "spring", "none", false};
  s.pair[Property::normalStiffness] = 100;
  s.pair[Property::restitution] = 1;
  s.pair[Property::friction] = 0.3;
  s.model.bonds = {bonding};
  return s;
}

Bonding elastic(double stiffness) {
  Bonding bonding;
  bonding.name = "glue";
  bonding.distance = 1.1;
  bonding.radius = 0.8;
  bonding.stiffness = stiffness;
  bonding.stiffnessRatio = 1.7;
  return bonding;
}

/// A few grains of very unequal mass and size, all bonded with their neighbours, thrown and spinning.
Scenario cluster(Integrator integrator, bool turned = false) {
  Scenario s = bonded(elastic(2e10));
  s.model.integrator = integrator;
  struct Start {
    double mass, radius;
    Vec3 position, velocity, spin;
  };
  std::vector<Start> starts{{8e-6, 1e-3, {0, 0, 0}, {0.2, -0.1, 0.3}, {100, -300, 50}},
                            {3e-5, 1.5e-3, {2.55e-3, 0, 0}, {0, 0.4, -0.1}, {-200, 100, 0}},
                            {1e-5, 0.8e-3, {0.8e-3, 1.65e-3, 0.2e-3}, {-0.3, 0, 0.1}, {0, 0, 400}},
                            {2e-5, 1.2e-3, {0.9e-3, 0.5e-3, 2.0e-3}, {0.1, 0.2, 0}, {300, 0, -100}}};
  if (turned) std::reverse(starts.begin(), starts.end());
  for (const Start& g : starts) s.grain(g.mass, g.radius, g.position, g.velocity, g.spin);
  return s;
}

struct Drift {
  double worst, last;  ///< relative error of the energy
};

Drift driftOf(Integrator integrator, double dt, double time) {
  Simulation sim = cluster(integrator).start(dt);
  const double start = sim.ledger().mechanical();
  Drift drift{};
  const auto steps = static_cast<std::uint64_t>(std::llround(time / dt / 100));
  for (int k = 0; k < 100; ++k) {
    sim.advance(steps);
    drift.last = sim.ledger().mechanical() / start - 1;
    drift.worst = std::max(drift.worst, std::abs(drift.last));
  }
  EXPECT_GE(sim.counts().bonds, 5u);
  return drift;
}

// Undamped bonds keep the energy: the error is of the scheme's order and does not grow with time.
TEST(Bonds, KeepTheEnergy) {
  const Drift coarse = driftOf(Integrator::velocityVerlet, 4e-7, 4e-3), fine = driftOf(Integrator::velocityVerlet, 1e-7, 4e-3);
  const Drift euler = driftOf(Integrator::symplecticEuler, 4e-7, 4e-3), eulerFine = driftOf(Integrator::symplecticEuler, 1e-7, 4e-3);
  const Drift longer = driftOf(Integrator::velocityVerlet, 4e-7, 40e-3);
  const double order = std::log(coarse.worst / fine.worst) / std::log(4.0),
               eulerOrder = std::log(euler.worst / eulerFine.worst) / std::log(4.0);
  fmt::print(
      "  energy of bonded grains: velocity Verlet {:.1e} at 0.4 µs, order {:.2f}; ten times as long {:.1e}; symplectic Euler {:.1e}, order "
      "{:.2f}\n",
      coarse.worst, order, longer.worst, euler.worst, eulerOrder);
  EXPECT_NEAR(order, 2, 0.25);
  EXPECT_NEAR(eulerOrder, 1, 0.25);
  EXPECT_LT(coarse.worst, 1e-2);
  EXPECT_LT(longer.worst, 2 * coarse.worst);
}

TEST(Bonds, KeepBothMomenta) {
  for (const Integrator integrator : integrators) {
    for (const BondDamping damping : {BondDamping::none, BondDamping::percent, BondDamping::exponential, BondDamping::viscous}) {
      Scenario s = cluster(integrator);
      s.model.bonds[0].damping = damping;
      s.model.bonds[0].dampingOf = damping == BondDamping::exponential ? std::array{2e3, 2e3, 2e3, 2e3} : std::array{0.1, 0.1, 0.1, 0.1};
      Simulation sim = s.start(4e-7);
      const Ledger before = sim.ledger();
      sim.advance(10000);
      const Ledger after = sim.ledger();
      EXPECT_GE(after.dissipatedBonds, damping == BondDamping::none ? 0 : 0.05 * before.kinetic());
      EXPECT_LT((after.momentum - before.momentum).norm(), 1e-12 * before.momentum.norm());
      EXPECT_LT((after.angularMomentumRest - before.angularMomentumRest).norm(), 1e-11 * before.angularMomentumRest.norm());
      EXPECT_LT(std::abs(after.residual()), (integrator == Integrator::velocityVerlet ? 0.01 : 0.1) * before.kinetic());
    }
  }
}

TEST(Bonds, DoNotKnowWhichEndIsFirst) {
  Simulation one = cluster(Integrator::velocityVerlet).start(4e-7), other = cluster(Integrator::velocityVerlet, true).start(4e-7);
  one.advance(3000);
  other.advance(3000);
  const Snapshot a = look(one), b = look(other);
  for (std::size_t g = 0; g < 4; ++g) {
    EXPECT_LT((a.position[g] - b.position[3 - g]).norm(), 1e-12);
    EXPECT_LT((a.angularVelocity[g] - b.angularVelocity[3 - g]).norm(), 1e-6);
  }
}

// A bar of unequal grains that turns as a rigid body stays one: the bonds feel nothing but the centrifugal pull.
TEST(Bonds, FreeBarTurns) {
  Scenario s = bonded(elastic(1e12));
  const Vec3 along = Vec3(1, 2, -0.5).normalized(),
             spin = 50 * Vec3(Vec3(0.3, -0.4, 1) - Vec3(0.3, -0.4, 1).dot(along) * along).normalized();
  double x = 0;
  const double radii[] = {1e-3, 1.5e-3, 0.8e-3, 1.2e-3, 1.4e-3};
  Vec3 centre = Vec3::Zero();
  double mass = 0;
  for (int pass = 0; pass < 2; ++pass) {
    x = 0;
    for (int k = 0; k < 5; ++k) {
      const double r = radii[k], m = 1e4 * r * r * r;
      if (k > 0) x += radii[k - 1] + r;
      if (pass == 0)
        centre += m * x * along, mass += m;
      else
        s.grain(m, r, x * along, spin.cross(Vec3(x * along - centre / mass)), spin);
    }
  }
  Simulation sim = s.start(2e-7);
  const Ledger before = sim.ledger();
  const auto steps = static_cast<std::uint64_t>(2 * pi / 50 / 2e-7);  // a full turn
  sim.advance(steps);
  const Ledger after = sim.ledger();
  EXPECT_NEAR(after.kinetic(), before.kinetic(), 1e-5 * before.kinetic());
  EXPECT_LT((after.angularMomentumRest - before.angularMomentumRest).norm(), 1e-11 * before.angularMomentumRest.norm());
  EXPECT_LT(after.elasticBonds, 1e-5 * before.kinetic());
  const Snapshot now = look(sim);
  const Vec3 bar = (now.position[4] - now.position[0]).normalized();
  EXPECT_GT(bar.dot(along), 1 - 1e-6);
}

/// Tip of a cantilever of n grains under its own weight over the deflection of the beam (Timoshenko: bending and shear), less 1. The
/// beam swings without damping about its rest, which is a mean with smooth weights over many swings.
double cantilever(int n, double length) {
  const double radius = 0.5 * length / n, modulus = 2e8, mass = 1e-3 / n, g = 0.4;
  Bonding bonding = elastic(0);
  bonding.modulus = modulus;
  bonding.radius = 1;
  bonding.stiffnessRatio = 2.5;
  Bonding clamp = bonding;
  clamp.wall = 0;
  Scenario s = bonded(bonding);
  s.model.bonds.push_back(clamp);
  s.model.gravity = {0, 0, -g};
  s.model.ledger = false;
  s.plane({0, 0, 0}, {1, 0, 0});
  s.pair[Property::normalStiffness] = 1e-3;  // the wall itself does not help
  for (int k = 0; k < n; ++k) s.grain(mass, radius, {(2 * k + 1) * radius, 0, 0});
  const double inertia = pi * std::pow(radius, 4) / 4, area = pi * radius * radius, load = mass * n * g / length, x = length - radius;
  const double bend = load * x * x * (6 * length * length - 4 * length * x + x * x) / (24 * modulus * inertia);
  const double shear = load * (length * x - 0.5 * x * x) * bonding.stiffnessRatio / (modulus * area);
  const double period = 2 * pi / (3.516 * std::sqrt(modulus * inertia / (mass * n * std::pow(length, 3))));
  Simulation sim = s.start(0.4 * std::sqrt(mass / (modulus / (2 * radius) * area)));
  const int samples = 1500;
  double sum = 0, weights = 0;
  for (int k = 0; k < samples; ++k) {
    const double weight = 1 - std::cos(2 * pi * (k + 0.5) / samples);
    sim.advance(static_cast<std::uint64_t>(8.3 * period * (k + 1) / samples / sim.timeStep()) - sim.steps());
    sum -= weight * look(sim).position.back().z();
    weights += weight;
  }
  return sum / weights / (bend + shear) - 1;
}

TEST(Bonds, CantileverBendsAsABeam) {
  double before = 0;
  for (const int n : {4, 8, 16}) {
    const double error = cantilever(n, 0.1);
    fmt::print("  cantilever of {} grains: {:+.3e} of the deflection\n", n, error);
    if (n > 4) {
      EXPECT_NEAR(std::log2(std::abs(before / error)), 2, 0.4);
    }
    before = error;
  }
  EXPECT_LT(std::abs(before), 5e-3);
}

/// Two grains so heavy that bonds do not move them, led apart; returns the time at which their bond breaks.
struct Pulled {
  double time = 0, distance = 0;
  Ledger ledger;
};
Pulled pull(const BondStrength& strength, const Vec3& velocity, const Vec3& spin, double modifier = 1) {
  Bonding bonding = elastic(1e10 * modifier);
  bonding.strength = strength;
  Scenario s = bonded(bonding);
  s.grain(1e6, 1e-3, {0, 0, 0}, Vec3::Zero(), -0.5 * spin);
  s.grain(1e6, 1.4e-3, {2.45e-3, 0, 0}, velocity, 0.5 * spin);
  Simulation sim = s.start(1e-5);
  while (sim.counts().broken == 0 && sim.time() < 1) sim.advance(1);
  const Ledger ledger = sim.ledger();
  const Snapshot now = look(sim);
  return {sim.time(), (now.position[1] - now.position[0]).norm(), ledger};
}

// Each way to break, at the stress that was stated: k_n = 1e10 N/m³, k_t = k_n/1.7, r_b = 0.8 mm, one way at a time.
TEST(Breakage, AtTheStatedStress) {
  const double never = BondStrength::never, k = 1e10, kt = k / 1.7, rb = 0.8e-3, area = pi * rb * rb, inertia = pi * std::pow(rb, 4) / 4;
  const double v = 1e-3, omega = 1.5;
  const BondStrength tension{5e5, never, never, 0, never}, compression{never, 7e5, never, 0, never}, shear{never, never, 3e5, 0, never};
  const auto expectTime = [](const Pulled& pulled, double time, const char* what) {
    EXPECT_NEAR(pulled.time, time, 2.5e-5 + 1e-4 * time) << what;
  };

  const Pulled pulled = pull(tension, {v, 0, 0}, Vec3::Zero());
  expectTime(pulled, 5e5 / k / v, "tension");
  EXPECT_NEAR(pulled.ledger.dissipatedBreakage, 0.5 * k * area * std::pow(5e5 / k, 2), 0.01 * pulled.ledger.dissipatedBreakage);
  EXPECT_EQ(pulled.ledger.elasticBonds, 0);
  expectTime(pull(tension, {0, 0, 0}, {0, omega, 0}), 5e5 / (k * rb) / omega, "bending");
  expectTime(pull(compression, {-v, 0, 0}, Vec3::Zero()), 7e5 / k / v, "compression");
  EXPECT_EQ(pull(tension, {-v / 50, 0, 0}, Vec3::Zero()).ledger.dissipatedBreakage, 0) << "compression is harmless by default";
  const Pulled twisted = pull(shear, Vec3::Zero(), {omega, 0, 0});
  expectTime(twisted, 3e5 / (kt * rb) / omega, "torsion");
  EXPECT_NEAR(twisted.ledger.dissipatedBreakage, 0.5 * kt * 2 * inertia * std::pow(3e5 / (kt * rb), 2),
              0.01 * twisted.ledger.dissipatedBreakage);
  expectTime(pull(shear, {0, v, 0}, Vec3::Zero()), 3e5 / kt / v, "shear");
  // Pressed at 3 v while it shears at v: τ_max + σ_c tan φ is reached when k_t v t = τ_max + 3 k_n v t tan φ.
  const double slope = 0.15;
  expectTime(pull({never, never, 1e3, slope, never}, {-0.3 * v, 0.1 * v, 0}, Vec3::Zero()), 1e3 / (0.1 * v * (kt - 3 * slope * k)),
             "shear under pressure");
  expectTime(pull({never, never, never, 0, 1.03}, {v, 0, 0}, Vec3::Zero()), 0.03 * 2.45e-3 / v, "distance");
}

// When a bond breaks the ledger closes: what it held is booked, at the order of the scheme, in each kind of damping.
TEST(Breakage, IsBooked) {
  for (const BondDamping damping : {BondDamping::none, BondDamping::percent, BondDamping::exponential, BondDamping::viscous}) {
    const auto residual = [&](double dt) {
      Scenario s = cluster(Integrator::velocityVerlet);
      s.model.bonds[0].damping = damping;
      s.model.bonds[0].dampingOf =
          damping == BondDamping::exponential ? std::array{2e3, 2e3, 2e3, 2e3} : std::array{0.05, 0.05, 0.05, 0.05};
      s.model.bonds[0].strength.tension = 4e4;
      s.model.bonds[0].strength.shear = 4e4;
      Simulation sim = s.start(dt);
      sim.advance(static_cast<std::uint64_t>(2e-4 / dt));
      EXPECT_GT(sim.counts().broken, 1u);
      const Ledger now = sim.ledger();
      EXPECT_GT(now.dissipatedBreakage, 0.02 * now.initial);
      return std::abs(now.residual()) / now.initial;
    };
    const double coarse = residual(4e-7), fine = residual(1e-7);
    fmt::print("  residual after breakage: {:.1e} at 0.4 µs, {:.1e} at 0.1 µs\n", coarse, fine);
    EXPECT_LT(coarse, 4e-3);
    EXPECT_LT(fine, 4e-4);
  }
}

/// Amplitude of a bonded pair that swings along its bond, after one whole swing, over that before.
double decay(BondDamping damping, double value) {
  Bonding bonding = elastic(1e9);
  bonding.damping = damping;
  bonding.dampingOf.fill(value);
  Scenario s = bonded(bonding);
  s.grain(1e-5, 1e-3, {0, 0, 0}, {-0.01, 0, 0});
  s.grain(3e-5, 1.5e-3, {2.6e-3, 0, 0}, {0.01 / 3, 0, 0});
  Simulation sim = s.start(2e-8);
  std::vector<double> peaks;
  double last = 0, before = 0;
  while (peaks.size() < 3 && sim.time() < 1) {
    sim.advance(1);
    const Snapshot now = look(sim);
    const double stretch = now.position[1].x() - now.position[0].x() - 2.6e-3;
    if (std::abs(last) > std::abs(before) && std::abs(last) >= std::abs(stretch)) peaks.push_back(std::abs(last));
    before = last;
    last = stretch;
  }
  return peaks[2] / peaks[0];
}

TEST(BondDampers, DecayAsTheyShould) {
  const double zeta = 0.07, share = 0.06, rate = 400;
  EXPECT_NEAR(decay(BondDamping::viscous, zeta), std::exp(-2 * pi * zeta / std::sqrt(1 - zeta * zeta)), 2e-3);
  // Out against k(1 + η), back with k(1 − η): each half swing keeps √((1 − η)/(1 + η)).
  EXPECT_NEAR(decay(BondDamping::percent, share), (1 - share) / (1 + share), 2e-3);
  // A Maxwell spring: m ẍ = −F, Ḟ = k ẋ − η F, so λ² + ηλ + ω² = 0 for F, decaying with ½ η per time.
  const double k = 1e9 * pi * 0.64e-6, omega = std::sqrt(k / (1e-5 * 3e-5 / 4e-5) - rate * rate / 4);
  EXPECT_NEAR(decay(BondDamping::none, 0), 1, 1e-5);
  Bonding bonding = elastic(1e9);
  bonding.damping = BondDamping::exponential;
  bonding.dampingOf.fill(rate);
  Scenario s = bonded(bonding);
  s.grain(1e-5, 1e-3, {0, 0, 0}, {-0.01, 0, 0});
  s.grain(3e-5, 1.5e-3, {2.6e-3, 0, 0}, {0.01 / 3, 0, 0});
  Simulation sim = s.start(2e-8);
  const double start = sim.ledger().kinetic();
  const double period = 2 * pi / omega;
  sim.advance(static_cast<std::uint64_t>(std::llround(period / 2e-8)));
  const Snapshot now = look(sim);
  // F(0) = 0 and F ~ e^{−ηt/2} sin Ωt: the velocity is −∫F/m, after one period v/v_0 = 1 − ω²/(ω²)(1 − e^{−ηT/2}) = e^{−ηT/2}.
  EXPECT_NEAR((now.velocity[1].x() - now.velocity[0].x()) / (0.04 / 3), std::exp(-0.5 * rate * period), 2e-3);
  const Ledger ledger = sim.ledger();
  EXPECT_LT(std::abs(ledger.residual()), 1e-5 * start);
}

// Bonded grains that are pressed together: their contact is off, or acts where the bond is shorter than it was made.
TEST(BondedContacts, AreOffOrBeginAtRest) {
  for (const bool beyondRest : {false, true}) {
    Bonding bonding = elastic(1e9);
    bonding.contactBeyondRest = beyondRest;
    Scenario s = bonded(bonding);
    s.pair[Property::normalStiffness] = 4000;
    s.grain(1e-5, 1e-3, {0, 0, 0}, {0.02, 0, 0});
    s.grain(1e-5, 1e-3, {1.98e-3, 0, 0}, {-0.02, 0, 0});  // they overlap from the start
    const double k = 1e9 * pi * 0.64e-6 + (beyondRest ? 4000 : 0);
    Simulation sim = s.start(1e-7);
    const double half = pi / std::sqrt(k * 2 / 1e-5);
    sim.advance(static_cast<std::uint64_t>(std::llround(0.5 * half / 1e-7)));
    const Snapshot now = look(sim);
    EXPECT_NEAR(now.velocity[0].x(), 0, 0.02 * 0.002);
    EXPECT_NEAR(1.98e-3 - (now.position[1].x() - now.position[0].x()), 0.04 / std::sqrt(k * 2 / 1e-5), 1e-9);
    EXPECT_EQ(sim.contacts().touching, beyondRest ? 1u : 0u);
    EXPECT_LT(std::abs(sim.ledger().residual()), 1e-5 * sim.ledger().initial);
  }
}

// Pressed grains that are bonded: their contact stops, and what it held is in the ledger.
TEST(BondedContacts, ArePaidForWhenTheyStop) {
  Bonding bonding = elastic(1e9);
  bonding.start = bonding.end = 2e-5;
  Scenario s = bonded(bonding);
  s.pair[Property::normalStiffness] = 4000;
  s.grain(1e-5, 1e-3, {0, 0, 0}, {0.02, 0, 0});
  s.grain(1e-5, 1e-3, {2e-3, 0, 0}, {-0.02, 0, 0});
  Simulation sim = s.start(1e-8);
  sim.advance(10000);
  const Ledger ledger = sim.ledger();
  EXPECT_EQ(sim.counts().bonds, 1u);
  EXPECT_GT(ledger.dissipatedBonds, 0.1 * ledger.initial);
  EXPECT_LT(std::abs(ledger.residual()), 1e-3 * ledger.initial);
}

// A bond that breaks while its grains are pressed together leaves a contact that begins there: no energy from nowhere.
TEST(BondedContacts, DoNotSpringFromABreak) {
  Bonding bonding = elastic(1e9);
  bonding.strength.compression = 1e3;
  Scenario s = bonded(bonding);
  s.pair[Property::normalStiffness] = 4000;
  s.grain(1e-5, 1e-3, {0, 0, 0}, {0.02, 0, 0});
  s.grain(1e-5, 1e-3, {1.98e-3, 0, 0}, {-0.02, 0, 0});
  Simulation sim = s.start(1e-7);
  sim.advance(20000);
  const Ledger ledger = sim.ledger();
  EXPECT_EQ(sim.counts().broken, 1u);
  EXPECT_EQ(sim.contacts().touching, 0u);
  EXPECT_LT(std::abs(ledger.residual()), 1e-4 * ledger.initial);
  EXPECT_NEAR(ledger.kinetic() + ledger.dissipatedBreakage, ledger.initial, 1e-4 * ledger.initial);
  // They have parted beyond their radii: thrown at each other again they touch like any others.
  const Snapshot now = look(sim);
  EXPECT_GT(now.position[1].x() - now.position[0].x(), 2e-3);
}

// A grain glued to a wall goes with it; what the wall does is in the ledger.
TEST(WallBonds, CarryAGrainAlong) {
  for (const Integrator integrator : integrators) {
    const auto residual = [&](double dt) {
      Bonding bonding = elastic(3e9);
      bonding.wall = 0;
      Scenario s = bonded(bonding);
      s.model.integrator = integrator;
      s.model.gravity = {0, 0, -9.81};
      s.wall(Surface(rectangle(-0.02, 0.02, -0.02, 0.02, 0, 1, 1)),
             WallMotion(
                 {{Oscillation{{1e-3, 2e-4, -4e-4}, 60, 0.3}, 0, 1e9}, {Rotation{{0.01, 0, 0}, Vec3(1, 1, 2).normalized(), 30}, 0, 1e9}}));
      s.grain(2e-5, 1e-3, {3e-3, 1e-3, -1.05e-3});
      Simulation sim = s.start(dt);
      sim.advance(static_cast<std::uint64_t>(std::llround(0.03 / dt)));
      const Ledger now = sim.ledger();
      EXPECT_EQ(sim.counts().bonds, 1u);
      EXPECT_GT(std::abs(now.workWalls), 1e-6);
      const Pose pose = s.model.walls[0].motion.at(sim.time());
      EXPECT_LT((look(sim).position[0] - pose.toWorld({3e-3, 1e-3, -1.05e-3})).norm(), 1e-4);
      return std::abs(now.residual()) / std::abs(now.workWalls);
    };
    const double coarse = residual(2e-6), fine = residual(5e-7);
    fmt::print("  grain glued to a moving wall: residual {:.1e} at 2 µs, {:.1e} at 0.5 µs\n", coarse, fine);
    EXPECT_LT(fine, integrator == Integrator::velocityVerlet ? 1e-4 : 1e-2);
    EXPECT_LT(fine, 0.4 * coarse);
  }
}

}  // namespace
}  // namespace tsubu::sim::test
