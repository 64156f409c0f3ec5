// Every combination of laws in a running simulation: a cloud of unequal, spinning grains of three materials falls in upon itself.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/random.h"
#include "sim/kernel/kernels.h"
#include "sim/laws/catalogue.h"
#include "verification/models.h"

namespace tsubu::sim::test {
namespace {

Model cloud(const LawFunctions& law, bool severalMaterials) {
  Model m;
  m.contact = {std::string(law.names[0]), std::string(law.names[1]), std::string(law.names[2]), false, std::string(law.names[3])};
  m.watch.overlapLimit = 0.5;
  const std::size_t materials = severalMaterials ? 3 : 1;
  m.pairs = PairTable(materials);
  for (std::size_t a = 0; a < materials; ++a) {
    Material material{"m" + std::to_string(a), {}};
    material.values[Property::density] = 2000 + 700 * static_cast<double>(a);
    material.values[Property::youngModulus] = 2e7 * (1 + static_cast<double>(a));
    material.values[Property::poissonRatio] = 0.2 + 0.1 * static_cast<double>(a);
    m.materials.push_back(material);
    for (std::size_t b = 0; b <= a; ++b) {
      const double more = static_cast<double>(a + b);
      PropertyValues values;
      values[Property::normalStiffness] = 2e4 * (1 + 0.3 * more);
      values[Property::tangentialStiffness] = 1e4 * (1 + 0.2 * more);
      values[Property::restitution] = 0.8 - 0.1 * more;
      values[Property::friction] = 0.3 + 0.1 * more;
      if (m.contact.tangential == "viscous") values[Property::tangentialDampingRate] = 3000 + 500 * more;
      values[Property::rollingFriction] = 0.1 + 0.02 * more;
      values[Property::rollingViscosity] = 1 + more;
      values[Property::twistingFriction] = 0.08 + 0.01 * more;
      m.pairs.set(a, b, values);
    }
  }
  Random random(11, 1);
  for (int n = 0; n < 27; ++n) {
    Grain g;
    g.radius = random.uniform(0.8e-3, 2.4e-3);
    g.position = 5e-3 * Vec3(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1) + randomVec(random, 1e-5);
    g.velocity = -60 * g.position + randomVec(random, 0.3);
    g.angularVelocity = randomVec(random, 200);
    g.material = static_cast<std::uint16_t>(static_cast<std::size_t>(n) % materials);
    m.grains.push_back(g);
  }
  m.timeStep = 1e-6;
  return m;
}

// Both momenta to rounding; the account to the order of the scheme (a step of a hundredth of the shortest contact leaves 1e-3); and
// the energy of a closed system only falls, whatever the combination.
TEST(EveryLaw, KeepsMomentaAndAccount) {
  for (std::size_t index = 0; index < lawCount(); ++index) {
    const LawFunctions& law = lawFunctions(index);
    if (!law.objection.empty()) continue;
    SCOPED_TRACE(fmt::format("{} {} {} {}", law.names[0], law.names[1], law.names[2], law.names[3]));
    Simulation sim(cloud(law, true), 1);
    const Ledger before = sim.ledger();
    sim.advance(6000);
    const Ledger after = sim.ledger();
    const double momentum = std::sqrt(2 * before.kinetic() * 1e-3), angular = momentum * 0.01;
    EXPECT_LT(after.kinetic(), 0.8 * before.kinetic());  // something happened
    EXPECT_LT((after.momentum - before.momentum).norm(), 1e-12 * momentum);
    if (law.traits.turns) {
      EXPECT_LT((after.angularMomentumRest - before.angularMomentumRest).norm(), 1e-12 * angular);
    }
    // The projected force turns with the slip from one step to the next, and its account is of first order.
    EXPECT_LT(after.residualFraction(), law.names[1] == "projected" ? 2e-2 : 2e-3);
    if (law.names[2] != "none") {
      EXPECT_GT(after.dissipatedRolling, 0);
    }
  }
}

// One class of pairs or several, any instruction set, any number of threads: the same bits.
TEST(EveryLaw, HasOneHash) {
  const std::string widest(kernels().isa);
  for (std::size_t index = 0; index < lawCount(); ++index) {
    const LawFunctions& law = lawFunctions(index);
    if (!law.objection.empty()) continue;
    SCOPED_TRACE(fmt::format("{} {} {} {}", law.names[0], law.names[1], law.names[2], law.names[3]));
    for (const bool several : {false, true}) {
      std::vector<std::uint64_t> hashes;
      for (const Kernels& set : availableKernels()) {
        useKernels(set.isa);
        for (const int threads : {1, 3}) {
          Simulation sim(cloud(law, several), threads);
          sim.advance(300);
          hashes.push_back(sim.stateHash());
        }
      }
      for (const std::uint64_t hash : hashes) EXPECT_EQ(hash, hashes[0]) << (several ? "several materials" : "one material");
    }
  }
  useKernels(widest);
}

// Contacts in single precision: the same bits everywhere too. The same number is added to one partner and taken from the other, but the
// sums are single numbers: momenta and the account are kept to the digits of these.
TEST(EveryLaw, MixedPrecisionKeepsMomentaAndAccountAndHasOneHash) {
  const std::string widest(kernels().isa);
  int laws = 0;
  for (std::size_t index = 0; index < lawCount(); ++index) {
    const LawFunctions& law = lawFunctions(index);
    if (!law.objection.empty() || !hasSingleKernel(index)) continue;
    SCOPED_TRACE(fmt::format("{} {} {} {}", law.names[0], law.names[1], law.names[2], law.names[3]));
    ++laws;
    for (const bool several : {false, true}) {
      Model model = cloud(law, several);
      Simulation full(model, 1);
      model.precision = Precision::mixed;
      std::vector<std::uint64_t> hashes;
      for (const Kernels& set : availableKernels()) {
        useKernels(set.isa);
        for (const int threads : {1, 3}) {
          Simulation sim(model, threads);
          sim.advance(300);
          hashes.push_back(sim.stateHash());
        }
      }
      for (const std::uint64_t hash : hashes) EXPECT_EQ(hash, hashes[0]) << (several ? "several materials" : "one material");
      Simulation sim(model, 1);
      const Ledger before = sim.ledger();
      sim.advance(6000);
      full.advance(6000);
      const Ledger after = sim.ledger();
      const double momentum = std::sqrt(2 * before.kinetic() * 1e-3), angular = momentum * 0.01;
      EXPECT_NE(sim.stateHash(), full.stateHash());
      EXPECT_LT((after.momentum - before.momentum).norm(), 1e-8 * momentum);
      EXPECT_LT((after.angularMomentumRest - before.angularMomentumRest).norm(), 1e-5 * angular);
      EXPECT_LT(after.residualFraction(), 2e-3);
      EXPECT_NEAR(after.kinetic(), full.ledger().kinetic(), 1e-3 * before.kinetic());
    }
  }
  EXPECT_GE(laws, 8);
  useKernels(widest);
}

// Materials that are alike but have different names go through the loop for several classes when another pair differs: the same bits
// as through the loop for one.
TEST(EveryLaw, SeveralClassesAreOneWhenAlike) {
  for (std::size_t index = 0; index < lawCount(); ++index) {
    const LawFunctions& law = lawFunctions(index);
    if (!law.objection.empty()) continue;
    Model one = cloud(law, false), two = cloud(law, false);
    two.materials.push_back(two.materials[0]);
    two.materials[1].name = "other";
    two.materials[1].values[Property::youngModulus] *= 2;
    const PropertyValues values = one.pairs.at(0, 0);
    two.pairs = PairTable(2);
    PropertyValues different = values;
    different[Property::restitution] = 0.1;
    two.pairs.set(0, 0, values);
    two.pairs.set(0, 1, different);
    two.pairs.set(1, 1, different);
    // Far away, so that it meets nobody.
    Grain far = two.grains[0];
    far.position = {0.5, 0.5, 0.5};
    far.velocity = far.angularVelocity = Vec3::Zero();
    one.grains.push_back(far);
    far.material = 1;
    two.grains.push_back(far);
    Simulation a(std::move(one), 1), b(std::move(two), 1);
    a.advance(300);
    b.advance(300);
    const Snapshot x = look(a), y = look(b);
    for (std::size_t g = 0; g < 27; ++g)
      EXPECT_EQ(x.position[g], y.position[g]) << law.names[0] << ' ' << law.names[1] << ' ' << law.names[2];
  }
}

}  // namespace
}  // namespace tsubu::sim::test
