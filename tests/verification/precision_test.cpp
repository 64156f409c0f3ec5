// Mixed precision: contacts between grains in single numbers, from differences of places taken in double. What must not be lost with them.

#include <gtest/gtest.h>

#include "core/error.h"
#include "verification/models.h"

namespace tsubu::sim::test {
namespace {

Scenario mixed() {
  Scenario s;
  s.model.precision = Precision::mixed;
  return s;
}

// An overlap is a small difference of large numbers: at a ten-millionth of the radius nothing would be left of it if the distance were
// rounded to a single number first. One grain lies on another, which rests on a plane: δ = m g/k, far away from the origin.
TEST(MixedPrecision, ResolvesOverlapsBelowARoundedDistance) {
  constexpr double k = 2e5, mass = 3e-5, g = 9.81, lower = 2.1e-3, upper = 1.7e-3;
  const double overlap = mass * g / k;
  ASSERT_LT(overlap, 1e-6 * upper);
  Scenario s = mixed();
  s.model.gravity = {0, 0, -g};
  s.pair[Property::normalStiffness] = k;
  s.pair[Property::restitution] = 0.3;
  const Vec3 far(1000, -2000, 500);
  s.plane(far, {0, 0, 1});
  s.grain(5e-5, lower, far + Vec3(0, 0, lower));
  s.grain(mass, upper, far + Vec3(0, 0, 2 * lower + upper));
  Simulation sim = s.start(2e-6);
  sim.advance(60'000);
  const Snapshot now = look(sim);
  const double found = lower + upper - (now.position[1] - now.position[0]).norm();
  EXPECT_NEAR(found, overlap, 2e-4 * overlap);  // 500 m has a last bit of 1.1e-13 m
  EXPECT_LT(now.velocity[1].norm(), 1e-9);
}

// Oblique collisions of unequal, spinning grains end as they do in double, to the digits of single numbers.
TEST(MixedPrecision, CollisionsEndAsInDouble) {
  Random random(3, 7);
  for (int n = 0; n < 40; ++n) {
    Scenario s;
    s.model.contact = {n % 2 ? "hertz" : "linear", n % 4 < 2 ? "spring" : "none", n % 4 < 2 && n % 3 ? "elastic_plastic" : "none",
                       n % 5 == 0};
    s.pair[Property::normalStiffness] = 3000;
    s.pair[Property::tangentialStiffness] = 1200;
    s.pair[Property::restitution] = random.uniform(0.1, 0.9);
    s.pair[Property::friction] = random.uniform(0.05, 0.8);
    s.pair[Property::rollingFriction] = 0.1;
    const double r1 = random.uniform(1e-3, 3e-3), r2 = random.uniform(1e-3, 3e-3);
    const auto any = [&](double size) { return randomVec(random, size); };
    s.grain(random.uniform(1e-5, 9e-5), r1, Vec3::Zero(), any(0.2), any(100));
    s.grain(random.uniform(1e-5, 9e-5), r2, {r1 + r2 + 1e-6, 0, 0}, Vec3(-0.5, 0, 0) + any(0.2), any(100));
    for (Material& material : s.model.materials) {
      material.values[Property::youngModulus] = 2e7;
      material.values[Property::poissonRatio] = 0.3;
    }
    Scenario single = s;
    single.model.precision = Precision::mixed;
    Simulation a = s.start(1e-6), b = single.start(1e-6);
    a.advance(4000);
    b.advance(4000);
    const Snapshot x = look(a), y = look(b);
    EXPECT_NE(a.stateHash(), b.stateHash());
    ASSERT_EQ(x.angularVelocity.size(), y.angularVelocity.size());
    for (std::size_t g = 0; g < 2; ++g) {
      EXPECT_LT((x.velocity[g] - y.velocity[g]).norm(), 1e-5) << n;
      if (x.angularVelocity.empty()) continue;                                     // without friction nothing turns
      EXPECT_LT((x.angularVelocity[g] - y.angularVelocity[g]).norm(), 2e-2) << n;  // of some 100 rad/s
    }
  }
}

// Grains that fly together and rub, with all that a scene may have beside contacts: whatever moves grains, the single rows go along, and
// whatever else acts adds to the same forces.
Scenario crowd(int seed) {
  Scenario s;
  s.model.contact = {"linear", "spring", "elastic_plastic", false};
  s.pair[Property::normalStiffness] = 3000;
  s.pair[Property::restitution] = 0.6;
  s.pair[Property::friction] = 0.4;
  s.pair[Property::rollingFriction] = 0.1;
  Random random(static_cast<std::uint64_t>(seed), 3);
  const auto any = [&](double size) { return randomVec(random, size); };
  for (int n = 0; n < 48; ++n) {
    const Vec3 place = 4.4e-3 * Vec3(n % 4 - 1.5, n / 4 % 4 - 1.5, n / 16 - 1) + any(2e-5);
    s.grain(random.uniform(2e-5, 6e-5), random.uniform(1.5e-3, 2.1e-3), place, -80 * place + any(0.2), any(40));
  }
  s.model.gravity = {0.4, 0, -9.81};
  s.plane({0, 0, -8e-3}, {0, 0, 1});
  return s;
}

struct Setting {
  const char* name;
  void (*set)(Scenario&);
};

TEST(MixedPrecision, FollowsDoubleWhateverElseTheSceneHas) {
  const Setting settings[] = {
      {"velocity Verlet", [](Scenario&) {}},
      {"symplectic Euler", [](Scenario& s) { s.model.integrator = Integrator::symplecticEuler; }},
      {"explicit Euler", [](Scenario& s) { s.model.integrator = Integrator::explicitEuler; }},
      {"leapfrog", [](Scenario& s) { s.model.integrator = Integrator::leapfrog; }},
      {"central differences", [](Scenario& s) { s.model.integrator = Integrator::centralDifferences; }},
      {"nothing turns",
       [](Scenario& s) {
         s.model.contact = {"linear", "none", "none", false};
       }},
      {"periodic",
       [](Scenario& s) {
         s.model.periodic = {true, true, false};
         s.model.domain = Box(Vec3(-8.8e-3, -8.8e-3, -1), Vec3(8.8e-3, 8.8e-3, 1));
         for (Grain& grain : s.model.grains) grain.velocity *= -1;  // to meet across the boundary
       }},
      {"a wall under load",
       [](Scenario& s) {
         s.plane({0, 0, 9e-3}, {0, 0, -1}).body = WallBody{{0, 0, 1}, 2e-3, 0, true, 0, -0.3, 0};
       }},
      {"damping", [](Scenario& s) { s.model.fields.damping.emplace().rate = 3; }},
      {"continuous",
       [](Scenario& s) {
         s.model.continuous = true;
         s.grain(4e-5, 2e-3, {0, 0, 0.03}, {0, 0, -60});
         s.model.watch.stop = false;
       }},
  };
  for (const Setting& setting : settings) {
    SCOPED_TRACE(setting.name);
    Scenario s = crowd(4);
    setting.set(s);
    Scenario single = s;
    single.model.precision = Precision::mixed;
    Simulation a = s.start(2e-6), b = single.start(2e-6, 2), looked = single.start(2e-6);
    for (int n = 0; n < 40; ++n) {
      looked.advance(75);
      looked.ledger();
      look(looked);
    }
    a.advance(3000);
    b.advance(3000);
    EXPECT_EQ(b.stateHash(), looked.stateHash());
    EXPECT_NE(a.stateHash(), b.stateHash());
    const Snapshot x = look(a), y = look(b);
    int met = 0;
    for (std::size_t g = 0; g < x.position.size(); ++g) {
      EXPECT_LT((x.position[g] - y.position[g]).norm(), 1e-8) << g;
      EXPECT_LT((x.velocity[g] - y.velocity[g]).norm(), 2e-4) << g;
      met += (x.velocity[g] - s.model.grains[g].velocity - a.time() * s.model.gravity).norm() > 0.1;
    }
    EXPECT_GT(met, 30);
  }
}

// A step that changes its length moves grains once more (I8), and the single rows with them.
TEST(MixedPrecision, FollowsDoubleThroughChangesOfTheStep) {
  Scenario s = crowd(6), single = s;
  single.model.precision = Precision::mixed;
  Simulation a = s.start(2e-6), b = single.start(2e-6);
  for (const double dt : {1e-6, 3e-6, 2e-6}) {
    for (Simulation* sim : {&a, &b}) {
      sim->setTimeStep(dt);
      sim->advance(800);
    }
  }
  const Snapshot x = look(a), y = look(b);
  for (std::size_t g = 0; g < x.position.size(); ++g) EXPECT_LT((x.position[g] - y.position[g]).norm(), 1e-8) << g;
}

std::string refusal(Scenario s) {
  try {
    s.start(1e-6);
  } catch (const Error& error) {
    return error.diagnostics().front().message;
  }
  return "accepted";
}

TEST(MixedPrecision, RefusesWhatItCannotDo) {
  Scenario s = mixed();
  s.pair[Property::normalStiffness] = 1000;
  s.pair[Property::restitution] = 0.5;
  s.pair[Property::friction] = 0.5;
  s.pair[Property::tangentialDampingRate] = 100;
  s.grain(1e-9, 20e-6, Vec3::Zero());
  EXPECT_EQ(refusal(s), "accepted");
  Scenario dust = s;
  dust.grain(1e-12, 2e-6, {1, 0, 0});
  EXPECT_EQ(refusal(dust), "A radius of 2e-06 m is outside of what single precision can do: 1e-05 m to 100 m.");
  s.model.contact.tangential = "viscous";
  EXPECT_NE(refusal(s).find("viscous"), std::string::npos);
  s.model.contact.tangential = "spring";
  EXPECT_EQ(refusal(s), "accepted");
  s.model.integrator = Integrator::rungeKutta;
  EXPECT_NE(refusal(s).find("Runge-Kutta"), std::string::npos);
}

}  // namespace
}  // namespace tsubu::sim::test
