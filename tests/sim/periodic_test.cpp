// A domain that repeats itself: nearest images, lists against brute force, and runs against their unbounded copies.

#include <set>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "sim/neighbours/pair_lists.h"
#include "sim/periodic.h"
#include "verification/models.h"
#include "verification/shapes.h"

namespace tsubu::sim {
namespace {

using test::look;
using test::Scenario;

constexpr std::array everyWay{true, true, true};

Vec3 randomVec(Random& random, double size) {
  const double x = random.uniform(-size, size), y = random.uniform(-size, size), z = random.uniform(-size, size);
  return {x, y, z};
}

TEST(Periods, ShiftsAndNearestImages) {
  const Box box(Vec3(-0.3, 1.2, 5), Vec3(0.4, 3.7, 5.1));
  Random random(4, 1);
  for (int subset = 0; subset < 8; ++subset) {
    const std::array along{(subset & 1) != 0, (subset & 2) != 0, (subset & 4) != 0};
    const Periods periods(box, along);
    EXPECT_EQ(periods.any(), subset != 0);
    for (int number = -13; number <= 13; ++number) EXPECT_EQ(periods.shift(number), -periods.shift(-number));
    for (int n = 0; n < 200; ++n) {
      const Vec3 x = randomVec(random, 9), y = randomVec(random, 9), w = periods.wrapped(x), d = periods.nearest(x - y);
      for (int axis = 0; axis < 3; ++axis) {
        const auto k = static_cast<std::size_t>(axis);
        const double length = box.sizes()[axis];
        if (!along[k]) {
          EXPECT_EQ(w[axis], x[axis]);
          EXPECT_EQ(d[axis], (x - y)[axis]);
          continue;
        }
        EXPECT_TRUE(w[axis] >= box.min()[axis] && w[axis] < box.max()[axis]);
        EXPECT_NEAR(std::remainder(w[axis] - x[axis], length), 0, 1e-14);
        EXPECT_NEAR(d[axis], std::remainder((x - y)[axis], length), 1e-13);
      }
    }
  }
}

/// Positions in a box that is periodic along some axes, radii over a decade or two.
std::vector<GrainRow> randomRows(Random& random, const Box& box, int count, double ratio) {
  std::vector<GrainRow> rows;
  for (int n = 0; n < count; ++n) {
    const Vec3 x = box.center() + 0.5 * box.sizes().cwiseProduct(randomVec(random, 1));
    const double r = 1e-3 * std::pow(ratio, -random.uniform());
    rows.push_back({x.x(), x.y(), x.z(), r, 0, 0, 0, 1, 0, 0, 0, 1 / r});
  }
  return rows;
}

Vec3 placeOf(const GrainRow& row) { return {row.x, row.y, row.z}; }

TEST(PeriodicLists, HoldEveryNearPairOnceWithItsNearestImage) {
  Random random(5, 2);
  ThreadTeam team(2);
  for (int round = 0; round < 600; ++round) {
    const double thickest = 1e-3 * random.uniform(0.05, 0.4), least = 4 * (1e-3 + thickest);
    const Vec3 length(random.uniform(least, 3 * least), random.uniform(least, 6 * least), random.uniform(least, 2 * least));
    const Vec3 corner = round % 7 == 0 ? Vec3(1e3, -1e3, 50) : Vec3(randomVec(random, 1e-2));
    const Box box(corner, corner + length);
    const int subset = 1 + round % 7;
    const Periods periods(box, {(subset & 1) != 0, (subset & 2) != 0, (subset & 4) != 0});
    State state;
    state.rows = randomRows(random, box, 1 + round % 80, std::array{1.0, 3.0, 30.0}[static_cast<std::size_t>(round / 7 % 3)]);
    state.material.resize(state.rows.size());
    state.forces.resize(state.rows.size());
    for (std::size_t g = 0; g < state.rows.size(); ++g) state.skin.push_back(static_cast<float>(thickest * random.uniform(0.1, 1)));
    std::vector<std::int32_t> order, place(state.rows.size());
    const Slabs slabs = sortIntoSlabs(state.rows, 2 * (1e-3 + thickest), order, team);
    state.reorder(order);
    const std::size_t grains = state.size();
    CellGrid grid;
    grid.build(state.rows, 0, state.skin);
    PairLists lists(0, 0);
    lists.build(state, slabs, grid, 0.5, place, team, periods);
    ASSERT_EQ(state.size(), grains);

    std::set<std::pair<std::int32_t, std::int32_t>> listed;
    std::set<std::int32_t> rowsSeen;
    for (const SlabPairs& slab : lists.slabs()) {
      for (std::size_t k = 0; k < slab.images.size(); ++k) {
        const auto row = slab.firstImage + static_cast<std::int32_t>(k);
        ASSERT_TRUE(rowsSeen.insert(row).second) << "two slabs share an image";
        const Vec3 owner = placeOf(state.rows[static_cast<std::size_t>(slab.images[k].owner)]);
        ASSERT_EQ(placeOf(state.rows[static_cast<std::size_t>(row)]), Vec3(owner + slab.images[k].shift));
      }
      for (std::size_t k = 0; k < slab.outerI.size(); ++k) {
        const std::int32_t i = slab.outerI[k], j = slab.grainOf(slab.outerJ[k]);
        if (k > 0) {
          ASSERT_LT(std::pair(slab.outerI[k - 1], slab.outerJ[k - 1]), std::pair(i, slab.outerJ[k])) << "out of order, round " << round;
        }
        ASSERT_LT(i, static_cast<std::int32_t>(grains));
        ASSERT_TRUE(listed.insert({std::min(i, j), std::max(i, j)}).second) << "listed twice, round " << round;
        const Vec3 d = placeOf(state.rows[static_cast<std::size_t>(i)]) - placeOf(state.rows[static_cast<std::size_t>(slab.outerJ[k])]);
        ASSERT_LT((d - periods.nearest(d)).norm(), 1e-9);
      }
    }
    ASSERT_EQ(rowsSeen.size(), state.images);
    for (std::size_t a = 0; a < grains; ++a) {
      for (std::size_t b = a + 1; b < grains; ++b) {
        const double distance = periods.nearest(placeOf(state.rows[a]) - placeOf(state.rows[b])).norm();
        const double excess = distance - state.rows[a].radius - state.rows[b].radius - state.skin[a] - state.skin[b];
        if (std::abs(excess) < 1e-9) continue;
        ASSERT_EQ(listed.contains({static_cast<std::int32_t>(a), static_cast<std::int32_t>(b)}), excess < 0) << "round " << round;
      }
    }
  }
}

/// Unequal grains thrown at random into a periodic box, with everything a contact can do.
Scenario gas(std::array<bool, 3> along, Integrator integrator, int grains = 120) {
  Scenario s;
  s.model.integrator = integrator;
  s.model.contact = {"linear", "spring", "elastic_plastic", false};
  s.model.domain = Box(Vec3(-0.011, 0.002, -0.02), Vec3(0.011, 0.017, -0.004));
  s.model.periodic = along;
  s.model.watch.stop = false;
  s.pair[Property::normalStiffness] = 4000;
  s.pair[Property::restitution] = 0.7;
  s.pair[Property::friction] = 0.5;
  s.pair[Property::rollingFriction] = 0.1;
  Random random(7, 3);
  const Periods periods(s.model.domain, along);
  while (static_cast<int>(s.model.grains.size()) < grains) {
    const Vec3 x = s.model.domain.center() + 0.5 * s.model.domain.sizes().cwiseProduct(randomVec(random, 1));
    const double r = random.uniform(0.4e-3, 1.5e-3);
    bool free = true;
    for (const Grain& g : s.model.grains) free = free && periods.nearest(g.position - x).norm() > g.radius + r;
    if (free) s.grain(2500 * 4.2 * r * r * r * random.uniform(0.5, 2), r, x, randomVec(random, 1), randomVec(random, 300));
  }
  for (int axis = 0; axis < 3; ++axis) {
    if (along[static_cast<std::size_t>(axis)]) continue;
    s.plane(s.model.domain.min(), Vec3::Unit(axis));
    s.plane(s.model.domain.max(), -Vec3::Unit(axis));
    s.model.domain.min()[axis] -= 0.1;
    s.model.domain.max()[axis] += 0.1;
  }
  return s;
}

TEST(Periodic, NeverMissesAContactWhileGrainsMove) {
  for (const auto along : {std::array{true, false, false}, std::array{true, true, false}, everyWay}) {
    for (const double skin : {0.0, 1e-5}) {
      Scenario s = gas(along, Integrator::velocityVerlet);
      s.model.skin = skin;
      const Periods periods(s.model.domain, along);
      Simulation sim = s.start(2e-6);
      for (int n = 0; n < 60; ++n) {
        sim.advance(40);
        const Snapshot now = look(sim);
        std::uint64_t touching = 0;
        for (std::size_t a = 0; a < now.grains(); ++a) {
          EXPECT_EQ(now.position[a], periods.wrapped(now.position[a]));
          for (std::size_t b = a + 1; b < now.grains(); ++b)
            touching += periods.nearest(now.position[a] - now.position[b]).norm() < now.radius[a] + now.radius[b];
          for (int axis = 0; axis < 3; ++axis) {
            if (along[static_cast<std::size_t>(axis)]) continue;
            touching += now.position[a][axis] - now.radius[a] < s.model.domain.min()[axis] + 0.1;
            touching += now.position[a][axis] + now.radius[a] > s.model.domain.max()[axis] - 0.1;
          }
        }
        ASSERT_EQ(sim.contacts().touching, touching) << n;
      }
      EXPECT_EQ(sim.counts().lost, 0u);
    }
  }
}

// Note (A.9): what one grain gives the other gets, also across the boundary. (Angular momentum about a point is not kept: the two
// are not where the force acts.)
TEST(Periodic, MomentumStaysToRounding) {
  for (const Integrator integrator :
       {Integrator::symplecticEuler, Integrator::velocityVerlet, Integrator::centralDifferences, Integrator::rungeKutta}) {
    Simulation sim = gas(everyWay, integrator).start(2e-6);
    const Ledger before = sim.ledger();
    sim.advance(10000);
    const Ledger after = sim.ledger();
    EXPECT_LT(after.kinetic(), 0.7 * before.kinetic());
    EXPECT_GT(after.dissipatedFriction, 0);
    EXPECT_GT(after.dissipatedRolling, 0);
    const double rounding = integrator == Integrator::centralDifferences ? 1e-9 : 1e-12;
    EXPECT_LT((after.momentum - before.momentum).norm(), rounding * std::sqrt(2 * before.kinetic() * 1e-3));
    EXPECT_LT(after.residualFraction(), integrator == Integrator::velocityVerlet || integrator == Integrator::rungeKutta ? 1e-3 : 1e-2);
  }
}

TEST(Periodic, SameBitsForAnyNumberOfThreads) {
  for (const auto along : {std::array{false, true, false}, everyWay}) {
    std::vector<std::uint64_t> hashes;
    for (const int threads : {1, 2, 3, 8}) {
      Scenario s = gas(along, Integrator::velocityVerlet);
      s.model.ledger = threads != 3;  // nor with and without ledger
      Simulation sim = s.start(2e-6, threads);
      sim.advance(250);
      if (threads == 2) look(sim);
      sim.advance(100);
      hashes.push_back(sim.stateHash());
    }
    for (const std::uint64_t hash : hashes) EXPECT_EQ(hash, hashes[0]);
  }
}

/// Two unequal spinning grains that meet obliquely while both drift; the second is put `apart` from where it would meet the first.
Scenario meeting(const Vec3& drift, const Vec3& apart, double skin) {
  Scenario s;
  s.model.contact = {"linear", "spring", "elastic_plastic", false};
  s.model.skin = skin;
  s.pair[Property::normalStiffness] = 800;
  s.pair[Property::restitution] = 0.8;
  s.pair[Property::friction] = 0.6;
  s.pair[Property::rollingFriction] = 0.2;
  const Vec3 along = Vec3(0.6, -0.5, 0.62).normalized(), across = Vec3(0.1, 0.7, 0.5);
  s.grain(2e-5, 1.1e-3, Vec3::Zero(), drift, {100, -50, 200});
  s.grain(7e-5, 1.9e-3, 3.05e-3 * along + apart, drift - 0.3 * along + 0.2 * across, {-80, 150, 30});
  return s;
}

// Across every face, edge and corner, both ways: the pair is seen by the lists across the boundary at first, within the domain later
// (and again across it), and its memory goes along. The unbounded copy knows nothing of all this.
TEST(Periodic, CollisionsAcrossFacesEdgesAndCornersAreThoseInTheOpen) {
  const Vec3 length(0.0125, 0.0131, 0.0142);
  for (int number = -13; number <= 13; ++number) {
    for (const double skin : {0.0, 2e-6}) {
      const Vec3 direction(((number + 13) / 9) - 1, ((number + 13) / 3 % 3) - 1, ((number + 13) % 3) - 1);
      const Vec3 drift = 1.5 * direction;
      Scenario open = meeting(drift, Vec3::Zero(), skin), closed = meeting(drift, direction.cwiseProduct(length), skin);
      // The corner lies where the two will be in the middle of their contact.
      const Vec3 corner = 1e-3 * Vec3(0.7, -0.9, 0.8) + 4e-4 * drift;
      closed.model.domain = Box(corner - length, corner);
      closed.model.periodic = everyWay;
      Simulation a = open.start(1e-6), b = closed.start(1e-6);
      for (int n = 0; n < 8; ++n) {
        a.advance(150);
        b.advance(150);
        const Snapshot x = look(a), y = look(b);
        const Periods periods(closed.model.domain, everyWay);
        for (std::size_t g = 0; g < 2; ++g) {
          EXPECT_LT(periods.nearest(x.position[g] - y.position[g]).norm(), 1e-14) << number;
          EXPECT_LT((x.velocity[g] - y.velocity[g]).norm(), 1e-9) << number;
          EXPECT_LT((x.angularVelocity[g] - y.angularVelocity[g]).norm(), 1e-6) << number;
        }
        if (n == 3) {
          EXPECT_EQ(a.contacts().touching, 1u);
        }
      }
      EXPECT_GT(a.ledger().dissipatedFriction, 0);
      EXPECT_NEAR(b.ledger().dissipatedFriction, a.ledger().dissipatedFriction, 1e-9 * a.ledger().dissipatedFriction);
      EXPECT_NEAR(b.ledger().dissipatedRolling, a.ledger().dissipatedRolling, 1e-9 * a.ledger().dissipatedRolling);
      EXPECT_EQ(a.contacts().touching, 0u);
    }
  }
}

// A ball rolls down an incline for twenty periods, on a plane and on a mesh that goes on beyond the domain: the contact with the wall
// and its memory go along, and the work that gravity gets at each wrap is booked (E5).
TEST(Periodic, BallRollsOnForEver) {
  std::array<Vec3, 3> velocity;
  std::array<double, 3> residual{};
  for (const int kind : {0, 1, 2}) {
    Scenario s;
    s.model.contact = {"linear", "spring", "elastic_plastic", false};
    s.model.gravity = {4, 0.5, -8};
    s.model.skin = 1e-4;
    s.pair[Property::normalStiffness] = 3000;
    s.pair[Property::restitution] = 0.4;
    s.pair[Property::friction] = 0.7;
    s.pair[Property::rollingFriction] = 0.02;
    if (kind > 0) {
      s.model.domain = Box(Vec3(-0.01, -0.008, -1), Vec3(0.01, 0.008, 1));
      s.model.periodic = {true, true, false};
    }
    s.grain(1e-5, 1e-3, {0, 0, 0.99e-3});
    if (kind == 2)
      s.wall(Surface(test::rectangle(-0.02, 0.02, -0.02, 0.02, 0, 1, 1)));
    else
      s.plane({0, 0, 0}, {0, 0, 1});
    Simulation sim = s.start(1e-5);
    sim.advance(40000);
    velocity[static_cast<std::size_t>(kind)] = look(sim).velocity[0];
    const Ledger ledger = sim.ledger();
    residual[static_cast<std::size_t>(kind)] = ledger.residualFraction();
    EXPECT_EQ(sim.counts().lost, 0u);
    EXPECT_EQ(ledger.workFields > 0, kind > 0);
    EXPECT_TRUE(sim.warnings().empty());
  }
  EXPECT_GT(velocity[0].x(), 1.0);  // about (5/7)(4 − μ_r 8) 0.4
  EXPECT_LT((velocity[1] - velocity[0]).norm(), 1e-10);
  EXPECT_LT((velocity[2] - velocity[0]).norm(), 1e-10);
  EXPECT_LT(residual[0], 3e-4);  // mostly from when it drops onto the plane
  EXPECT_NEAR(residual[1], residual[0], 0.02 * residual[0]);
  EXPECT_NEAR(residual[2], residual[0], 0.02 * residual[0]);
}

// A grain that is glued to a belt goes round and round with it, and holds as it does on a belt without end.
TEST(Periodic, BondsWithWallsGoOnBeyondTheBoundary) {
  std::array<Vec3, 2> place, velocity;
  std::array<Ledger, 2> ledger;
  for (const bool wraps : {false, true}) {
    Scenario s;
    s.model.contact = {"linear", "spring", "none", false};
    s.model.gravity = {3, 0, 9.81};
    s.pair[Property::normalStiffness] = 3000;
    s.pair[Property::restitution] = 0.4;
    s.pair[Property::friction] = 0.5;
    if (wraps) {
      s.model.domain = Box(Vec3(-0.01, -0.008, -1), Vec3(0.01, 0.008, 1));
      s.model.periodic = {true, true, false};
    }
    Bonding glue;
    glue.name = "glue";
    glue.wall = 0;
    glue.distance = 1.1;
    glue.modulus = 1e7;
    glue.strength = {1e5, BondStrength::never, 1e5, 0, BondStrength::never};
    s.model.bonds = {glue};
    s.plane({0, 0, 0}, {0, 0, 1}, WallMotion({{Translation{{0.4, 0, 0}}, 0, 1e9}}));
    s.grain(1e-5, 1e-3, {8e-3, 1e-3, 1.05e-3}, {0.4, 0, 0});
    Simulation sim = s.start(2e-6);
    sim.advance(100000);  // four rounds
    EXPECT_EQ(sim.counts().bonds, 1U);
    place[wraps] = look(sim).position[0];
    velocity[wraps] = look(sim).velocity[0];
    ledger[wraps] = sim.ledger();
  }
  const double around = place[0].x() - place[1].x();
  EXPECT_NEAR(around, 0.02 * std::round(around / 0.02), 1e-9);
  EXPECT_NEAR(std::round(around / 0.02), 4, 0.5);
  EXPECT_LT((velocity[0] - velocity[1]).norm(), 1e-6);
  EXPECT_NEAR(ledger[0].elasticBonds, ledger[1].elasticBonds, 1e-5 * ledger[0].elasticBonds);
  EXPECT_NEAR(ledger[0].workWalls, ledger[1].workWalls, 1e-5 * std::abs(ledger[0].workWalls));
}

/// What the ledger of an inclined, periodic chute cannot explain, over what was turned over: grains flow through it again and again.
double residualOfChute(double dt) {
  Scenario s = gas({true, true, false}, Integrator::velocityVerlet, 90);
  s.model.gravity = 9.81 * Vec3(std::sin(0.7), 0, -std::cos(0.7));
  s.pair[Property::normalStiffness] = 1500;
  s.pair[Property::restitution] = 0.5;
  Simulation sim = s.start(dt);
  for (int n = 0; n < 20; ++n) {
    sim.advance(static_cast<std::uint64_t>(std::lround(4e-3 / dt)));
    sim.ledger();
  }
  const Ledger end = sim.ledger();
  EXPECT_GT(end.workFields, 0.01 * end.turnover);
  EXPECT_EQ(sim.counts().lost, 0u);
  return end.residualFraction();
}

TEST(Periodic, LedgerOfAnInclinedChuteCloses) {
  const double coarse = residualOfChute(4e-6), fine = residualOfChute(1e-6), order = std::log(coarse / fine) / std::log(4.0);
  fmt::print("  ledger residual of a periodic chute: {:.2e} at 4 µs, {:.2e} at 1 µs, order {:.2f}\n", coarse, fine, order);
  EXPECT_LT(fine, 1e-4);
  EXPECT_GT(order, 1.5);
}

// A wrap is not a crossing: a grain that flies round passes a plane once in each period, wherever the plane stands, also in the boundary.
TEST(Periodic, CountersCountOncePerPeriod) {
  const double length = 0.02, speed = 0.7, dt = 1e-5;
  for (const double sign : {1.0, -1.0}) {
    for (const Vec3& normal : {Vec3(1, 0, 0), Vec3(-1, 0, 0)}) {
      Scenario s;
      s.pair[Property::normalStiffness] = 100;
      s.pair[Property::restitution] = 1;
      s.model.domain = Box(Vec3(0, 0, 0), Vec3(length, length, length));
      s.model.periodic = {true, true, false};
      s.grain(1e-5, 1e-3, {0.0101, 0.004, 0.01}, {sign * speed, 0.3, 0});
      const std::array places{0.0, 1e-7, 0.005, 0.0149, length - 1e-7, length};
      for (const double place : places) s.model.counters.push_back({"x", {place, 0, 0}, normal, std::numeric_limits<double>::infinity()});
      s.model.counters.push_back({"z", {0, 0, 0.01}, {0, 0, 1}, std::numeric_limits<double>::infinity()});
      Simulation sim = s.start(dt);
      for (int n = 0; n < 50; ++n) {
        sim.advance(777);
        if (n % 3 == 0) sim.ledger();
      }
      sim.ledger();
      for (std::size_t c = 0; c < places.size(); ++c) {
        const double start = 0.0101, end = start + sign * speed * sim.time();
        const double passed = std::floor((end - places[c]) / length) - std::floor((start - places[c]) / length);
        EXPECT_EQ(static_cast<double>(sim.counts().crossed[c]), normal.x() * passed) << places[c];
        EXPECT_GT(std::abs(passed), 12);
      }
      EXPECT_EQ(sim.counts().crossed.back(), 0);
    }
  }
}

TEST(Periodic, DomainsTooShortOrEndlessAreRefused) {
  Scenario s;
  s.pair[Property::normalStiffness] = 100;
  s.pair[Property::restitution] = 1;
  s.grain(1e-5, 1e-3, Vec3::Zero());
  s.model.periodic = {false, true, false};
  EXPECT_THROW(s.start(1e-5), Error);
  s.model.domain = Box(Vec3(-1, -2.19e-3, -1), Vec3(1, 2.19e-3, 1));
  EXPECT_THROW(s.start(1e-5), Error);
  s.model.domain = Box(Vec3(-1e-3, -2.21e-3, -1e-3), Vec3(1e-3, 2.21e-3, 1e-3));
  EXPECT_NO_THROW(s.start(1e-5));
  s.wall(Surface(test::rectangle(-0.02, 0.02, -2e-3, 2e-3, -0.01, 1, 1)));
  Simulation sim = s.start(1e-5);
  ASSERT_EQ(sim.warnings().size(), 1u);
  EXPECT_NE(sim.warnings()[0].find("ends near the periodic boundary along y"), std::string::npos) << sim.warnings()[0];
}

// An inlet that fills the domain from face to face keeps its grains apart across the faces, too: none enters another.
TEST(Periodic, InletsSeeAcrossTheBoundary) {
  Scenario s;
  s.model.domain = Box(Vec3(0, 0, -1), Vec3(0.01, 0.01, 1));
  s.model.periodic = {true, true, false};
  s.model.ledger = true;
  s.pair[Property::normalStiffness] = 1000;
  s.pair[Property::restitution] = 0.5;
  Material glass{"glass", {}};
  glass.values[Property::density] = 2500;
  s.model.materials.push_back(glass);
  Stream stream;
  stream.name = "inlet";
  stream.region.shape = BoxRegion{{-1e-3, -1e-3, 0}, {0.011, 0.011, 2.4e-3}};  // grains reach over the faces
  stream.grainsPerSecond = 4e5;
  stream.radii.kind = UniformRadius{0.6e-3, 1.2e-3};
  stream.count = 60;
  s.model.streams.push_back(stream);
  Simulation sim = s.start(1e-5);
  sim.advance(4);  // at rest, without gravity: where they came in
  const Snapshot now = look(sim);
  EXPECT_GT(now.grains(), 10u);
  EXPECT_EQ(sim.contacts().touching, 0u);
}

}  // namespace
}  // namespace tsubu::sim
