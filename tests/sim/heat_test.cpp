// Heat between grains that touch: exponentials, a chain in series, and what is kept.

#include "sim/heat.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "verification/models.h"

namespace tsubu::sim::test {
namespace {

/// Grains so soft that they stay where they are; materials of their own (Scenario).
struct Warm : Scenario {
  Warm() {
    model.heat = true;
    model.watch.overlapLimit = 1;
    pair[Property::normalStiffness] = 1e-18;
    pair[Property::restitution] = 1;
  }
  void grain(double mass, double radius, const Vec3& position, double temperature, double conductivity, double capacity) {
    Scenario::grain(mass, radius, position);
    model.grains.back().temperature = temperature;
    model.materials.back().values[Property::conductivity] = conductivity;
    model.materials.back().values[Property::heatCapacity] = capacity;
  }
};

// The difference falls off as exp(−h (1/C₁ + 1/C₂) t), h = 2 k* √(R* δ); the mean of the heat stays. Bonded or not: the contact is there.
class TwoGrains : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Heat, TwoGrains, testing::Bool(), [](const auto& bonded) { return bonded.param ? "bonded" : "apart"; });

TEST_P(TwoGrains, ApproachTheirMean) {
  const double r1 = 2e-3, r2 = 3.5e-3, overlap = 2e-4, m1 = 1e-4, m2 = 7e-4, k1 = 0.8, k2 = 16, c1 = 800, c2 = 450;
  Warm s;
  s.grain(m1, r1, {0, 0, 0}, 400, k1, c1);
  s.grain(m2, r2, (r1 + r2 - overlap) * Vec3(1, 2, -2) / 3, 290, k2, c2);
  if (GetParam()) {
    Bonding bonding;
    bonding.stiffness = 1e-6;
    s.model.bonds.push_back(bonding);
  }
  const double h = 2 * (2 * k1 * k2 / (k1 + k2)) * std::sqrt(r1 * r2 / (r1 + r2) * overlap), C1 = m1 * c1, C2 = m2 * c2;
  const double rate = h * (1 / C1 + 1 / C2), t = 0.7 / rate, mean = (C1 * 400 + C2 * 290) / (C1 + C2);
  double before = 0;
  for (const int steps : {500, 2000}) {
    Simulation sim = s.start(t / steps);
    const double start = sim.ledger().heat.stored;
    sim.advance(static_cast<std::uint64_t>(steps));
    const Snapshot end = look(sim);
    EXPECT_NEAR(sim.ledger().heat.stored / start, 1, 1e-14);
    EXPECT_NEAR((C1 * end.temperature[0] + C2 * end.temperature[1]) / (C1 + C2), mean, 1e-10);
    const double error = std::abs((end.temperature[0] - end.temperature[1]) / (110 * std::exp(-0.7)) - 1);
    EXPECT_LT(error, 0.51 * 0.7 * 0.7 / steps);  // Euler's own: ½ (rate Δt)² in each step
    if (before > 0) {
      EXPECT_NEAR(before / error, 4, 0.1);
    }
    before = error;
  }
}

// A chain between a cold and a hot wall: contacts in series. A plane has 1/R = 0, so its contact is √2 wider than one between equals.
TEST(Heat, ChainBetweenWallsIsLinear) {
  const double r = 1e-3, overlap = 4e-5, k = 0.9, kw = 40, cold = 280, hot = 350;
  const int n = 5;
  Warm s;
  for (int g = 0; g < n; ++g) s.grain(1e-5, r, {(r - overlap) + g * (2 * r - overlap), 0, 0}, 300, k, 700);
  s.model.materials.push_back({"steel", {}});
  s.model.materials.back().values[Property::conductivity] = kw;
  Wall& left = s.plane({0, 0, 0}, {1, 0, 0});
  left.material = n;
  left.temperature = cold;
  Wall& right = s.plane({n * (2 * r - overlap) - overlap, 0, 0}, {-1, 0, 0});
  right.material = n;
  right.temperature = hot;
  s.plane({0, 0, -0.9e-3}, {0, 0, 1}).material = n;  // touches all of them, and is insulated

  Simulation sim = s.start(0.5);
  sim.advance(6000);
  const double toWall = 1 / (2 * (2 * k * kw / (k + kw)) * std::sqrt(r * overlap)), between = 1 / (2 * k * std::sqrt(0.5 * r * overlap));
  const double flux = (hot - cold) / (2 * toWall + (n - 1) * between);
  const Snapshot end = look(sim);
  for (int g = 0; g < n; ++g) EXPECT_NEAR(end.temperature[static_cast<std::size_t>(g)], cold + flux * (toWall + g * between), 1e-6) << g;
  // As much comes from the hot wall as goes into the cold one.
  const double before = sim.ledger().heat.fromWalls;
  sim.advance(1000);
  EXPECT_NEAR(sim.ledger().heat.fromWalls, before, 1e-9);
}

/// A warm rain into a cold box with a hot floor and a sink.
Scenario rain() {
  Scenario s;
  s.model.heat = true;
  s.model.contact = {"linear", "spring", "none", false};
  s.model.gravity = {0, 0, -9.81};
  s.pair[Property::normalStiffness] = 2e4;
  s.pair[Property::restitution] = 0.5;
  s.pair[Property::friction] = 0.4;
  Material copper{"copper", {}};
  copper.values[Property::density] = 8900;
  copper.values[Property::conductivity] = 4e4;  // a hundred times copper's: there is little time
  copper.values[Property::heatCapacity] = 385;
  s.model.materials.push_back(copper);
  Stream stream;
  stream.name = "inlet";
  stream.region.shape = BoxRegion{{-0.01, -0.01, 0.004}, {0.01, 0.01, 0.014}};
  stream.grainsPerSecond = 2000;
  stream.radii.kind = UniformRadius{1e-3, 1.6e-3};
  stream.velocity = {0, 0, -0.5};
  stream.temperature = 330;
  s.model.streams.push_back(stream);
  s.model.sinks.push_back({"out", {BoxRegion{{0.004, -1, -1}, {1, 1, 3e-3}}}});
  s.model.domain = Box(Vec3::Constant(-0.5), Vec3::Constant(0.5));
  s.plane({0, 0, 0}, {0, 0, 1}).temperature = 500;
  for (int axis = 0; axis < 2; ++axis)
    for (const double side : {-1.0, 1.0}) s.plane(-side * 0.012 * Vec3::Unit(axis), side * Vec3::Unit(axis));
  return s;
}

TEST(Heat, IsKeptToRounding) {
  Simulation sim = rain().start(1e-5);
  sim.advance(7000);
  const HeatLedger heat = sim.ledger().heat;
  EXPECT_GT(sim.counts().removed, 5u);
  EXPECT_GT(std::abs(heat.fromWalls), 1e-3 * heat.stored);
  EXPECT_NEAR(heat.stored - heat.fromWalls - heat.inserted + heat.removed, 0, 1e-11 * heat.inserted);
}

TEST(Heat, AnyNumberOfThreadsTheSameBits) {
  std::uint64_t hash = 0;
  for (const int threads : {1, 2, 3}) {
    Simulation sim = rain().start(1e-5, threads);
    sim.advance(1200);
    if (threads == 1) hash = sim.stateHash();
    EXPECT_EQ(sim.stateHash(), hash) << threads;
  }
}

// Across a periodic boundary grains touch as they do inside.
TEST(Heat, FlowsAcrossAPeriodicBoundary) {
  const auto after = [](double shift) {
    Warm s;
    s.model.domain = Box(Vec3::Zero(), Vec3::Constant(0.02));
    s.model.periodic = {true, true, false};
    for (int g = 0; g < 3; ++g) s.grain(1e-5 * (g + 1), 1e-3, {0.005 + shift + 1.9e-3 * g, 0.01, 0.01}, 300 + 50 * g, 1, 700);
    Simulation sim = s.start(1);
    sim.advance(20);
    return look(sim).temperature;
  };
  const std::vector<double> inside = after(0), across = after(0.0125);
  EXPECT_GT(inside[0], 301);
  for (std::size_t g = 0; g < 3; ++g) EXPECT_NEAR(inside[g], across[g], 1e-9);
}

TEST(Heat, TooFastForTheStepIsNamed) {
  Warm s;
  s.grain(1e-5, 1e-3, {0, 0, 0}, 300, 1, 700);
  s.grain(1e-5, 1e-3, {1.9e-3, 0, 0}, 400, 1, 700);
  const double h = 2 * std::sqrt(0.5e-3 * 1e-4), limit = 1e-5 * 700 / h;
  EXPECT_NO_THROW(s.start(0.999 * limit).advance(3));
  EXPECT_THROW(s.start(1.001 * limit).advance(3), Error);
  // What a step is chosen by: twelve such contacts.
  Model model = s.model;
  model.pairs = PairTable(2);
  model.pairs.set(0, 0, s.pair), model.pairs.set(0, 1, s.pair), model.pairs.set(1, 1, s.pair);
  const TimeStepChoice choice = chooseTimeStep(model);
  EXPECT_NEAR(choice.limit, limit / 12, 1e-9 * limit);
  EXPECT_EQ(choice.limitedBy, "heat conduction of m0, smallest grains");
}

}  // namespace
}  // namespace tsubu::sim::test
