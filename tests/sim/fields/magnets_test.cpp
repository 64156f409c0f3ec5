// Magnetic grains: the law of two dipoles, what is kept, periods of swings, fields and their gradients, moving magnets.

#include "sim/fields/magnet_pass.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "verification/models.h"

namespace tsubu::sim::test {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();
constexpr double density = 3100;

V3 v3(const Vec3& a) { return {a.x(), a.y(), a.z()}; }
Vec3 vec3(V3 a) { return {a.x, a.y, a.z}; }
double volumeOf(double r) { return 4.0 / 3.0 * pi * r * r * r; }

/// Grains of two materials without friction: lasting magnets, and grains that are magnetised.
struct Magnetic {
  Model model;

  explicit Magnetic(Integrator integrator = Integrator::velocityVerlet) {
    model.integrator = integrator;
    model.contact = {"linear", "none", "none", false};
    model.watch.overlapLimit = 1, model.watch.travelLimit = 1;
    model.domain = Box(Vec3::Constant(-10), Vec3::Constant(10));
    Material lasting{"lasting", {}}, soft{"soft", {}};
    lasting.values[Property::density] = soft.values[Property::density] = density;
    lasting.values[Property::magnetisation] = 4e5;
    soft.values[Property::susceptibility] = 5;
    model.materials = {lasting, soft};
    PropertyValues pair;
    pair[Property::normalStiffness] = 1000;
    pair[Property::restitution] = 1;
    model.pairs = PairTable(2);
    model.pairs.set(0, 0, pair), model.pairs.set(0, 1, pair), model.pairs.set(1, 1, pair);
    model.magnets = Magnets{1, {}};
    model.orientation = false;  // nobody looks; lasting magnets keep theirs
  }
  void add(std::uint16_t material, double radius, const Vec3& x, const Quat& q = Quat::Identity(), const Vec3& v = Vec3::Zero(),
           const Vec3& spin = Vec3::Zero()) {
    Grain g;
    g.material = material, g.radius = radius, g.position = x, g.orientation = q, g.velocity = v, g.angularVelocity = spin;
    model.grains.push_back(g);
  }
  Simulation start(double dt, int threads = 1) const {
    Model copy = model;
    copy.timeStep = dt;
    return Simulation(std::move(copy), threads);
  }
};

Vec3 randomVec(Random& random, double size) {
  const double x = random.uniform(-size, size), y = random.uniform(-size, size), z = random.uniform(-size, size);
  return {x, y, z};
}

// U = κ/R³ (m_i·m_j − 3 (m_i·n)(m_j·n)), the force its gradient, the field the torque's, in any relative orientation, cut off or not.
TEST(Dipoles, ForceAndFieldAreTheDerivativesOfTheEnergy) {
  Random random(3, 3);
  for (int n = 0; n < 50; ++n) {
    const CutOff cut(n % 2 ? 10 : 2.2);
    const Vec3 mi = randomVec(random, 3), mj = randomVec(random, 2), d = randomVec(random, 1).normalized() * random.uniform(1.7, 2.15);
    const double share = n % 2 ? 1 : dipolePair(v3(d), v3(mi), v3(mj), cut).energy / dipolePair(v3(d), v3(mi), v3(mj), CutOff(10)).energy;
    const auto energy = [&](const Vec3& at, const Vec3& m) { return dipolePair(v3(at), v3(m), v3(mj), cut).energy; };
    const Vec3 unit = d.normalized();
    EXPECT_NEAR(energy(d, mi), share * 1e-7 / std::pow(d.norm(), 3) * (mi.dot(mj) - 3 * mi.dot(unit) * mj.dot(unit)), 1e-20);
    const DipolePair pair = dipolePair(v3(d), v3(mi), v3(mj), cut);
    for (int k = 0; k < 3; ++k) {
      const Vec3 e = Vec3::Unit(k);
      EXPECT_NEAR(vec3(pair.force)[k], -(energy(d + 1e-5 * e, mi) - energy(d - 1e-5 * e, mi)) / 2e-5, 1e-13);
      EXPECT_NEAR(vec3(pair.field)[k], -(energy(d, mi + e) - energy(d, mi - e)) / 2, 1e-20);
    }
    // Angular momentum: the torques and the couple of the forces add up to nothing.
    const DipolePair other = dipolePair(v3(-d), v3(mj), v3(mi), cut);
    EXPECT_LT((vec3(pair.force) + vec3(other.force)).norm(), 1e-20);
    EXPECT_LT((mi.cross(vec3(pair.field)) + mj.cross(vec3(other.field)) + d.cross(vec3(pair.force))).norm(), 1e-20);
  }
}

// Head to tail two moments attract with 6κm²/R⁴, side by side and parallel they repel with half of it.
TEST(Dipoles, PullHeadToTailAndPushSideBySide) {
  const V3 m{0, 0, 2};
  EXPECT_NEAR(dipolePair({0, 0, 3}, m, m, CutOff(10)).force.z, -6e-7 * 4 / 81, 1e-20);
  EXPECT_NEAR(dipolePair({3, 0, 0}, m, m, CutOff(10)).force.x, 3e-7 * 4 / 81, 1e-20);
}

// The cut is smooth: at its beginning nothing happens, at its end nothing is left.
TEST(Dipoles, EndSmoothly) {
  const CutOff cut(2);
  const V3 m{1, 2, 3};
  EXPECT_EQ(dipolePair({1.6, 0, 0}, m, m, cut).energy, dipolePair({1.6, 0, 0}, m, m, CutOff(10)).energy);
  EXPECT_LT(norm(dipolePair({1.9999, 0, 0}, m, m, cut).force), 1e-6 * norm(dipolePair({1.5, 0, 0}, m, m, cut).force));
  EXPECT_EQ(norm(dipolePair({2.0001, 0, 0}, m, m, cut).force), 0);
}

// Every source is a field without charges and currents: its gradient is what differences say, symmetric, and without trace.
TEST(FieldSources, GradientsAreThoseOfTheFields) {
  const Vec3 point{0.1, -0.2, 0.3}, x{0.5, 0.4, -0.6}, axis{1, 2, -2};
  const std::vector<FieldSource> sources{{UniformSource{{0.1, 0.2, 0.3}}, {}},
                                         {GradientSource{point, axis, 1.7}, {}},
                                         {DipoleSource{point, {100, -300, 200}}, {}},
                                         {RollerSource{point, axis, {0, 1, 0}, 3, 0.4, 0.08}, {}}};
  for (const FieldSource& source : sources) {
    FieldAt at;
    addField(source, x, at);
    EXPECT_GT(at.field.norm(), 0);
    EXPECT_LT((at.gradient - at.gradient.transpose()).norm(), 1e-15 * at.gradient.norm() + 1e-18);
    EXPECT_NEAR(at.gradient.trace(), 0, 1e-14 * at.gradient.norm() + 1e-18);
    for (int k = 0; k < 3; ++k) {
      FieldAt ahead, behind;
      addField(source, x + 1e-5 * Vec3::Unit(k), ahead);
      addField(source, x - 1e-5 * Vec3::Unit(k), behind);
      EXPECT_LT(((ahead.field - behind.field) / 2e-5 - at.gradient.row(k).transpose()).norm(), 1e-7 * at.gradient.norm() + 1e-15);
    }
  }
}

// B_r = B (R/ρ)^(n+1) cos nφ, B_φ = B (R/ρ)^(n+1) sin nφ: north and south poles alternate along the circumference.
TEST(FieldSources, RollerHasItsPoles) {
  const RollerSource roller{{0.1, 0, 0.2}, {0, 3, 0}, {1, 7, 0}, 3, 0.04, 0.08};
  for (const double phi : {0.0, 0.3, pi / 3, 2.0}) {
    const Vec3 radial = std::cos(phi) * Vec3::UnitX() + std::sin(phi) * Vec3(0, 0, -1), around = Vec3::UnitY().cross(radial);
    for (const double rho : {0.04, 0.07}) {
      FieldAt at;
      addField({roller, {}}, roller.point + rho * radial + Vec3(0, 5, 0), at);
      const double strength = 0.08 * std::pow(0.04 / rho, 4);
      EXPECT_NEAR(at.field.dot(radial), strength * std::cos(3 * phi), 1e-15);
      EXPECT_NEAR(at.field.dot(around), strength * std::sin(3 * phi), 1e-15);
      EXPECT_NEAR(at.field.y(), 0, 1e-17);
    }
  }
}

// What a passing magnet does to the field at a place: the difference of two moments.
TEST(FieldSources, ChangeIsThatOfAMovingMagnet) {
  const FieldSource source{DipoleSource{{0.2, 0, 0}, {100, -300, 200}}, 0};
  const WallMotion motion({{Rotation{{0, 0.1, 0}, {1, 1, 0}, 3}, 0, never}, {Translation{{0.3, -0.2, 0.5}}, 0, never}});
  const Vec3 x{0.5, 0.4, -0.6};
  const auto at = [&](double t) {
    FieldAt sum;
    addMovedField(source, motion.at(t), motion.twistAt(t), x, sum);
    return sum;
  };
  EXPECT_LT(((at(0.4 + 1e-5).field - at(0.4 - 1e-5).field) / 2e-5 - at(0.4).change).norm(), 1e-7 * at(0.4).change.norm());
}

/// The time between passages of zero upwards of a grain's spin about x.
double periodOf(Simulation& sim, double dt, int steps) {
  double first = 0, last = 0, before = look(sim).angularVelocity[0].x();
  int passages = 0;
  for (int n = 0; n < steps; ++n) {
    sim.advance(1);
    const double now = look(sim).angularVelocity[0].x();
    if (before < 0 && now >= 0) {
      last = sim.time() - dt * now / (now - before);
      if (passages++ == 0) first = last;
    }
    before = now;
  }
  return (last - first) / (passages - 1);
}

Quat tilted(double angle) { return Quat(Eigen::AngleAxisd(angle, Vec3::UnitX())); }

// A compass needle: ω² = p B/I for small swings, from small ones to (1 + θ²/16) of the period.
TEST(Magnets, NeedleSwingsInAField) {
  const double r = 2e-3, theta = 0.05, inertia = 0.4 * density * volumeOf(r) * r * r;
  Magnetic s;
  s.add(0, r, Vec3::Zero(), tilted(theta));
  s.model.magnets->sources = {{UniformSource{{0, 0, 0.03}}, {}}};
  const double period = 2 * pi * std::sqrt(inertia / (4e5 * volumeOf(r) * 0.03)) * (1 + theta * theta / 16);
  const double dt = period / 400;
  Simulation sim = s.start(dt);
  EXPECT_NEAR(periodOf(sim, dt, 2200) / period, 1, 3e-5);
  EXPECT_LT(look(sim).position[0].norm(), 1e-15);  // a uniform field does not pull
}

// Two magnets head to tail, tilted by θ and −θ: U = −κm²/d³ (2 cos²θ + sin²θ) gives I θ″ = −κm²/d³ θ. The contact keeps them apart.
TEST(Magnets, TwoNeedlesSwingAgainstEachOther) {
  const double r = 2e-3, m = 4e5 * volumeOf(r), inertia = 0.4 * density * volumeOf(r) * r * r, theta = 0.02;
  Magnetic s;
  PropertyValues stiff;
  stiff[Property::normalStiffness] = 1e5;
  stiff[Property::restitution] = 1;
  s.model.pairs.set(0, 0, stiff);
  const double overlap = 6e-7 * m * m / std::pow(2 * r, 4) / 1e5, d = 2 * r - overlap;
  s.add(0, r, {0, 0, 0}, tilted(theta));
  s.add(0, r, {0, 0, d}, tilted(-theta));
  const double period = 2 * pi * std::sqrt(inertia * d * d * d / (1e-7 * m * m)), dt = period / 3000;
  Simulation sim = s.start(dt);
  EXPECT_NEAR(periodOf(sim, dt, 10000) / period, 1, 5e-4);
}

// In a gradient: a lasting magnet along the axis feels p g; a grain that is magnetised runs away as cosh(√(αg²/m) t).
TEST(Magnets, ArePulledAlongAGradient) {
  const double r = 1.5e-3, g = 0.8, mass = density * volumeOf(r);
  Magnetic s;
  s.add(0, r, {0, 0, 0.02});
  s.model.magnets->sources = {{GradientSource{Vec3::Zero(), {0, 0, 2}, g}, {}}};
  Simulation lasting = s.start(1e-5);
  lasting.advance(3000);
  EXPECT_NEAR(look(lasting).position[0].z(), 0.02 + 0.5 * 4e5 * volumeOf(r) * g / mass * 9e-4, 1e-9);

  s.model.grains.clear();
  s.add(1, r, {0, 0, 0.02});
  const double polarisability = volumeOf(r) / (4e-7 * pi) * 15.0 / 8, rate = std::sqrt(polarisability * g * g / mass);
  s.model.timeStep = 1e-4;
  Simulation soft = s.start(1e-4);
  soft.advance(2000);
  EXPECT_NEAR(look(soft).position[0].z(), 0.02 * std::cosh(0.2 * rate), 1e-6);
  EXPECT_LT(std::abs(soft.ledger().residual()), 1e-4 * soft.ledger().kinetic());
}

/// Lasting and soft magnets of unequal size in a cloud that collapses.
Magnetic cloud(Integrator integrator) {
  Magnetic s(integrator);
  s.model.magnets->cutOff = 0.011;
  s.model.materials[0].values[Property::magnetisation] = 1.5e5;
  Random random(7, 5);
  for (int n = 0; n < 27; ++n) {
    Random turn(11, static_cast<std::uint64_t>(n));
    const Vec3 x = 4e-3 * Vec3(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
    s.add(n % 3 ? 0 : 1, random.uniform(0.9e-3, 1.6e-3), x, randomRotation(turn), -3 * x + randomVec(random, 0.05), randomVec(random, 30));
  }
  return s;
}

TEST(Magnets, MomentaStayToRounding) {
  for (const Integrator integrator : {Integrator::symplecticEuler, Integrator::velocityVerlet}) {
    Simulation sim = cloud(integrator).start(4e-6);
    const Ledger before = sim.ledger();
    sim.advance(4000);
    const Ledger after = sim.ledger();
    EXPECT_GT(std::abs(after.potentialFields - before.potentialFields), 0.2 * before.kinetic());
    const double momentum = std::sqrt(2 * before.kinetic() * 1e-3), angular = momentum * 0.01;
    EXPECT_LT((after.momentum - before.momentum).norm(), 1e-12 * momentum);
    EXPECT_LT((after.angularMomentumRest - before.angularMomentumRest).norm(), 1e-11 * angular);
  }
}

/// The same with a roller that turns and walls, an inlet of magnets and a sink.
Magnetic brush(Integrator integrator) {
  Magnetic s = cloud(integrator);
  s.model.gravity = {0, 0, -3};
  Wall core;
  core.name = "core";
  core.surface = std::make_shared<const Surface>(Surface::plane("core", {0, 0, -8e-3}, {0, 0, 1}));
  core.motion = WallMotion({{Rotation{{0, 0, -0.05}, {0, 0, 1}, 40}, 0, never}});
  s.model.walls.push_back(core);
  s.model.magnets->sources = {{RollerSource{{0, 0.03, -0.03}, {1, 0, 0}, {0, 0, 1}, 2, 0.02, 0.05}, 0},
                              {DipoleSource{{0.02, 0, -0.03}, {0, 0.5, 0.3}}, 0},
                              {UniformSource{{0.004, 0, 0.003}}, {}}};
  return s;
}

double residual(Integrator integrator, double dt) {
  Simulation sim = brush(integrator).start(dt);
  for (int n = 0; n < 20; ++n) {
    sim.advance(static_cast<std::uint64_t>(std::lround(1e-3 / dt)));
    sim.ledger();
  }
  const Ledger end = sim.ledger();
  EXPECT_GT(std::abs(end.workFields), 0.01 * end.turnover);
  return end.residualFraction();
}

TEST(Magnets, LedgerClosesAtTheOrderOfTheScheme) {
  for (const Integrator integrator : {Integrator::symplecticEuler, Integrator::velocityVerlet}) {
    const double coarse = residual(integrator, 1e-5), fine = residual(integrator, 2.5e-6), order = std::log(coarse / fine) / std::log(4.0);
    const bool verlet = integrator == Integrator::velocityVerlet;
    fmt::print("  ledger residual of magnets above turning ones, {}: {:.2e} at 10 µs, {:.2e} at 2.5 µs, order {:.2f}\n",
               verlet ? "velocity Verlet" : "symplectic Euler", coarse, fine, order);
    EXPECT_LT(fine, verlet ? 2e-3 : 2e-2);
    EXPECT_GT(order, verlet ? 1.5 : 0.7);
  }
}

// Magnets that come in and go take their energy along: potentials of a third of the turnover come in and go out here.
TEST(Magnets, LedgerClosesWithInletsAndSinks) {
  Magnetic s = brush(Integrator::velocityVerlet);
  Stream stream;
  stream.name = "inlet";
  stream.region.shape = BoxRegion{{-0.01, -0.01, 0.012}, {0.01, 0.01, 0.016}};
  stream.grainsPerSecond = 800;
  stream.radii.kind = UniformRadius{0.9e-3, 1.3e-3};
  stream.velocity = {0, 0, -0.5};
  s.model.streams.push_back(stream);
  s.model.sinks.push_back({"out", {BoxRegion{{0.002, -1, -1}, {1, 1, 1e-3}}}});
  Simulation sim = s.start(4e-6);
  for (int n = 0; n < 20; ++n) {
    sim.advance(500);
    sim.ledger();
  }
  EXPECT_GT(sim.counts().removed, 3u);
  EXPECT_GT(sim.counts().inserted, 10u);
  EXPECT_LT(sim.ledger().residualFraction(), 2e-3);
}

// Across a periodic boundary magnets meet as they do inside; one that would meet itself is refused.
TEST(Magnets, PullAcrossAPeriodicBoundary) {
  const auto after = [](double shift, double cutOff) {
    Magnetic s;
    s.model.domain = Box(Vec3::Zero(), Vec3::Constant(0.04));
    s.model.periodic = {true, true, false};
    s.model.magnets->cutOff = cutOff;
    for (int g = 0; g < 3; ++g) s.add(0, 1.5e-3, Vec3(0.012 + shift + 4e-3 * g, 0.02 + 1e-3 * g, 0.02), tilted(0.3 * g));
    Simulation sim = s.start(1e-5);
    sim.advance(200);
    return look(sim).velocity;
  };
  const std::vector<Vec3> inside = after(0, 0.015), across = after(0.0225, 0.015);
  EXPECT_GT(inside[0].norm(), 1e-3);
  for (std::size_t g = 0; g < 3; ++g) EXPECT_LT((inside[g] - across[g]).norm(), 1e-9 * inside[g].norm());
  EXPECT_THROW(after(0, 0.021), Error);
}

// A domain that is just long enough at rest stays so when grains are fast: lists reach less far instead.
TEST(Magnets, FastGrainsDoNotMakeAPeriodTooShort) {
  Magnetic s;
  s.model.domain = Box(Vec3::Zero(), Vec3(0.0255, 0.04, 0.04));
  s.model.periodic = {true, false, false};
  s.model.magnets->cutOff = 0.012;
  for (int g = 0; g < 2; ++g) s.add(0, 1.5e-3, Vec3(0.005 + 0.01 * g, 0.02, 0.02 - 0.01 * g), tilted(0.3 * g), Vec3(1, 0, 0.5));
  Simulation sim = s.start(1e-5);
  EXPECT_NO_THROW(sim.advance(500));
}

TEST(Magnets, AnyNumberOfThreadsTheSameBits) {
  std::uint64_t hash = 0;
  for (const int threads : {1, 2, 3}) {
    Simulation sim = brush(Integrator::velocityVerlet).start(1e-5, threads);
    sim.advance(700);
    if (threads == 1) hash = sim.stateHash();
    EXPECT_EQ(sim.stateHash(), hash) << threads;
  }
}

}  // namespace
}  // namespace tsubu::sim::test
