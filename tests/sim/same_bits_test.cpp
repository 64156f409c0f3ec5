// The same scene gives the same bits: for any number of threads and instruction set, with and without ledger, looked at or not.

#include <gtest/gtest.h>

#include "sim/kernel/kernels.h"
#include "verification/models.h"
#include "verification/shapes.h"

namespace tsubu::sim {
namespace {

using test::Scenario;

/// Everything at once: unequal grains, friction, rolling, a turning mesh, planes, an inlet, a sink, a counter.
Scenario busy(Integrator integrator) {
  Scenario s;
  s.model.integrator = integrator;
  s.model.contact = {"linear", "spring", "elastic_plastic", false};
  s.model.gravity = {0, 0, -9.81};
  s.model.watch.stop = false;
  s.pair[Property::normalStiffness] = 5000;
  s.pair[Property::restitution] = 0.5;
  s.pair[Property::friction] = 0.5;
  s.pair[Property::rollingFriction] = 0.1;
  Material glass{"glass", {}};
  glass.values[Property::density] = 2500;
  s.model.materials.push_back(glass);
  Random random(2, 2);
  for (int n = 0; n < 400; ++n) {
    Grain g;
    g.radius = random.uniform(0.5e-3, 2e-3);
    g.position = Vec3(4.2e-3 * (n % 12 - 5.5), 4.2e-3 * (n / 12 % 6 - 2.5), 3e-3 + 4.2e-3 * (n / 72));
    g.velocity = Vec3(random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), 0);
    s.model.grains.push_back(g);
  }
  Stream stream;
  stream.name = "inlet";
  stream.region.shape = BoxRegion{{-0.02, -0.01, 0.035}, {0.02, 0.01, 0.05}};
  stream.grainsPerSecond = 1500;
  stream.radii.kind = UniformRadius{0.6e-3, 1.2e-3};
  stream.velocity = {0, 0, -0.5};
  s.model.streams.push_back(stream);
  s.model.sinks.push_back({"drain", {BoxRegion{{0.015, -1, -1}, {1, 1, 5e-3}}}});
  s.model.counters.push_back({"half way", {0, 0, 15.5e-3}, {0, 0, -1}, 1.0});
  s.plane({0, 0, 0}, {0, 0, 1});
  s.wall(Surface(test::rectangle(-0.02, 0.02, -0.005, 0.005, 0, 2, 2)),
         WallMotion({{Translation{{0, 0, 0.006}}, 0, 0}, {Rotation{{0, 0, 0.006}, Vec3::UnitX(), 40}, 0, 10}}));
  return s;
}

struct Outcome {
  std::uint64_t hash;
  std::uint64_t inserted, removed;
  std::int64_t crossed;
  bool operator==(const Outcome&) const = default;
};

Outcome outcomeOf(Simulation& sim) { return {sim.stateHash(), sim.counts().inserted, sim.counts().removed, sim.counts().crossed[0]}; }

constexpr double dt = 8e-6;
constexpr std::uint64_t steps = 800;

Outcome run(const Scenario& scenario, int threads) {
  Scenario s = scenario;
  Simulation sim = s.start(dt, threads);
  sim.advance(steps);
  return outcomeOf(sim);
}

void expectSame(const Outcome& a, const Outcome& b, const std::string& what) {
  EXPECT_EQ(a.hash, b.hash) << what;
  EXPECT_TRUE(a == b) << what;
}

TEST(SameBits, ForAnyNumberOfThreads) {
  for (const Integrator integrator : {Integrator::symplecticEuler, Integrator::velocityVerlet, Integrator::rungeKutta}) {
    const Scenario s = busy(integrator);
    const Outcome one = run(s, 1);
    EXPECT_GT(one.inserted, 5u);
    EXPECT_GT(one.removed, 5u);
    EXPECT_NE(one.crossed, 0);
    for (const int threads : {2, 3, 8})
      if (threads < 8 || integrator != Integrator::rungeKutta) expectSame(run(s, threads), one, std::to_string(threads) + " threads");
  }
}

TEST(SameBits, InMixedPrecision) {
  Scenario s = busy(Integrator::velocityVerlet);
  s.model.precision = Precision::mixed;
  const Outcome one = run(s, 1);
  for (const int threads : {2, 5}) expectSame(run(s, threads), one, std::to_string(threads) + " threads");
  s.model.ledger = false;
  expectSame(run(s, 1), one, "without ledger");
}

TEST(SameBits, ForEveryInstructionSet) {
  const std::string before(kernels().isa);
  const Scenario s = busy(Integrator::velocityVerlet);
  useKernels("portable");
  const Outcome portable = run(s, 1);
  for (const Kernels& each : availableKernels()) {
    useKernels(each.isa);
    expectSame(run(s, 1), portable, std::string(each.isa));
  }
  useKernels(before);
}

TEST(SameBits, WithAndWithoutLedger) {
  Scenario s = busy(Integrator::velocityVerlet);
  const Outcome with = run(s, 1);
  s.model.ledger = false;
  expectSame(run(s, 1), with, "without ledger");
}

// Looking forces the evaluation of forces that the next step would have made: it must be the same evaluation, made once.
TEST(SameBits, HoweverOftenOneLooks) {
  for (const Integrator integrator : {Integrator::symplecticEuler, Integrator::velocityVerlet, Integrator::explicitEuler,
                                      Integrator::leapfrog, Integrator::centralDifferences, Integrator::rungeKutta}) {
    Scenario s = busy(integrator);
    const Outcome unseen = run(s, 1);
    Simulation sim = s.start(dt);
    Random random(1, 1);
    while (sim.steps() < steps) {
      sim.advance(std::min<std::uint64_t>(1 + static_cast<std::uint64_t>(random.uniform(0, 40)), steps - sim.steps()));
      if (random.uniform() < 0.5) sim.ledger();
      if (random.uniform() < 0.5) test::look(sim);
      if (random.uniform() < 0.5) sim.contacts();
      if (random.uniform() < 0.5) sim.stateHash();
    }
    expectSame(outcomeOf(sim), unseen, "looked at");
  }
}

TEST(SameBits, ForMaterialsThatDifferInNameAlone) {
  Scenario s = busy(Integrator::velocityVerlet);
  const Outcome one = run(s, 1);
  s.model.materials.push_back(s.model.materials[0]);
  s.model.materials.back().name = "glass, blue";
  for (std::size_t n = 0; n < s.model.grains.size(); n += 2) s.model.grains[n].material = 1;
  expectSame(run(s, 1), one, "two materials");
}

// Different numbers must give different hashes, or the tests above say nothing.
TEST(SameBits, ADifferentRunIsADifferentHash) {
  Scenario s = busy(Integrator::velocityVerlet);
  const Outcome one = run(s, 1);
  s.model.grains[17].velocity.x() += 1e-12;
  EXPECT_NE(run(s, 1).hash, one.hash);
}

// Memory of contacts survives rebuilds: a heap whose lists are made anew in every step stands like one whose lists are never.
// The order of sums differs with the lists, so the two agree to rounding, as long as chaos leaves them.
TEST(Rebuilds, CarryTheMemoryOfContacts) {
  for (const char* rolling : {"none", "elastic_plastic"}) {
    std::vector<Vec3> reference;
    for (const double skin : {5e-3, 1e-3, 1e-7}) {
      Scenario s;
      s.model.contact = {"linear", "spring", rolling, false};
      s.model.gravity = {0, 0, -9.81};
      s.model.skin = skin;
      s.model.watch.stop = false;
      s.pair[Property::normalStiffness] = 5000;
      s.pair[Property::restitution] = 0.2;
      s.pair[Property::friction] = 0.6;
      s.pair[Property::rollingFriction] = 0.1;
      // Three unequal grains side by side and one on top of them, on a sloping plane: friction everywhere.
      s.grain(3e-5, 1.5e-3, {0, 0, 1.5e-3});
      s.grain(4e-5, 1.7e-3, {3.1e-3, 0, 1.7e-3});
      s.grain(2e-5, 1.3e-3, {1.5e-3, 2.7e-3, 1.3e-3});
      s.grain(5e-5, 1.9e-3, {1.55e-3, 0.9e-3, 4.3e-3}, {0.02, 0, 0}, {5, 10, 3});
      s.plane({0, 0, 0}, Vec3(0.05, 0, 1).normalized());
      Simulation sim = s.start(4e-6);
      sim.advance(2000);
      const Snapshot now = test::look(sim);
      if (reference.empty()) reference = now.position;
      for (std::size_t g = 0; g < reference.size(); ++g)
        EXPECT_LT((now.position[g] - reference[g]).norm(), 1e-12) << skin << ", grain " << g;
    }
  }
}

}  // namespace
}  // namespace tsubu::sim
