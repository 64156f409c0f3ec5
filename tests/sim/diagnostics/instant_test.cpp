// What a simulation hands to its observers: forces that are the very ones that move the grains.

#include "sim/diagnostics/instant.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/error.h"
#include "sim/diagnostics/survey.h"
#include "verification/models.h"

namespace tsubu::sim::test {
namespace {

/// Unequal grains that are thrown together into a corner of planes, one of which turns in itself while another shakes.
Scenario crowd(Integrator integrator, const ContactChoice& laws) {
  Scenario s;
  s.model.integrator = integrator;
  s.model.contact = laws;
  s.model.contactForces = true;
  s.model.gravity = {-60, -80, -300};
  s.pair[Property::normalStiffness] = 2e4;
  s.pair[Property::restitution] = 0.6;
  s.pair[Property::friction] = 0.45;
  s.pair[Property::rollingFriction] = 0.1;
  s.pair[Property::rollingViscosity] = 0.01;
  s.pair[Property::twistingFriction] = 0.05;
  if (laws.tangential == "viscous") s.pair[Property::tangentialDampingRate] = 900;
  Random random(11, 1);
  const auto some = [&](double size) {
    return Vec3(random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size));
  };
  for (int i = 0; i < 27; ++i) {
    const double r = random.uniform(0.8e-3, 2.4e-3);
    const Vec3 x = 5e-3 * Vec3(i % 3 + 0.5, i / 3 % 3 + 0.5, i / 9 + 0.55);
    s.grain(2500 * 4.0 / 3.0 * pi * r * r * r, r, x, Vec3(-0.3, -0.2, -0.8) + some(0.4), some(300));
  }
  s.plane({0, 0, 0}, {0, 0, 1}, WallMotion({MotionPart{Rotation{{4e-3, 5e-3, 0}, {0, 0, 1}, 30}}}));
  s.plane({0, 0, 0}, {1, 0, 0}, WallMotion({MotionPart{Oscillation{{3e-4, 0, 0}, 200, 0.3}}}));
  s.plane({0, 0, 0}, {0.1, 1, 0.05});
  for (Material& material : s.model.materials) material.values[Property::youngModulus] = 2e8, material.values[Property::poissonRatio] = 0.3;
  return s;
}

struct Load {
  Vec3 force, torque;
};

std::vector<Load> loads(const Instant& instant) {
  std::vector<Load> result(instant.grains.size(), {Vec3::Zero(), Vec3::Zero()});
  for (const ActingContact& contact : instant.contacts) {
    const Vec3 point = instant.contactPoint(contact);
    const auto add = [&](std::int32_t grain, double sign) {
      Load& load = result[static_cast<std::size_t>(grain)];
      load.force += sign * contact.force;
      load.torque += sign * ((point - instant.grains[static_cast<std::size_t>(grain)].position).cross(contact.force) + contact.moment);
    };
    add(contact.first, 1);
    if (!contact.withWall()) add(contact.second, -1);
  }
  return result;
}

const ContactChoice lawsToSee[] = {{"linear", "spring", "none", false},
                                   {"linear", "spring", "elastic_plastic", true, "spring"},
                                   {"hertz", "mindlin", "constant", false},
                                   {"linear", "viscous", "none", false}};

// m (v′ − v) = ½ (F + F′) Δt in velocity Verlet and F Δt in symplectic Euler, and the same for spin: for every grain in every step.
TEST(Instant, ForcesAreTheOnesThatMoveTheGrains) {
  for (const Integrator integrator : {Integrator::velocityVerlet, Integrator::symplecticEuler}) {
    for (const ContactChoice& laws : lawsToSee) {
      const double dt = 2e-6, lead = integrator == Integrator::velocityVerlet ? 0.5 : 1.0;
      Scenario scenario = crowd(integrator, laws);
      Simulation sim = scenario.start(dt);
      sim.advance(3000);
      Instant before = sim.instant();
      double worstForce = 0, worstTorque = 0, force = 0, torque = 0;
      std::size_t walls = 0, pairs = 0;
      for (int step = 0; step < 40; ++step) {
        sim.advance(1);
        const Instant after = sim.instant();
        const std::vector<Load> first = loads(before), second = loads(after);
        for (const ActingContact& contact : after.contacts) ++(contact.withWall() ? walls : pairs);
        for (std::size_t g = 0; g < after.grains.size(); ++g) {
          const SeenGrain &a = before.grains[g], &b = after.grains[g];
          const Vec3 meanForce = lead * first[g].force + (1 - lead) * second[g].force + a.mass * scenario.model.gravity;
          const Vec3 meanTorque = lead * first[g].torque + (1 - lead) * second[g].torque;
          worstForce = std::max(worstForce, (a.mass * (b.velocity - a.velocity) / dt - meanForce).norm());
          worstTorque = std::max(worstTorque, (a.inertia() * (b.angularVelocity - a.angularVelocity) / dt - meanTorque).norm());
          force = std::max(force, meanForce.norm());
          torque = std::max(torque, meanTorque.norm());
        }
        before = after;
      }
      EXPECT_GT(pairs, 30U);
      EXPECT_GT(walls, 30U);
      EXPECT_LT(worstForce, 1e-9 * force) << laws.normal << ", " << laws.tangential << ", " << laws.rolling;
      EXPECT_LT(worstTorque, 1e-9 * torque) << laws.normal << ", " << laws.tangential << ", " << laws.rolling;
    }
  }
}

// A pair at its first instant, oblique, spinning, of unequal partners: N1, T0–T2, T4, T5 by hand.
TEST(Instant, FirstForceOfAnObliquePair) {
  for (const double friction : {0.02, 5.0}) {
    const double dt = 1e-6, k = 5e3, kt = 1.7e3;
    Scenario s;
    s.model.contact = {"linear", "spring", "none", false};
    s.model.contactForces = true;
    s.pair[Property::normalStiffness] = k;
    s.pair[Property::tangentialStiffness] = kt;
    s.pair[Property::normalDampingRate] = 800;
    s.pair[Property::tangentialDampingRate] = 300;
    s.pair[Property::friction] = friction;
    const double ra = 2e-3, rb = 5e-3, ma = 1e-4, mb = 7e-4;
    const Vec3 n = Vec3(1, -2, 0.7).normalized(), va(-0.4, 0.3, 0.1), vb(0.05, -0.2, 0.3), wa(20, -40, 15), wb(-10, 5, 30);
    const double overlap = 3e-5, distance = ra + rb - overlap;
    s.grain(ma, ra, distance * n, va, wa);
    s.grain(mb, rb, Vec3::Zero(), vb, wb);
    Simulation sim = s.start(dt);
    const Instant instant = sim.instant();
    ASSERT_EQ(instant.contacts.size(), 1U);
    const ActingContact& contact = instant.contacts[0];
    ASSERT_TRUE(contact.first == 0 || contact.first == 1);
    const double sign = contact.first == 0 ? 1 : -1;

    const double meff = 1 / (1 / ma + 1 / mb);
    const double vn = (va - vb).dot(n), la = ra * distance / (ra + rb), lb = rb * distance / (ra + rb);
    const Vec3 slip = va - vb - vn * n - (la * wa + lb * wb).cross(n);
    const double normal = k * overlap - 800 * meff * vn;
    ASSERT_GT(normal, 0);
    Vec3 tangential = -(0.5 * kt * dt + 300 * meff) * slip;
    const bool slides = tangential.norm() > friction * normal;
    EXPECT_EQ(slides, friction < 1);
    if (slides) tangential *= friction * normal / tangential.norm();
    const Vec3 expected = normal * n + tangential;
    EXPECT_LT((sign * contact.force - expected).norm(), 1e-12 * expected.norm());
    EXPECT_LT((sign * contact.branch - distance * n).norm(), 1e-17);
    EXPECT_NEAR(contact.normalForce(), normal, 1e-12 * normal);
    EXPECT_LT((instant.contactPoint(contact) - lb * n).norm(), 1e-17);
  }
}

// Grains that rest on one another: each contact carries what is above it, and the stress is that of a column of this weight.
TEST(Instant, ColumnUnderGravity) {
  Scenario s;
  s.model.contactForces = true;
  s.model.gravity = {0, 0, -9.81};
  const double k = 1e4, r = 4e-3, m = 2e-3, weight = m * 9.81;
  s.pair[Property::normalStiffness] = k;
  s.pair[Property::restitution] = 0.5;
  s.plane({0, 0, 0}, {0, 0, 1});
  constexpr int count = 8;
  double z = 0, forceTimesBranch = 0;
  std::vector<double> expected;
  for (int g = 0; g < count; ++g) {
    const double carried = (count - g) * weight, branch = (g == 0 ? r : 2 * r) - carried / k;
    z += branch;
    s.grain(m, r, {0, 0, z});
    expected.push_back(carried);
    forceTimesBranch += carried * branch;
  }
  Simulation sim = s.start(1e-5);
  sim.advance(100);
  const Instant instant = sim.instant();
  ASSERT_EQ(instant.contacts.size(), expected.size());
  for (const ActingContact& contact : instant.contacts) {
    const int upper = contact.withWall() ? 0 : std::max(contact.first, contact.second);
    EXPECT_NEAR(contact.normalForce(), expected[static_cast<std::size_t>(upper)], 1e-9 * weight);
  }
  const Box region(Vec3(-r, -r, 0), Vec3(r, r, z + r));
  const StressSurvey stress = survey(instant, region).stress;
  EXPECT_NEAR(stress.contact(2, 2), forceTimesBranch / region.volume(), 1e-9 * stress.contact(2, 2));
  EXPECT_NEAR(stress.contact(0, 0), 0, 1e-12 * stress.contact(2, 2));
  const WallSurvey floor = surveyWalls(instant, 1)[0];
  EXPECT_NEAR(floor.force.z(), -count * weight, 1e-9 * weight);
  // Cells as thin as one likes: each between the floor and the top centre has the force that passes through it.
  const Grid grid{Box(Vec3(-r, -r, 0), Vec3(r, r, z)), {1, 1, 100}};
  const std::vector<CellSurvey> cells = survey(instant, grid);
  EXPECT_NEAR(cells.front().stress.contact(2, 2) * 4 * r * r, count * weight, 1e-9 * weight);
  EXPECT_NEAR(cells.back().stress.contact(2, 2) * 4 * r * r, weight, 1e-9 * weight);
}

// The same crowd in a domain that repeats itself along y, twice: moved on by half a period it looks the same, and has the same stress.
TEST(Instant, PeriodicDomainsHaveNoBoundary) {
  std::vector<Survey> seen;
  std::vector<double> cells;
  for (const double shift : {0.0, 7.7e-3}) {
    Scenario s = crowd(Integrator::velocityVerlet, lawsToSee[1]);
    s.model.walls.pop_back();
    s.model.walls.front().motion = WallMotion();
    s.model.gravity = {-200, 0, -300};
    s.model.periodic = {false, true, false};
    s.model.domain = Box(Vec3(-1, 0, -1), Vec3(1, 15.4e-3, 1));
    for (Grain& grain : s.model.grains) grain.position.y() = std::fmod(grain.position.y() + shift, 15.4e-3);
    Simulation sim = s.start(2e-6);
    sim.advance(3000);
    const Instant instant = sim.instant();
    const Box around = boxAround(instant);
    EXPECT_DOUBLE_EQ(around.min().y(), 0);
    EXPECT_DOUBLE_EQ(around.max().y(), 15.4e-3);
    seen.push_back(survey(instant, around));
    Mat3 sum = Mat3::Zero();
    double solid = 0, volume = 0;
    for (const CellSurvey& cell : survey(instant, Grid{around, {3, 5, 4}})) {
      sum += cell.stress.contact / 60;
      solid += cell.solidFraction / 60;
    }
    for (const SeenGrain& grain : instant.grains) volume += 4.0 / 3.0 * pi * std::pow(grain.radius, 3);
    EXPECT_LT((sum - seen.back().stress.contact).norm(), 1e-12 * sum.norm());
    EXPECT_NEAR(solid, volume / around.volume(), 1e-12);
    EXPECT_NEAR(seen.back().solidFraction, solid, 1e-12);
    // Without the share of images what reaches across the boundary would be lost.
    Mat3 whole = Mat3::Zero();
    for (const ActingContact& contact : instant.contacts) whole += contact.force * contact.branch.transpose() / around.volume();
    EXPECT_LT((whole - seen.back().stress.contact).norm(), 1e-12 * whole.norm());
  }
  EXPECT_GT(seen[0].contacts.betweenGrains, 2U);
  EXPECT_NEAR(seen[0].stress.pressure(), seen[1].stress.pressure(), 1e-6 * seen[0].stress.pressure());
  EXPECT_EQ(seen[0].contacts.betweenGrains, seen[1].contacts.betweenGrains);
}

TEST(Instant, LookingChangesNothing) {
  for (const ContactChoice& laws : lawsToSee) {
    Scenario looked = crowd(Integrator::velocityVerlet, laws), alone = looked;
    alone.model.contactForces = false;
    Simulation a = looked.start(2e-6, 2), b = alone.start(2e-6, 1);
    for (int k = 0; k < 60; ++k) {
      a.advance(50);
      (void)a.instant();
    }
    b.advance(3000);
    EXPECT_EQ(a.stateHash(), b.stateHash());
    EXPECT_EQ(a.ledger().dissipated(), b.ledger().dissipated());
  }
}

TEST(Instant, OrderDoesNotDependOnTheThreads) {
  Simulation one = crowd(Integrator::velocityVerlet, lawsToSee[0]).start(2e-6, 1),
             three = crowd(Integrator::velocityVerlet, lawsToSee[0]).start(2e-6, 3);
  one.advance(2500), three.advance(2500);
  const Instant a = one.instant(), b = three.instant();
  ASSERT_EQ(a.contacts.size(), b.contacts.size());
  for (std::size_t c = 0; c < a.contacts.size(); ++c) {
    EXPECT_EQ(a.contacts[c].first, b.contacts[c].first);
    EXPECT_EQ(a.contacts[c].force, b.contacts[c].force);
  }
}

TEST(Instant, IsRefusedByAModelThatDoesNotNoteForces) {
  Scenario s = crowd(Integrator::velocityVerlet, lawsToSee[0]);
  s.model.contactForces = false;
  Simulation sim = s.start(2e-6);
  EXPECT_THROW((void)sim.instant(), Error);
}

// Note A.13 and A.18: what the ledger splits, against sums over the grains.
TEST(Instant, MomentaAndEnergiesOfTheLedgerAreSumsOverGrains) {
  Simulation sim = crowd(Integrator::velocityVerlet, lawsToSee[1]).start(2e-6);
  sim.advance(2000);
  const Instant instant = sim.instant();
  const Ledger ledger = sim.ledger();
  double mass = 0, fluctuation = 0, rotation = 0;
  Vec3 centre = Vec3::Zero(), momentum = Vec3::Zero(), whole = Vec3::Zero(), rest = Vec3::Zero();
  for (const SeenGrain& g : instant.grains) {
    mass += g.mass;
    centre += g.mass * g.position;
    momentum += g.mass * g.velocity;
    whole += g.mass * g.position.cross(g.velocity) + g.inertia() * g.angularVelocity;
  }
  centre /= mass;
  for (const SeenGrain& g : instant.grains) {
    const Vec3 own = g.velocity - momentum / mass;
    fluctuation += 0.5 * g.mass * own.squaredNorm();
    rotation += 0.5 * g.inertia() * g.angularVelocity.squaredNorm();
    rest += g.mass * (g.position - centre).cross(own) + g.inertia() * g.angularVelocity;
  }
  const Vec3 bulk = centre.cross(momentum);
  EXPECT_LT((ledger.angularMomentumBulk - bulk).norm(), 1e-13 * bulk.norm());
  EXPECT_LT((ledger.angularMomentumRest - rest).norm(), 1e-12 * rest.norm());
  EXPECT_LT((ledger.angularMomentumBulk + ledger.angularMomentumRest - whole).norm(), 1e-12 * whole.norm());
  EXPECT_NEAR(ledger.kineticBulk, 0.5 * momentum.squaredNorm() / mass, 1e-12 * ledger.kineticBulk);
  EXPECT_NEAR(ledger.kineticFluctuation, fluctuation, 1e-12 * fluctuation);
  EXPECT_NEAR(ledger.kineticRotation, rotation, 1e-12 * rotation);
  // Temperature is the same fluctuation per mass.
  EXPECT_NEAR(survey(instant, boxAround(instant)).motion.temperature, 2 * fluctuation / (3 * mass), 1e-12);
}

// What pictures show of forces are these contacts, from centre to centre or to the wall, and only when asked for.
TEST(Instant, SnapshotsCarryItsContacts) {
  Scenario scenario = crowd(Integrator::velocityVerlet, lawsToSee[0]);
  scenario.model.showForces = true;
  Simulation sim = scenario.start(2e-6);
  sim.advance(3000);
  const Snapshot snapshot = look(sim);
  const Instant instant = sim.instant();
  ASSERT_GT(instant.contacts.size(), 10u);
  ASSERT_EQ(snapshot.forces.size(), instant.contacts.size());
  int walls = 0;
  for (std::size_t k = 0; k < instant.contacts.size(); ++k) {
    const ActingContact& contact = instant.contacts[k];
    const SeenForce& seen = snapshot.forces[k];
    const Vec3 first = instant.grains[static_cast<std::size_t>(contact.first)].position;
    const Vec3 second =
        contact.withWall() ? instant.contactPoint(contact) : instant.grains[static_cast<std::size_t>(contact.second)].position;
    walls += contact.withWall() ? 1 : 0;
    EXPECT_LT((seen.first - first).norm() + (seen.second - second).norm(), 1e-15);
    EXPECT_EQ(seen.force, contact.normalForce());
  }
  EXPECT_GT(walls, 3);
  scenario.model.showForces = false;
  Simulation unseen = scenario.start(2e-6);
  unseen.advance(3000);
  EXPECT_TRUE(look(unseen).forces.empty());
  EXPECT_EQ(unseen.stateHash(), sim.stateHash());
}

}  // namespace
}  // namespace tsubu::sim::test
