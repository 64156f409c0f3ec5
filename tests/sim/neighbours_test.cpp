// Who may touch whom, against brute force.

#include <algorithm>
#include <numeric>
#include <set>

#include <gtest/gtest.h>

#include "core/random.h"
#include "sim/kernel/kernels.h"
#include "sim/neighbours/cell_grid.h"
#include "sim/neighbours/drift.h"
#include "sim/neighbours/pair_lists.h"
#include "sim/neighbours/skins.h"
#include "sim/neighbours/slabs.h"
#include "sim/periodic.h"
#include "sim/walls/shapes.h"
#include "verification/models.h"

namespace tsubu::sim {
namespace {

enum class Shape { cloud, sheet, line, clusters, point, count };

/// Positions of one kind, radii spread over `ratio` by decades, the whole moved by `offset`.
std::vector<GrainRow> randomRows(Random& random, Shape shape, int count, double ratio, const Vec3& offset) {
  std::vector<GrainRow> rows;
  const double size = 2e-3 * std::cbrt(count) * random.uniform(0.5, 3);
  for (int n = 0; n < count; ++n) {
    Vec3 x(random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size));
    if (shape == Shape::sheet) x.y() = 1e-6 * x.y();
    if (shape == Shape::line) x = Vec3(5 * x.x(), 0, 1e-3 * x.z());
    if (shape == Shape::clusters) x = 0.1 * x + size * Vec3(n % 3, n % 2, n % 5);
    if (shape == Shape::point) x = 1e-4 * x;
    x += offset;
    const double r = 1e-3 * std::pow(ratio, -random.uniform());
    rows.push_back({x.x(), x.y(), x.z(), r, 0, 0, 0, 1, 0, 0, 0, 1 / r});
  }
  return rows;
}

double gap(const GrainRow& a, const GrainRow& b) { return Vec3(a.x - b.x, a.y - b.y, a.z - b.z).norm() - a.radius - b.radius; }

// With the loops of every instruction set, in turn.
TEST(CellGrid, FindsAllThatBruteForceFinds) {
  const std::string usual(kernels().isa);
  Random random(21, 1);
  for (int round = 0; round < 2000; ++round) {
    useKernels(availableKernels()[static_cast<std::size_t>(round) / 20 % availableKernels().size()].isa);
    const auto shape = static_cast<Shape>(round % static_cast<int>(Shape::count));
    const double ratio = std::array{1.0, 1.4, 10.0, 100.0}[static_cast<std::size_t>(round / 5 % 4)];
    const Vec3 offset = round % 7 == 0 ? Vec3(1e6, -1e6, 5e5) : Vec3(Vec3::Zero());
    const std::vector<GrainRow> rows = randomRows(random, shape, 1 + round % 60, ratio, offset);
    const double reach = 1e-3 * random.uniform(0, 0.8);
    CellGrid grid;
    grid.build(rows, reach);
    std::vector<std::int32_t> found;
    for (std::size_t g = 0; g < rows.size(); ++g) {
      found.clear();
      grid.near(Vec3(rows[g].x, rows[g].y, rows[g].z), rows[g].radius, static_cast<std::int32_t>(g), found);
      std::sort(found.begin(), found.end());
      ASSERT_EQ(std::adjacent_find(found.begin(), found.end()), found.end()) << "found twice, round " << round;
      std::vector<std::int32_t> partners;
      partners.resize(grid.partners(Vec3(rows[g].x, rows[g].y, rows[g].z), rows[g].radius, static_cast<std::int32_t>(g), partners));
      std::sort(partners.begin(), partners.end());
      ASSERT_EQ(partners,
                std::vector<std::int32_t>(std::upper_bound(found.begin(), found.end(), static_cast<std::int32_t>(g)), found.end()));
      for (std::size_t o = 0; o < rows.size(); ++o) {
        if (o == g) continue;
        const double excess = gap(rows[g], rows[o]) - reach;
        if (std::abs(excess) < 1e-9) continue;  // as far from the origin as this, positions themselves are rounded
        ASSERT_EQ(std::binary_search(found.begin(), found.end(), static_cast<std::int32_t>(o)), excess < 0) << "round " << round;
      }
    }
  }
  useKernels(usual);
}

// Grains of one size that lie in the order of slabs have their partners in this order too: what makes searching for them and sorting cheap.
TEST(CellGrid, PartnersOfEqualGrainsComeInOrder) {
  ThreadTeam team(2);
  Random random(21, 3);
  for (const double skin : {0.0, 2e-4}) {
    State state;
    for (int n = 0; n < 3000; ++n)
      state.rows.push_back({random.uniform(0, 0.03), random.uniform(0, 0.011), random.uniform(0, 0.05), 1e-3, 0, 0, 0, 1, 0, 0, 0, 1e3});
    state.skin.assign(state.rows.size(), static_cast<float>(skin));
    std::vector<std::int32_t> order, found;
    sortIntoSlabs(state.rows, 2 * (1e-3 + static_cast<double>(state.skin[0])), order, team);
    state.reorder(order);
    CellGrid grid;
    grid.build(state.rows, 0, state.skin);
    std::size_t pairs = 0;
    for (std::size_t g = 0; g < state.rows.size(); ++g) {
      const GrainRow& row = state.rows[g];
      const std::size_t count = grid.partners(Vec3(row.x, row.y, row.z), row.radius + state.skin[g], static_cast<std::int32_t>(g), found);
      EXPECT_TRUE(std::is_sorted(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(count)));
      pairs += count;
    }
    EXPECT_GT(pairs, 3000);
  }
}

// Grains get a new order, some go and some come: the memory of the others follows, and what is a force changes its sign with the order of a
// pair.
TEST(PairLists, MemoryFollowsGrainsInTheirNewOrder) {
  Random random(21, 4);
  ThreadTeam team(2);
  std::size_t kept = 0, turned = 0;
  for (int round = 0; round < 200; ++round) {
    const bool single = round % 2 == 1;
    constexpr unsigned odd = 0b101;
    const auto remembered = [](std::uint32_t a, std::uint32_t b, int component) {
      const double size = a < b ? 1 + a + 0.5 * b : 1 + b + 0.5 * a;
      return (odd >> component & 1U) != 0 && a > b ? -size * (component + 1) : size * (component + 1);
    };
    State state;
    state.rows = randomRows(random, static_cast<Shape>(round / 2 % 2), 80, round % 3 == 0 ? 3.0 : 1.0, Vec3::Zero());
    const auto sorted = [&](std::vector<std::int32_t>& order) {
      for (std::size_t g = state.skin.size(); g < state.rows.size(); ++g) {
        state.skin.push_back(2e-4F);
        state.id.push_back(state.nextId++);
      }
      Slabs slabs = sortIntoSlabs(state.rows, 2 * (1e-3 + 2.1e-4), order, team);
      state.reorder(order);
      return slabs;
    };
    const auto rebuild = [&](PairLists& pairs, const Slabs& slabs, const std::vector<std::int32_t>& newPlace) {
      CellGrid grid;
      grid.build(state.rows, 0, state.skin);
      if (single) state.mixed = true, state.allToSingle();
      pairs.build(state, slabs, grid, 0.5, newPlace, team);
    };
    std::vector<std::int32_t> order;
    const Slabs before = sorted(order);
    PairLists pairs(3, odd, single);
    rebuild(pairs, before, order);
    std::set<std::pair<std::uint32_t, std::uint32_t>> known;
    for (SlabPairs& slab : pairs.slabs()) {
      for (std::size_t k = 0; k < slab.i.size(); ++k) {
        const std::uint32_t a = state.id[static_cast<std::size_t>(slab.i[k])], b = state.id[static_cast<std::size_t>(slab.j[k])];
        for (int c = 0; c < 3; ++c) slab.memory.set(static_cast<std::size_t>(c), k, remembered(a, b, c));
        known.insert({std::min(a, b), std::max(a, b)});
      }
    }
    pairs.rememberContacts(before, team);

    // Each fifth grain goes, the others are turned about a little, and one comes.
    std::vector<std::int32_t> stay, place(state.rows.size(), -1);
    for (std::size_t g = 0; g < place.size(); ++g) {
      GrainRow& row = state.rows[g];
      std::swap(row.x, row.z);
      row.y = -row.y;
      if (g % 5 == 4) continue;
      place[g] = static_cast<std::int32_t>(stay.size());
      stay.push_back(static_cast<std::int32_t>(g));
    }
    state.reorder(stay);
    state.rows.push_back(state.rows.front());
    state.rows.back().x += 1e-4;
    const std::uint32_t newcomer = state.nextId;
    const Slabs after = sorted(order);
    std::vector<std::int32_t> moved(order.size());
    for (std::size_t g = 0; g < order.size(); ++g) moved[static_cast<std::size_t>(order[g])] = static_cast<std::int32_t>(g);
    for (std::int32_t& to : place)
      if (to >= 0) to = moved[static_cast<std::size_t>(to)];
    rebuild(pairs, after, place);
    for (const SlabPairs& slab : pairs.slabs()) {
      for (std::size_t k = 0; k < slab.i.size(); ++k) {
        const std::uint32_t a = state.id[static_cast<std::size_t>(slab.i[k])], b = state.id[static_cast<std::size_t>(slab.j[k])];
        const bool knew = known.contains({std::min(a, b), std::max(a, b)});
        if (a == newcomer || b == newcomer) {
          ASSERT_FALSE(knew);
        }
        kept += knew, turned += knew && a > b;
        for (std::size_t c = 0; c < 3; ++c)
          ASSERT_EQ(slab.memory.at(c, k), knew ? remembered(a, b, static_cast<int>(c)) : 0) << "round " << round;
      }
    }
  }
  EXPECT_GT(kept, 5000U);
  EXPECT_GT(turned, 1000U);
}

TEST(PairLists, HoldEveryNearPairOnceInOrder) {
  Random random(21, 2);
  ThreadTeam team(2);
  for (int round = 0; round < 1000; ++round) {
    const auto shape = static_cast<Shape>(round % static_cast<int>(Shape::count));
    const double ratio = std::array{1.0, 3.0, 10.0, 100.0}[static_cast<std::size_t>(round / 5 % 4)];
    State state;
    state.rows = randomRows(random, shape, 1 + round % 90, ratio, round % 7 == 0 ? Vec3(1e6, 0, -1e6) : Vec3(Vec3::Zero()));
    // Every grain has a skin of its own: most of them thin ones.
    const double thickest = 1e-3 * random.uniform(0.005, 1), share = 0.4;
    for (std::size_t g = 0; g < state.rows.size(); ++g)
      state.skin.push_back(static_cast<float>(thickest * std::pow(random.uniform(0.01, 1), 3)));
    std::vector<std::int32_t> order;
    const Slabs slabs = sortIntoSlabs(state.rows, 2 * (1e-3 + thickest), order, team);
    state.reorder(order);
    const std::vector<GrainRow>& sorted = state.rows;
    std::vector<std::int32_t> place(order.size());
    std::iota(place.begin(), place.end(), 0);
    CellGrid grid;
    grid.build(state.rows, 0, state.skin);
    PairLists pairs(3, 0b111);
    pairs.build(state, slabs, grid, share, place, team);

    std::set<std::pair<std::int32_t, std::int32_t>> listed, listedInner;
    ASSERT_EQ(slabs.begin(0), 0);
    ASSERT_EQ(slabs.end(slabs.count() - 1), static_cast<std::int32_t>(sorted.size()));
    for (int s = 0; s < slabs.count(); ++s) {
      const SlabPairs& slab = pairs.slabs()[static_cast<std::size_t>(s)];
      for (std::size_t k = 0; k < slab.outerI.size(); ++k) {
        const auto pair = std::pair(slab.outerI[k], slab.outerJ[k]);
        ASSERT_LT(pair.first, pair.second);
        ASSERT_TRUE(pair.first >= slabs.begin(s) && pair.first < slabs.end(s));
        ASSERT_TRUE(pair.second < slabs.end(std::min(s + 1, slabs.count() - 1))) << "a slab writes to itself and the next";
        ASSERT_TRUE(listed.insert(pair).second);
        if (k > 0) {
          ASSERT_LT(std::pair(slab.outerI[k - 1], slab.outerJ[k - 1]), pair);
        }
      }
      for (std::size_t k = 0; k < slab.i.size(); ++k) listedInner.insert({slab.i[k], slab.j[k]});
    }
    for (std::size_t a = 0; a < sorted.size(); ++a) {
      for (std::size_t b = a + 1; b < sorted.size(); ++b) {
        const double g = gap(sorted[a], sorted[b]), skin = state.skin[a] + state.skin[b], inner = share * skin;
        const auto pair = std::pair(static_cast<std::int32_t>(a), static_cast<std::int32_t>(b));
        if (std::abs(g - skin) > 1e-9) {
          ASSERT_EQ(listed.contains(pair), g < skin) << "round " << round;
        }
        if (std::abs(g - inner) > 1e-9) {
          ASSERT_EQ(listedInner.contains(pair), g < inner) << "round " << round;
        }
      }
    }
  }
}

// Over a run in which grains fly about, what the simulation says is touching is what brute force says, at every look.
TEST(Lists, NeverMissAContactWhileGrainsMove) {
  for (const double ratio : {1.0, 10.0, 100.0}) {
    for (const double skin : {0.0, 1e-5, 3e-3}) {
      test::Scenario s;
      s.pair[Property::normalStiffness] = 2000;
      s.pair[Property::restitution] = 0.9;
      s.model.skin = skin;
      s.model.watch.stop = false;
      Random random(33, static_cast<std::uint64_t>(ratio));
      for (const GrainRow& row : randomRows(random, Shape::cloud, 150, ratio, Vec3::Zero())) {
        const Vec3 x(row.x, row.y, row.z), v(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
        s.grain(2500 * 4.2 * std::pow(row.radius, 3) + 1e-8, row.radius, x, 0.5 * v - 20 * x);
      }
      Simulation sim = s.start(2e-6);
      for (int n = 0; n < 150; ++n) {
        sim.advance(20);
        const Snapshot now = test::look(sim);
        std::uint64_t touching = 0;
        double deepest = 0;
        for (std::size_t a = 0; a < now.grains(); ++a) {
          for (std::size_t b = a + 1; b < now.grains(); ++b) {
            const double overlap = now.radius[a] + now.radius[b] - (now.position[a] - now.position[b]).norm();
            if (overlap <= 0) continue;
            ++touching;
            deepest = std::max(deepest, overlap / std::min(now.radius[a], now.radius[b]));
          }
        }
        const ContactSummary summary = sim.contacts();
        ASSERT_EQ(summary.touching, touching) << "ratio " << ratio << ", skin " << skin << ", look " << n;
        ASSERT_NEAR(summary.deepestOverlap, deepest, 1e-12);
      }
    }
  }
}

GrainRow rowAt(double x, double speed) { return {x, 0, 0, 1e-3, 0, 0, -speed, 1, 0, 0, 0, 1e3}; }

TEST(Skins, FollowTheFastestGrainNearby) {
  ThreadTeam team(2);
  const SkinRule rule{1e-3, 1e-4, 9e-4};
  // Beside a grain of 0.5 m/s one at rest may soon go as fast; far away none may.
  const std::vector<float> skins = chooseSkins({rowAt(0, 0), rowAt(2e-3, 0.5), rowAt(0.1, 0), rowAt(0.2, 7), rowAt(0.3, 0.2)}, rule, team);
  EXPECT_FLOAT_EQ(skins[0], 5e-4F);
  EXPECT_FLOAT_EQ(skins[1], 5e-4F);
  EXPECT_FLOAT_EQ(skins[2], 1e-4F);
  EXPECT_FLOAT_EQ(skins[3], 9e-4F);
  EXPECT_FLOAT_EQ(skins[4], 2e-4F);
  EXPECT_TRUE(chooseSkins({}, rule, team).empty());
}

TEST(Drift, EndsTheListsThatReadASlabAndNoOthers) {
  Drift drift;
  drift.restart({{0, 1}, {1, 2}, {2}});
  drift.add(0, 0.04);
  drift.add(1, 0.06);
  drift.add(2, 0);
  EXPECT_FALSE(drift.beyond(0, 0.1, 0));
  EXPECT_TRUE(drift.beyond(0, 0.1, 1)) << "not for another step like this";
  drift.add(1, 0.06);
  EXPECT_TRUE(drift.beyond(0, 0.1, 0));
  EXPECT_TRUE(drift.beyond(1, 0.1, 0));
  EXPECT_FALSE(drift.beyond(2, 0.1, 0));
  drift.filtered(1);
  EXPECT_FALSE(drift.beyond(1, 0.1, 0));
  EXPECT_TRUE(drift.beyond(0, 0.1, 0)) << "this one has not been filtered";
  EXPECT_DOUBLE_EQ(drift.sinceSearch(1), 0.12);
  drift.add(2, std::numeric_limits<double>::quiet_NaN());
  EXPECT_TRUE(drift.beyond(2, 0.1, 0));
}

/// Contacts of all grains with each other, across the boundary too, and with all features of all walls.
std::uint64_t touchingByBruteForce(const Snapshot& now, const Model& model, double time) {
  const Periods periods(model.domain, model.periodic);
  std::uint64_t touching = 0;
  for (std::size_t a = 0; a < now.grains(); ++a)
    for (std::size_t b = a + 1; b < now.grains(); ++b)
      touching += periods.nearest(now.position[a] - now.position[b]).norm() < now.radius[a] + now.radius[b];
  for (const Wall& wall : model.walls) {
    std::vector<std::uint32_t> all(wall.surface->featureCount());
    std::iota(all.begin(), all.end(), 0U);
    WallContacts contacts;
    for (std::size_t g = 0; g < now.grains(); ++g) {
      wall.surface->contacts(wall.motion.at(time).toLocal(now.position[g]), now.radius[g], all, contacts);
      touching += static_cast<std::uint64_t>(contacts.size());
    }
  }
  return touching;
}

/// Grains of several sizes that lie apart at rest, and above them fast ones that fly into them.
test::Scenario fastAboveResting(std::uint64_t seed) {
  test::Scenario s;
  s.pair[Property::normalStiffness] = 4000;
  s.pair[Property::restitution] = 0.95;
  s.model.watch.stop = false;
  s.model.domain = Box(Vec3::Constant(-6.6e-3), Vec3::Constant(6.6e-3));
  Random random(seed, 34);
  for (int n = 0; n < 5 * 5 * 6; ++n) {
    const bool fast = n >= 125;
    const Vec3 x = 2.4e-3 * Vec3(n % 5 - 2, n / 5 % 5 - 2, n / 25 - 2.2),
               v = fast ? 12 * test::randomIn(random, -Vec3::Ones(), Vec3::Ones()) : Vec3(0, 0, 0);
    const double r = fast ? 0.5e-3 : 1e-3 * random.uniform(0.3, 1.1);
    s.grain(2500 * 4.2 * r * r * r, r, x, v);
  }
  return s;
}

std::uint64_t expectAllContactsAreFound(const test::Scenario& scenario, const std::string& what, int looks = 100) {
  test::Scenario s = scenario;
  s.model.contactForces = true;
  Simulation sim = s.start(2e-6);
  std::uint64_t seen = 0;
  for (int n = 0; n < looks; ++n) {
    sim.advance(7);
    const Snapshot now = test::look(sim);
    const std::uint64_t touching = touchingByBruteForce(now, s.model, sim.time());
    seen += touching;
    EXPECT_EQ(sim.contacts().touching, touching) << what << ", look " << n;
    EXPECT_EQ(sim.instant().contacts.size(), touching) << what << ", look " << n << ": those that act";
    if (::testing::Test::HasFailure()) return 0;
  }
  EXPECT_GT(seen, static_cast<std::uint64_t>(looks)) << what << ": nothing happens";
  return sim.counts().impacts;
}

WallMotion shaken() {
  return WallMotion({{Oscillation{{8e-4, 5e-4, 1e-3}, 300, 0.2}, 0, 1e9}, {Rotation{{0, 0, 0}, Vec3::UnitZ(), 40}, 0, 1e9}});
}

TEST(Lists, NeverMissAContactOfFastGrainsBesideRestingOnes) {
  for (const double skin : {0.0, 2e-5, 2e-3}) {
    for (const Integrator integrator : {Integrator::symplecticEuler, Integrator::velocityVerlet, Integrator::rungeKutta}) {
      test::Scenario s = fastAboveResting(1);
      s.model.skin = skin;
      s.model.integrator = integrator;
      s.model.periodic = {true, true, true};
      expectAllContactsAreFound(s, "periodic");

      s.model.periodic = {};
      s.model.domain = Box(Vec3::Constant(-1), Vec3::Constant(1));
      s.wall(Surface(test::makeBox(Vec3::Constant(-7.5e-3), Vec3::Constant(7.5e-3))));
      s.wall(Surface(test::makeCone(24, 1e-3, -7e-3, 8e-3, 4e-3)));
      expectAllContactsAreFound(s, "meshes");
      s.model.walls[0].motion = shaken();
      s.plane({0, 0, -7e-3}, {0, 0, 1}, WallMotion({{Oscillation{{0, 0, 1e-3}, 400, 0}, 0, 1e9}}));
      expectAllContactsAreFound(s, "meshes and a plane that are shaken");
    }
  }
}

TEST(Lists, NeverMissAContactWhereWaysAreSwept) {
  test::Scenario s = fastAboveResting(2);
  s.model.continuous = true;
  s.pair[Property::normalStiffness] = 400;
  for (Grain& grain : s.model.grains) grain.velocity *= 2;
  s.model.domain = Box(Vec3::Constant(-1), Vec3::Constant(1));
  s.wall(Surface(test::makeBox(Vec3::Constant(-7.5e-3), Vec3::Constant(7.5e-3))));
  EXPECT_GT(expectAllContactsAreFound(s, "swept", 300), 10U);
}

TEST(Lists, NeverMissAContactOfGrainsThatComeAndGo) {
  test::Scenario s = fastAboveResting(3);
  s.model.domain = Box(Vec3(-8e-3, -8e-3, -7e-3), Vec3(8e-3, 8e-3, 1.2e-2));
  Stream stream;
  stream.name = "rain";
  stream.region.shape = BoxRegion{{-7e-3, -7e-3, 8e-3}, {7e-3, 7e-3, 1.1e-2}};
  stream.grainsPerSecond = 1e5;
  stream.radii.kind = UniformRadius{0.3e-3, 0.9e-3};
  stream.velocity = {0, 0, -10};
  s.model.streams.push_back(stream);
  expectAllContactsAreFound(s, "rain", 200);
}

}  // namespace
}  // namespace tsubu::sim
