// At the extremes of what may be asked of a contact: sane numbers and bounded energy, or a refusal that says why; never silence, never
// "not a number". Coincident centres, centres on walls, no grains at all, thin walls: tests/sim/watch_test.cpp.

#include <functional>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "sim/laws/catalogue.h"
#include "sim/time_step.h"
#include "verification/models.h"
#include "verification/shapes.h"

namespace tsubu::sim::test {
namespace {

constexpr std::array everyIntegrator{Integrator::explicitEuler,      Integrator::symplecticEuler, Integrator::leapfrog,
                                     Integrator::centralDifferences, Integrator::velocityVerlet,  Integrator::rungeKutta};

Model complete(const Scenario& s) {
  Model m = s.model;
  m.pairs = PairTable(m.materials.size());
  for (std::size_t a = 0; a < m.materials.size(); ++a)
    for (std::size_t b = a; b < m.materials.size(); ++b) m.pairs.set(a, b, s.pair);
  return m;
}

Simulation startAt(Scenario& s, double shareOfLimit) { return s.start(shareOfLimit * chooseTimeStep(complete(s)).limit); }

/// The same for headOn: the contact begins within the first step, at 0.37 of it.
Simulation startBefore(Scenario& s, double shareOfLimit) {
  const double dt = shareOfLimit * chooseTimeStep(complete(s)).limit;
  s.model.grains[1].position.x() += 0.37 * s.model.grains[0].velocity.x() * dt;
  return s.start(dt);
}

/// What it said when it refused; empty when it did not.
std::string refusal(const std::function<void()>& run) {
  try {
    run();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

bool finite(Simulation& sim) {
  const Snapshot now = look(sim);
  bool all = true;
  for (std::size_t g = 0; g < now.grains(); ++g) {
    all = all && now.position[g].allFinite() && now.velocity[g].allFinite();
    if (!now.angularVelocity.empty()) all = all && now.angularVelocity[g].allFinite();
  }
  const Ledger ledger = sim.ledger();
  return all && std::isfinite(ledger.mechanical() + ledger.dissipated() + ledger.residual());
}

/// Two grains on a line that are about to touch, the first coming at `speed`.
Scenario headOn(double mass1, double radius1, double mass2, double radius2, double speed) {
  Scenario s;
  s.model.domain = Box(Vec3::Constant(-1e3), Vec3::Constant(1e3));
  s.grain(mass1, radius1, {0, 0, 0}, {speed, 0, 0});
  s.grain(mass2, radius2, {radius1 + radius2, 0, 0});
  return s;
}

/// Until they have parted, or `most` steps.
void collide(Simulation& sim, int most) {
  for (int n = 0; n < most && (n < 20 || sim.contacts().touching > 0); n += 10) sim.advance(10);
}

double restitutionOf(Simulation& sim, double speed) {
  const Snapshot after = look(sim);
  return (after.velocity[1].x() - after.velocity[0].x()) / speed;
}

TEST(Extremes, RestitutionDownToNothing) {
  for (const Integrator integrator : everyIntegrator) {
    for (const char* law : {"linear", "hertz"}) {
      for (const double e : {1e-6, 1e-3, 0.02}) {
        Scenario s = headOn(1e-5, 1e-3, 3e-5, 1.5e-3, 0.1);
        s.model.integrator = integrator;
        s.model.contact.normal = law;
        s.pair[Property::normalStiffness] = 1e4;
        s.pair[Property::restitution] = e;
        for (Material& m : s.model.materials) m.values[Property::youngModulus] = 1e8, m.values[Property::poissonRatio] = 0.3;
        Simulation sim = startAt(s, 0.1);
        collide(sim, 3000);  // they hardly part
        const double measured = restitutionOf(sim, 0.1);
        EXPECT_NEAR(measured, e, 0.1 * e + 2e-3) << schemeOf(integrator).name << ' ' << law << ' ' << e;
      }
    }
  }
}

// Schwager & Pöschel (2007): above the critical damping e = exp[−(ζ/ω) ln((ζ+ω)/(ζ−ω))], ω = √(ζ²−1), which falls as 1/(2ζ)².
TEST(Extremes, DampingFarBeyondCritical) {
  for (const double zeta : {2.0, 10.0, 1e3, 1e6}) {
    const double mass = 1e-5, k = 1e4, effective = mass / 2, w = std::sqrt(zeta * zeta - 1);
    // ζ − ω = 1/(ζ + ω)
    const double expected = std::exp(-2 * zeta / w * std::log(zeta + w));
    Scenario s = headOn(mass, 1e-3, mass, 1e-3, 0.1);
    s.pair[Property::normalStiffness] = k;
    s.pair[Property::normalDampingRate] = 2 * zeta * std::sqrt(k / effective);
    Simulation sim = startAt(s, 0.05);
    collide(sim, 40000);
    EXPECT_TRUE(finite(sim));
    const double measured = restitutionOf(sim, 0.1);
    EXPECT_GE(measured, -1e-12) << zeta;  // they may still be creeping apart
    EXPECT_NEAR(measured, expected, 2e-3) << zeta;
    EXPECT_LE(sim.ledger().mechanical(), 0.5 * mass * 0.01) << zeta;
  }
}

// On an incline of angle α a sphere that sticks rolls down with (5/7) g sin α, whatever μ is above (2/7) tan α; without friction it slides
// with g sin α.
TEST(Extremes, FrictionFromNothingToAMillion) {
  const double alpha = 0.7, g = 9.81, mass = 2e-4, r = 2e-3, k = 2e4, span = 0.05;
  for (const char* law : {"spring", "projected", "frozen_spring", "luding_spring", "limited_spring"}) {
    for (const double mu : {0.0, 10.0, 1e6}) {
      Scenario s;
      s.model.contact.tangential = law;
      s.model.gravity = {g * std::sin(alpha), 0, -g * std::cos(alpha)};
      s.model.domain = Box(Vec3::Constant(-1), Vec3::Constant(1));
      s.pair[Property::normalStiffness] = k;
      s.pair[Property::restitution] = 0.3;
      s.pair[Property::friction] = mu;
      s.grain(mass, r, {0, 0, r - mass * g * std::cos(alpha) / k});
      s.plane({0, 0, 0}, {0, 0, 1});
      Simulation sim = startAt(s, 0.2);
      sim.advance(static_cast<std::uint64_t>(span / sim.timeStep()));
      const double expected = (mu > 0 ? 5.0 / 7 : 1) * g * std::sin(alpha) * sim.time();
      const Snapshot now = look(sim);
      EXPECT_NEAR(now.velocity[0].x(), expected, 2e-3 * expected) << law << ' ' << mu;
      EXPECT_NEAR(r * now.angularVelocity[0].y(), mu > 0 ? expected : 0, 2e-3 * expected) << law << ' ' << mu;
    }
  }
}

TEST(Extremes, MassesOfOneToABillionAndRadiiOfOneToAHundred) {
  for (const Integrator integrator : {Integrator::symplecticEuler, Integrator::velocityVerlet, Integrator::rungeKutta}) {
    for (const double ratio : {1.0, 100.0}) {
      for (const double e : {0.3, 1.0}) {
        Scenario s = headOn(1e-9, 1e-4, 1, 1e-4 * ratio, 0.2);
        s.model.integrator = integrator;
        s.model.contact.tangential = "spring";
        s.model.grains[0].velocity.y() = 0.1;
        s.model.grains[0].angularVelocity = {300, -200, 500};
        s.pair[Property::normalStiffness] = 100;
        s.pair[Property::restitution] = e;
        s.pair[Property::friction] = 0.5;
        Simulation sim = startBefore(s, 0.02);
        const Ledger before = sim.ledger();
        collide(sim, 20000);
        const Ledger after = sim.ledger();
        EXPECT_NEAR(restitutionOf(sim, 0.2), e, 2e-3) << ratio;
        EXPECT_LT((after.momentum - before.momentum).norm(), 1e-12 * before.momentum.norm()) << ratio;
        EXPECT_LT(std::abs(after.residual()), (integrator == Integrator::symplecticEuler ? 2e-3 : 3e-5) * before.mechanical()) << ratio;
      }
    }
  }
}

// Only ω Δt matters: with the step as a share of the limit a collision is the same for any stiffness, to what positions are rounded to.
TEST(Extremes, StiffnessFromOneToATrillion) {
  double first = 0;
  for (double k = 1; k < 2e12; k *= 1e3) {
    Scenario s = headOn(1e-5, 1e-3, 1e-5, 1e-3, 0.01);
    s.pair[Property::normalStiffness] = k;
    s.pair[Property::restitution] = 0.7;
    Simulation sim = startBefore(s, 0.1);
    collide(sim, 20000);
    if (k == 1) first = restitutionOf(sim, 0.01);
    EXPECT_NEAR(first, 0.7, 1e-3);
    EXPECT_NEAR(restitutionOf(sim, 0.01), first, 1e-6) << k;
  }
}

// A grain that would cross another, or a wall, within one step is named before anything is written.
TEST(Extremes, CrossingInOneStepIsNoticed) {
  for (const bool wall : {false, true}) {
    Scenario s;
    s.model.watch = Watch{};
    s.model.domain = Box(Vec3::Constant(-10), Vec3::Constant(10));
    s.pair[Property::normalStiffness] = 1e4;
    s.pair[Property::restitution] = 0.5;
    s.grain(1e-5, 1e-3, {-5e-3, 0, 0}, {1e4, 0, 0});
    if (wall)
      s.wall(Surface(cube(1e-3)));
    else
      s.grain(1e-5, 1e-3, {0, 0, 0});
    const std::string why = refusal([&] { s.start(1e-6).advance(2); });
    EXPECT_NE(why.find("of its radius in one step"), std::string::npos) << why;
    EXPECT_NE(why.find("grain 0"), std::string::npos) << why;
    s.model.watch.stop = false;
    Simulation sim = s.start(1e-6);
    sim.advance(5);
    EXPECT_FALSE(sim.warnings().empty());
    EXPECT_TRUE(finite(sim));
  }
}

// What rests on a face also rests on the seam of its triangles, in a corner between three walls, and, as long as nothing disturbs it,
// exactly on an edge and on a corner that points up.
TEST(Extremes, RestingOnSeamEdgeAndCorner) {
  const double mass = 1e-5, r = 1e-3, k = 1e4, g = 9.81, h = 0.01, sink = mass * g / k;
  const double far = r - sink;
  const auto rests = [&](Surface surface, const Vec3& start, const Vec3& down) {
    Scenario s;
    s.model.gravity = g * down;
    s.model.domain = Box(Vec3::Constant(-1), Vec3::Constant(1));
    s.model.contact.tangential = "spring";
    s.pair[Property::normalStiffness] = k;
    s.pair[Property::restitution] = 0.5;
    s.pair[Property::friction] = 0.5;
    s.grain(mass, r, start);
    s.wall(std::move(surface));
    Simulation sim = startAt(s, 0.2);
    sim.advance(2000);
    EXPECT_TRUE(finite(sim));
    return (look(sim).position[0] - start).norm();
  };
  EXPECT_LT(rests(Surface(cube(h)), {0, 0, h + far}, {0, 0, -1}), 1e-12);  // on the diagonal of a face
  EXPECT_LT(rests(Surface(cube(h)), Vec3(0, h, h) + far * Vec3(0, 1, 1).normalized(), Vec3(0, -1, -1).normalized()), 1e-9);
  EXPECT_LT(rests(Surface(cube(h)), Vec3(h, h, h) + far * Vec3(1, 1, 1).normalized(), Vec3(-1, -1, -1).normalized()), 1e-9);
  EXPECT_LT(rests(Surface(cube(h)), {-h, -h, h + far}, {0, 0, -1}), 1e-9);  // above a corner, beside nothing
  const double deep = r - sink / std::sqrt(3.0);                            // inside: three faces carry it
  EXPECT_LT(rests(Surface(cube(h)), Vec3::Constant(-h + deep), Vec3(-1, -1, -1).normalized()), 1e-9);
}

// A million metres from the origin a position is known to 1e-10 m: what a collision is off by is the share of that in the overlap.
TEST(Extremes, AMillionMetresFromTheOrigin) {
  std::array<Vec3, 2> after;
  for (const bool away : {false, true}) {
    const Vec3 at = away ? Vec3(1e6, -1e6, 1e6) : Vec3::Zero();
    Scenario s;
    s.model.contact.tangential = "spring";
    s.model.domain = Box(at - Vec3::Constant(1), at + Vec3::Constant(1));
    s.pair[Property::normalStiffness] = 100;
    s.pair[Property::restitution] = 0.6;
    s.pair[Property::friction] = 0.4;
    s.grain(1e-5, 1e-3, at + Vec3(0, 0, 1.0001e-3), {0.1, 0.03, -0.2}, {30, 50, -20});
    s.plane(at, {0, 0, 1});
    Simulation sim = startAt(s, 0.05);
    collide(sim, 20000);
    EXPECT_TRUE(finite(sim));
    after[away ? 1 : 0] = look(sim).velocity[0];
  }
  EXPECT_NEAR(after[0].z(), 0.12, 1e-3);
  EXPECT_LT((after[1] - after[0]).norm(), 1e-4);  // overlaps reach 6e-5 m
}

TEST(Extremes, GravityOfNothingAndOfAMillion) {
  Scenario s;
  s.model.watch = Watch{};
  s.model.contact.tangential = "spring";
  s.pair[Property::restitution] = 0.5;
  s.pair[Property::friction] = 0.5;
  s.grain(1e-5, 1e-3, {0, 0, 1e-3});
  s.plane({0, 0, 0}, {0, 0, 1});
  s.pair[Property::normalStiffness] = 1e4;
  Simulation weightless = startAt(s, 0.2);
  weightless.advance(1000);
  EXPECT_EQ(look(weightless).position[0], Vec3(0, 0, 1e-3));
  s.model.gravity = {0, 0, -1e6};  // 10 N
  const std::string why = refusal([&] { startAt(s, 0.2).advance(3000); });
  EXPECT_NE(why.find("too soft for the load"), std::string::npos) << why;
  s.pair[Property::normalStiffness] = 1e7;
  Simulation heavy = startAt(s, 0.2);
  heavy.advance(20000);
  EXPECT_NEAR(look(heavy).position[0].z(), 1e-3 - 1e-6, 1e-9);
  EXPECT_LT(look(heavy).velocity[0].norm(), 1e-6);
}

// One large grain makes cells in which thousands of small ones lie: still every contact is found, and no other.
TEST(Extremes, VeryManyGrainsInOneCell) {
  Scenario s;
  s.model.watch.overlapLimit = 2;
  s.pair[Property::normalStiffness] = 1e-3;
  s.pair[Property::restitution] = 0.5;
  Material dust;
  dust.name = "dust";
  dust.values[Property::density] = 2500;
  s.model.materials.push_back(dust);
  Random random(4, 2);
  const auto add = [&](const Vec3& x, double r) {
    Grain g;
    g.position = x;
    g.radius = r;
    s.model.grains.push_back(g);
  };
  add({0.2, 0, 0}, 0.1);
  for (int n = 0; n < 2500; ++n) add(Vec3(random.uniform(0, 0.05), random.uniform(0, 0.05), random.uniform(0, 0.05)), 1e-3);
  std::uint64_t expected = 0;
  for (std::size_t i = 0; i < s.model.grains.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Grain &a = s.model.grains[i], &b = s.model.grains[j];
      expected += (a.position - b.position).norm() < a.radius + b.radius ? 1 : 0;
    }
  }
  Simulation sim = s.start(1e-7);
  EXPECT_GT(expected, 500u);
  EXPECT_EQ(sim.contacts().touching, expected);
  sim.advance(3);
  EXPECT_TRUE(finite(sim));
}

// Numbers below the smallest normal ones: forces and energies underflow, nothing is divided by them.
TEST(Extremes, Denormals) {
  for (const double tiny : {1e-300, 1e-310, 5e-324}) {
    Scenario s = headOn(1e-5, 1e-3, 1e-5, 1e-3, tiny);
    s.model.contact = {"linear", "spring", "elastic_plastic", false, "spring"};
    s.pair[Property::normalStiffness] = 1e3;
    s.pair[Property::restitution] = 0.5;
    s.pair[Property::friction] = 0.5;
    s.pair[Property::rollingFriction] = 0.1;
    s.pair[Property::twistingFriction] = 0.1;
    s.model.grains[0].angularVelocity = Vec3::Constant(tiny);
    s.model.grains[1].position.x() -= 1e-18;
    Simulation sim = startAt(s, 0.2);
    sim.advance(500);
    EXPECT_TRUE(finite(sim));
    EXPECT_LT(look(sim).velocity[0].norm(), 1e-10);
  }
}

/// A grain between two planes that press it, disturbed by a nanometre.
Scenario pressed(double zeta) {
  Scenario s;
  s.model.contact.tension = true;
  s.model.watch = Watch{0.11, 0.1, true};  // the planes press it by 0.1
  const double mass = 1e-5, k = 800, r = 2e-3;
  s.pair[Property::normalStiffness] = k;
  s.pair[Property::normalDampingRate] = zeta * std::sqrt(2 * k / mass);
  s.grain(mass, r, {0, 0, 1e-9});
  s.plane({0, 0, -0.9 * r}, {0, 0, 1});
  s.plane({0, 0, 0.9 * r}, {0, 0, -1});
  return s;
}

// Just below the limit it runs; just above it ends with a sentence before there is anything that is not a number.
TEST(Extremes, StepsAroundTheLimit) {
  for (const Integrator integrator : everyIntegrator) {
    for (const double zeta : {0.1, 1.0, 3.0}) {
      Scenario s = pressed(zeta);
      s.model.integrator = integrator;
      const double omega = std::sqrt(2 * 800 / 1e-5), limit = stableStep({omega * omega, 2 * zeta * omega}, integrator, true);
      SCOPED_TRACE(fmt::format("{} {}", schemeOf(integrator).name, zeta));
      Simulation sim = s.start(0.99 * limit);
      sim.advance(20000);
      EXPECT_LT(std::abs(look(sim).position[0].z()), 1e-7);
      const std::string why = refusal([&] { s.start(1.01 * limit).advance(50000); });
      EXPECT_TRUE(why.find("Overlap") != std::string::npos || why.find("in one step") != std::string::npos ||
                  why.find("Not a number") != std::string::npos)
          << why;
    }
  }
}

// Time is counted in steps, not summed up: after a million of them it is exact, and what moves by the clock is where it should be.
TEST(Extremes, AMillionSeconds) {
  Scenario s;
  const double mass = 1, k = 0.02, r = 1, infinity = std::numeric_limits<double>::infinity();
  s.model.contact.tension = true;
  s.model.watch = Watch{0.9, 0.9, false};
  s.pair[Property::normalStiffness] = k;
  s.pair[Property::restitution] = 1;
  s.grain(mass, r, {0, 0, 0.1});
  s.plane({0, 0, -0.7}, {0, 0, 1});
  s.plane({0, 0, 0.7}, {0, 0, -1});
  s.wall(Surface(cube(0.1)), WallMotion({{Oscillation{{1, 0, 0}, 0.3, 0}, 0, infinity}}));
  s.model.domain = Box(Vec3::Constant(-100), Vec3::Constant(100));
  s.model.walls.back().surface = std::make_shared<const Surface>([] {
    TriangleMesh mesh = cube(0.1);
    for (Vec3& v : mesh.vertices) v.x() += 50;
    return Surface(mesh);
  }());
  Simulation sim = s.start(1);
  const double before = sim.ledger().mechanical();
  sim.advance(1000000);
  EXPECT_EQ(sim.time(), 1e6);
  EXPECT_EQ(sim.steps(), 1000000u);
  EXPECT_TRUE(finite(sim));
  EXPECT_NEAR(sim.ledger().mechanical(), before, 0.02 * before);
  EXPECT_NEAR(look(sim).walls[2].translation.x(), std::sin(2 * pi * std::remainder(0.3 * 1e6, 1.0)), 1e-8);
}

PropertyValues atTheLimits(const LawFunctions& law, double e, double friction, double resistance) {
  PropertyValues values;
  values[Property::normalStiffness] = 2e4;
  values[Property::tangentialStiffness] = 1e4;
  values[Property::restitution] = e;
  values[Property::friction] = friction;
  if (law.names[1] == "viscous") values[Property::tangentialDampingRate] = 3000;
  values[Property::rollingFriction] = resistance;
  values[Property::rollingViscosity] = resistance;
  values[Property::twistingFriction] = resistance;
  return values;
}

// Every law with restitution, friction and resistance at the ends of what they may be: an oblique collision of spinning unequal grains, one
// of them also with a wall. No energy comes from anywhere, but for the laws that are there to show that they make some.
TEST(Extremes, EveryLawAtEveryLimit) {
  int seen = 0;
  for (std::size_t index = 0; index < lawCount(); ++index) {
    const LawFunctions& law = lawFunctions(index);
    if (!law.objection.empty()) continue;
    for (const double e : {1e-6, 1.0}) {
      for (const double friction : {0.0, 1e6}) {
        for (const double resistance : {0.0, 1e6}) {
          SCOPED_TRACE(fmt::format("{} {} {} {}, e {}, friction {}, resistance {}", law.names[0], law.names[1], law.names[2], law.names[3],
                                   e, friction, resistance));
          Scenario s;
          s.model.contact = {std::string(law.names[0]), std::string(law.names[1]), std::string(law.names[2]), false,
                             std::string(law.names[3])};
          s.model.domain = Box(Vec3::Constant(-1), Vec3::Constant(1));
          s.pair = atTheLimits(law, e, friction, resistance);
          s.grain(1e-5, 1e-3, {0, 0, 1.01e-3}, {0.1, 0.05, -0.1}, {200, -300, 100});
          s.grain(4e-5, 1.7e-3, {2e-3, 1e-3, 3e-3}, {-0.2, 0, -0.2}, {-100, 50, 300});
          s.plane({0, 0, 0}, {0, 0, 1});
          for (Material& m : s.model.materials) m.values[Property::youngModulus] = 4e7, m.values[Property::poissonRatio] = 0.3;
          const double dt = 0.15 * chooseTimeStep(complete(s)).limit;
          Simulation sim = s.start(dt);
          const double before = sim.ledger().mechanical();
          const auto rounds = static_cast<int>(std::min(4e4, 0.008 / dt)) / 100;
          double most = 0;
          for (int n = 0; n < rounds; ++n) {
            sim.advance(100);
            most = std::max(most, sim.ledger().mechanical());
          }
          EXPECT_TRUE(finite(sim));
          EXPECT_LT(most, (law.traits.passive ? 1.003 : 1.3) * before);
          EXPECT_EQ(sim.counts().lost, 0u);
          ++seen;
        }
      }
    }
  }
  EXPECT_GT(seen, 100);
}

}  // namespace
}  // namespace tsubu::sim::test
