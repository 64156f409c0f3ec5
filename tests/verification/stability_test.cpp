// How long a step may be: the scheme's characteristic polynomial, and the step at which the program blows up.

#include <complex>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include "verification/models.h"

namespace tsubu::sim::test {
namespace {

/// S2: the bound on W = ω Δt, s = 1 for symplectic Euler and 2 for velocity Verlet.
double bound(double s, double zeta) { return 2 * (std::sqrt(1 + s * s * zeta * zeta) - s * zeta); }

/// Largest |λ| of one contact: x_{n+1} − 2x_n + x_{n−1} = −W² x_n − 2ζW d, where the dashpot sees d = x_n − x_{n−1} in symplectic
/// Euler, and the velocity carried on by half a step, d = (3x_n − 4x_{n−1} + x_{n−2})/2, in velocity Verlet.
double spectralRadius(Integrator integrator, double W, double zeta) {
  Eigen::Matrix3d companion;
  const double z = zeta * W;
  if (integrator == Integrator::symplecticEuler)
    companion << 2 - W * W - 2 * z, -(1 - 2 * z), 0, 1, 0, 0, 0, 1, 0;
  else
    companion << 2 - W * W - 3 * z, -(1 - 4 * z), -z, 1, 0, 0, 0, 1, 0;
  return companion.eigenvalues().cwiseAbs().maxCoeff();
}

// All roots lie within the unit circle up to the bound, none of the complex ones leaves it earlier, and beyond it one is outside.
TEST(Stability, BoundIsExactForAnyDamping) {
  for (const Integrator integrator : {Integrator::symplecticEuler, Integrator::velocityVerlet}) {
    const double s = integrator == Integrator::velocityVerlet ? 2 : 1;
    for (double zeta = 1e-4; zeta < 1e3; zeta *= 1.3) {
      for (int k = 1; k < 200; ++k) EXPECT_LE(spectralRadius(integrator, k / 200.0 * bound(s, zeta), zeta), 1 + 1e-12) << zeta << " " << k;
      EXPECT_GT(spectralRadius(integrator, 1.001 * bound(s, zeta), zeta), 1) << zeta;
    }
  }
}

// Tangential and rolling springs of velocity Verlet are stretched by the velocity carried on by half a step: s_n − s_{n−1} =
// ½(v_n + v_{n−1})Δt with v_n = u_{n−½} + ½a_{n−1}Δt. By itself that gains W⁴/4 of the energy per step (the root's excess is W⁴/8);
// with the least dashpot of T6, ζ = W³/2, nothing grows up to √2, nor beyond S2 with any stronger one.
double tangentialRadius(double W, double zeta) {
  Eigen::Matrix4d map;  // of s, v, U = uΔt and A = aΔt²
  for (int k = 0; k < 4; ++k) {
    const Eigen::Vector4d x = Eigen::Vector4d::Unit(k);
    const double U = x[2] + x[3], v = U + 0.5 * x[3], s = x[0] + 0.5 * (v + x[1]), A = -W * W * s - 2 * zeta * W * v;
    map.col(k) << s, v, U, A;
  }
  return map.eigenvalues().cwiseAbs().maxCoeff();
}

TEST(Stability, TangentialSpringsOfVerletNeedTheirLeastDashpot) {
  for (const double W : {0.05, 0.1, 0.2}) EXPECT_NEAR(tangentialRadius(W, 0) - 1, std::pow(W, 4) / 8, 0.1 * std::pow(W, 4) / 8);
  for (double W = 0.01; W < std::numbers::sqrt2; W += 0.01) {
    for (double zeta = 0.5 * W * W * W; W <= bound(2, zeta); zeta = std::max(1.3 * zeta, 1e-6))
      EXPECT_LE(tangentialRadius(W, zeta), 1 + 1e-12) << W << " " << zeta;
  }
}

/// A grain between two planes that press it; does the amplitude of a small disturbance grow? The planes' two contacts give
/// ω² = 2k/m and η twice that of one.
bool blowsUp(Integrator integrator, double k, double mass, double rate, double dt) {
  Scenario s;
  s.model.integrator = integrator;
  s.model.contact.tension = true;
  s.model.watch.stop = false;
  s.pair[Property::normalStiffness] = k;
  s.pair[Property::normalDampingRate] = rate;
  const double r = 2e-3;
  s.grain(mass, r, {0, 0, 1e-9});
  s.plane({0, 0, -0.9 * r}, {0, 0, 1});
  s.plane({0, 0, 0.9 * r}, {0, 0, -1});
  Simulation sim = s.start(dt);
  double largest = 0;
  for (int n = 0; n < 4000; ++n) {
    sim.advance(1);
    largest = std::max(largest, std::abs(look(sim).position[0].z()));
    if (largest > 1e-5) return true;  // ten thousand times the disturbance, and still well inside both contacts
  }
  return false;
}

// In the program, for stiffness over mass and damping over decades: stable one per cent below, unstable one per cent above.
TEST(Stability, ProgramBlowsUpWherePredicted) {
  for (const Integrator integrator : {Integrator::symplecticEuler, Integrator::velocityVerlet}) {
    for (const double ratio : {1e6, 1e8, 1e10}) {
      for (const double zeta : {0.0, 0.02, 0.3, 1.0, 3.0}) {
        const double mass = 1e-5, k = ratio * mass, omega = std::sqrt(2 * k / mass);
        const double limit = bound(integrator == Integrator::velocityVerlet ? 2 : 1, zeta) / omega;
        const double rate = zeta * omega;  // 2 η/m = 2ζω
        EXPECT_FALSE(blowsUp(integrator, k, mass, rate, 0.99 * limit)) << "zeta " << zeta;
        EXPECT_TRUE(blowsUp(integrator, k, mass, rate, 1.01 * limit)) << "zeta " << zeta;
      }
    }
  }
}

// Note (2.31), min(2√(m/k), 2m/η), takes spring and dashpot one at a time; with both the step it allows is too long.
TEST(Stability, SeparateLimitsOfTheNoteAreTooLong) {
  const double mass = 1e-5, k = 1e3, omega = std::sqrt(2 * k / mass);
  for (const double zeta : {0.1, 0.5, 1.0}) {
    const double note = std::min(2 / omega, 2 / (2 * zeta * omega));  // the mode's own k and η: 2k and 2η
    EXPECT_TRUE(blowsUp(Integrator::symplecticEuler, k, mass, zeta * omega, 0.99 * note)) << zeta;
  }
  EXPECT_FALSE(blowsUp(Integrator::symplecticEuler, k, mass, 0, 0.99 * 2 / omega));  // undamped it is right for one mode
}

// The Article's π√(m/k) is the duration of a contact and lies above the limit.
TEST(Stability, DurationOfAContactIsNoLimit) {
  const double mass = 1e-5, k = 1e3, omega = std::sqrt(2 * k / mass);
  for (const Integrator integrator : {Integrator::symplecticEuler, Integrator::velocityVerlet})
    EXPECT_TRUE(blowsUp(integrator, k, mass, 0, pi / omega));
}

/// Largest mechanical energy over that at the start, at `share` of the step that is chosen before any contact is known.
double growth(Scenario s, double share, int steps) {
  s.model.watch.stop = false;
  s.model.domain = Box(Vec3::Constant(-1), Vec3::Constant(1));
  Model m = s.model;
  m.pairs = PairTable(m.materials.size());
  for (std::size_t a = 0; a < m.materials.size(); ++a)
    for (std::size_t b = a; b < m.materials.size(); ++b) m.pairs.set(a, b, s.pair);
  Simulation sim = s.start(share * chooseTimeStep(m).limit);
  const double start = sim.ledger().mechanical();
  double largest = start;
  for (int n = 0; n < steps; n += 10) {
    sim.advance(10);
    largest = std::max(largest, sim.ledger().mechanical());
  }
  return largest / start;
}

/// Grains pressed into a closed-packed block in a box, jittering.
Scenario block(Random& random, double ratioOfMasses) {
  Scenario s;
  s.model.contact = {"linear", "spring", "none", true};
  const double r = 1e-3, a = 1.96 * r;  // overlap of four per cent
  int count = 0;
  for (int z = 0; z < 4; ++z)
    for (int y = 0; y < 4; ++y)
      for (int x = 0; x < 4; ++x) {
        const Vec3 p(a * (x + 0.5 * ((y + z) % 2)), a * (std::sqrt(0.75) * (y + (z % 2) / 3.0)), a * std::sqrt(2.0 / 3) * z);
        const Vec3 v(random.uniform(-1e-3, 1e-3), random.uniform(-1e-3, 1e-3), random.uniform(-1e-3, 1e-3));
        s.grain(count++ % 3 == 0 ? 1e-5 * ratioOfMasses : 1e-5, r, p, v, 1000 * v);
      }
  const double w = 0.98 * r, top = 3 * a * std::sqrt(2.0 / 3) + w, right = 3.5 * a + w, back = a * std::sqrt(0.75) * (3 + 1 / 3.0) + w;
  s.plane({0, 0, -w}, {0, 0, 1});
  s.plane({0, 0, top}, {0, 0, -1});
  s.plane({-w, 0, 0}, {1, 0, 0});
  s.plane({right, 0, 0}, {-1, 0, 0});
  s.plane({0, -w, 0}, {0, 1, 0});
  s.plane({0, back, 0}, {0, -1, 0});
  s.pair[Property::normalStiffness] = 1e3;
  s.pair[Property::friction] = 100;
  return s;
}

// S3, the step that is chosen before any contact is known, holds with a margin of a fifth: grains with twelve neighbours, light ones among
// heavy ones and between walls, springs across stiffer than those along the contact, rolling springs. What is stable cannot gain energy
// (but for the scheme's own swing, which at the limit is no longer small).
TEST(Stability, ChosenStepIsSafeForPackedGrains) {
  for (const Integrator integrator : {Integrator::symplecticEuler, Integrator::velocityVerlet}) {
    for (const double ratio : {1.0, 1e3}) {
      for (const double kt : {0.0, 2.0 / 7, 1.0, 3.0}) {
        for (const double e : {1.0, 0.5, 0.1}) {
          for (const char* rolling : {"none", "elastic_plastic"}) {
            Random random(3, 9);
            Scenario s = block(random, ratio);
            s.model.integrator = integrator;
            s.model.contact.rolling = rolling;
            s.pair[Property::tangentialStiffness] = 1e3 * kt;
            s.pair[Property::restitution] = e;
            s.pair[Property::rollingFriction] = 0.8;
            EXPECT_LT(growth(s, 1, 1000), 2) << "ratio " << ratio << ", k_t/k_n " << kt << ", e " << e << ", rolling " << rolling << ", "
                                             << (integrator == Integrator::velocityVerlet ? "Verlet" : "Euler");
          }
        }
      }
    }
  }
}

// A dashpot given by its rate counts, too: tangentially it may be the stiffest thing there is.
TEST(Stability, ChosenStepKnowsTangentialDashpots) {
  Random random(3, 9);
  Scenario s = block(random, 1);
  s.pair[Property::normalDampingRate] = 100;
  s.pair[Property::tangentialDampingRate] = 1e5;
  EXPECT_LT(growth(s, 1, 1000), 2);
}

}  // namespace
}  // namespace tsubu::sim::test
