// Head-on contacts, springs and free flight.

#include <complex>

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include "verification/models.h"

namespace tsubu::sim::test {
namespace {

constexpr double stiffness = 1234, speed = 0.37;

/// Restitution of one head-on collision of a grain with a wall (other mass 0) or another grain, obliquely placed in space, with the
/// beginning of the contact at `phase` of a step. Steps are `share` of the contact's duration.
double measuredRestitution(Integrator integrator, bool tension, double e, double mass, double otherMass, double phase,
                           double share = 0.01) {
  Scenario s;
  s.model.integrator = integrator;
  s.model.contact.tension = tension;
  s.pair[Property::normalStiffness] = stiffness;
  s.pair[Property::restitution] = e;
  const double r = 1.3e-3, other = 2.1e-3, effective = otherMass > 0 ? mass * otherMass / (mass + otherMass) : mass;
  const double duration = contactDuration(stiffness, effective, e, tension), dt = share * duration;
  const Vec3 n = Vec3(0.3, -0.5, 0.8).normalized();
  const double gap = phase * speed * dt;
  if (otherMass > 0) {
    // The heavier one is nearly at rest, so that the ratio of the masses costs no digits.
    s.grain(mass, r, (r + gap) * n, -speed * n);
    s.grain(otherMass, other, -other * n);
  } else {
    s.grain(mass, r, (r + gap) * n, -speed * n);
    s.plane(Vec3::Zero(), n);
  }
  Simulation sim = s.start(dt);
  sim.advance(static_cast<std::uint64_t>(1.5 / share));
  const Snapshot after = look(sim);
  const Vec3 apart = otherMass > 0 ? Vec3(after.velocity[0] - after.velocity[1]) : after.velocity[0];
  return apart.dot(n) / speed;
}

// Asked is measured, to 1e-3 at a hundredth of the contact (velocity Verlet), wherever in a step the contact begins. Symplectic
// Euler's dashpot sees a velocity half a step old: an error of first order, ζ² (ωΔt)² per step, 6e-3 at most here.
TEST(Restitution, IsWhatWasAskedFor) {
  for (const Integrator integrator : {Integrator::velocityVerlet, Integrator::symplecticEuler}) {
    const double tolerance = integrator == Integrator::velocityVerlet ? 1e-3 : 1e-2;
    for (const bool tension : {false, true}) {
      for (int k = 1; k <= 20; ++k) {
        const double e = 0.05 * k;
        for (const double ratio : {0.0, 1.0, 17.0, 1e3, 1e6}) {
          for (const double phase : {0.1, 0.37, 0.82}) {
            EXPECT_NEAR(measuredRestitution(integrator, tension, e, 3e-5, 3e-5 * ratio, phase), e, tolerance)
                << (tension ? "tension, " : "") << "ratio of masses " << ratio << ", phase " << phase;
          }
        }
      }
    }
  }
}

// The error falls with the square of the step in velocity Verlet.
TEST(Restitution, ErrorIsOfSecondOrder) {
  for (const double e : {0.3, 0.7, 0.9}) {
    const double coarse = measuredRestitution(Integrator::velocityVerlet, false, e, 3e-5, 0, 0.4, 0.01) - e;
    const double fine = measuredRestitution(Integrator::velocityVerlet, false, e, 3e-5, 0, 0.4, 0.0025) - e;
    EXPECT_LT(std::abs(fine), std::abs(coarse) / 10) << e;
  }
}

TEST(Restitution, ElasticCollisionKeepsItsEnergy) {
  EXPECT_NEAR(measuredRestitution(Integrator::velocityVerlet, false, 1, 3e-5, 2e-4, 0.3), 1, 1e-5);
  EXPECT_NEAR(measuredRestitution(Integrator::symplecticEuler, false, 1, 3e-5, 2e-4, 0.3), 1, 1e-5);
}

// E6. In the first step of a contact, begun a time τ ago, the grains have fallen in by uτ; the force pushes for half a step, as the scheme
// has it, where it should have risen in τ. What is left is ½ k u² τ(τ − Δt) + F²Δt²/8m*, of second order; over what has been turned over
// until then it is all there is. A spring and a dashpot alike: what the dashpot takes is booked to the last bit.
TEST(LinearContact, ResidualOfTheFirstTouchIsThatOfAHalfStep) {
  for (const double e : {1.0, 0.3}) {
    for (const double dt : {4e-6, 2e-6}) {
      for (const double phase : {0.2, 0.5, 0.9}) {
        const double mass = 3e-5, other = 5e-5, effective = mass * other / (mass + other), depth = phase * speed * dt;
        Scenario s;
        s.pair[Property::normalStiffness] = stiffness;
        s.pair[Property::restitution] = e;
        s.grain(mass, 1e-3, {2.5e-3 + 2 * speed * dt - depth, 0, 0}, {-speed, 0, 0});
        s.grain(other, 1.5e-3, {0, 0, 0});
        Simulation sim = s.start(dt);
        sim.advance(2);
        const double damping = 2 * dampingRatio(e, false) * std::sqrt(effective * stiffness);
        const double force = stiffness * depth + damping * speed * (0.5 + phase);  // N5
        const double expected = 0.5 * stiffness * depth * (depth - speed * dt) + force * force * dt * dt / (8 * effective);
        EXPECT_NEAR(sim.ledger().residual(), expected, 1e-6 * std::abs(expected) + 1e-20);
        if (e == 1) {
          EXPECT_NEAR(sim.ledger().residualFraction(), 1, 1e-6);
        }
      }
    }
  }
}

// Note (B.5): x = (u/α) sin αt e^{−ηt/2m*} until t = π/α.
TEST(LinearContact, FollowsTheDampedOscillator) {
  const double m1 = 3e-5, m2 = 1.1e-4, r1 = 1.3e-3, r2 = 2.2e-3, effective = m1 * m2 / (m1 + m2), e = 0.62;
  const double zeta = dampingRatio(e, true), omega = std::sqrt(stiffness / effective), alpha = omega * std::sqrt(1 - zeta * zeta);
  const double dt = pi / alpha / 400;
  Scenario s;
  s.model.contact.tension = true;
  s.pair[Property::normalStiffness] = stiffness;
  s.pair[Property::restitution] = e;
  const Vec3 n = Vec3(-0.2, 0.9, 0.4).normalized();
  s.grain(m1, r1, (r1 + r2 + 0.5 * dt * speed) * n, -speed * n);  // touches after half a step
  s.grain(m2, r2, Vec3::Zero());
  Simulation sim = s.start(dt);
  for (int k = 1; k <= 400; ++k) {
    sim.advance(1);
    const double t = (k - 0.5) * dt, x = speed / alpha * std::sin(alpha * t) * std::exp(-zeta * omega * t);
    const Snapshot now = look(sim);
    ASSERT_NEAR(r1 + r2 - (now.position[0] - now.position[1]).norm(), x, 1e-4 * speed / alpha) << "step " << k;
  }
  EXPECT_GT(sim.contacts().touching, 0u);
  sim.advance(2);
  EXPECT_EQ(sim.contacts().touching, 0u);  // parted at t = π/α, within a step
}

// MFiX DEM03: two grains of different density pressed between two planes, under gravity: two degrees of freedom, here with damping.
// The closed form is exp(At) of the linear system, by its eigenvectors.
TEST(LinearContact, TwoStackedSpheresBetweenPlates) {
  const double r = 5e-4, k = 1e3, height = 1.8e-3, g = 9.81, e = 0.8;
  const double volume = 4.0 / 3.0 * pi * r * r * r, m1 = 2e4 * volume, m2 = 1e4 * volume;
  Scenario s;
  s.model.gravity = {0, -g, 0};
  s.model.contact.tension = true;
  s.pair[Property::normalStiffness] = k;
  s.pair[Property::restitution] = e;
  s.grain(m1, r, {0, 4.5e-4, 0});
  s.grain(m2, r, {0, 13.5e-4, 0});
  s.plane({0, 0, 0}, {0, 1, 0});
  s.plane({0, height, 0}, {0, -1, 0});

  const auto damping = [&](double m) { return 2 * dampingRatio(e, true) * std::sqrt(m * k); };
  const double c1 = damping(m1), c2 = damping(m2), c12 = damping(m1 * m2 / (m1 + m2));
  Eigen::Matrix4d A;
  A << 0, 0, 1, 0, 0, 0, 0, 1, -2 * k / m1, k / m1, -(c1 + c12) / m1, c12 / m1, k / m2, -2 * k / m2, c12 / m2, -(c2 + c12) / m2;
  // Overlaps r − y1, 2r − (y2 − y1) and r − (H − y2).
  const Eigen::Vector4d b(0, 0, -g + (k * r - k * 2 * r) / m1, -g + (k * 2 * r - k * (r - height)) / m2);
  const Eigen::Vector4d rest = A.fullPivLu().solve(-b);
  const Eigen::EigenSolver<Eigen::Matrix4d> modes(A);
  const Eigen::Vector4cd amplitude =
      modes.eigenvectors().fullPivLu().solve((Eigen::Vector4d(4.5e-4, 13.5e-4, 0, 0) - rest).cast<std::complex<double>>());

  const double dt = 2e-7;  // ω Δt = 0.004: errors of 1e-6 of the amplitude
  Simulation sim = s.start(dt);
  for (int k2 = 1; k2 <= 40; ++k2) {
    sim.advance(100);
    const Eigen::Vector4cd grown = (modes.eigenvalues() * sim.time()).array().exp() * amplitude.array();
    const Eigen::Vector4d exact = rest + (modes.eigenvectors() * grown).real();
    const Snapshot now = look(sim);
    ASSERT_NEAR(now.position[0].y(), exact[0], 1e-9);
    ASSERT_NEAR(now.position[1].y(), exact[1], 1e-9);
    ASSERT_NEAR(now.velocity[0].y(), exact[2], 1e-5);
    ASSERT_NEAR(now.velocity[1].y(), exact[3], 1e-5);
  }
}

// Free fall is exact for velocity Verlet (positions to rounding); symplectic Euler's velocities lie half a step behind (−½ g Δt t).
TEST(FreeFlight, Falls) {
  const Vec3 g(0.3, -1, -9.81), x0(1, 2, 3), v0(4, -5, 6);
  for (const Integrator integrator : {Integrator::velocityVerlet, Integrator::symplecticEuler}) {
    Scenario s;
    s.model.integrator = integrator;
    s.model.gravity = g;
    s.model.domain = Box(Vec3::Constant(-100), Vec3::Constant(100));
    s.model.watch.travelLimit = 100;
    s.pair[Property::normalStiffness] = 1;
    s.pair[Property::restitution] = 1;
    s.grain(1e-5, 1e-3, x0, v0);
    Simulation sim = s.start(1e-3);
    sim.advance(1000);
    const double t = 1, lag = integrator == Integrator::velocityVerlet ? 0 : 0.5e-3 * t;
    const Snapshot now = look(sim);
    EXPECT_LT((now.position[0] - (x0 + t * v0 + (0.5 * t * t + lag) * g)).norm(), 1e-11);
    EXPECT_LT((now.velocity[0] - (v0 + t * g)).norm(), 1e-11);
  }
}

// A ball dropped from h rises to e²h, e⁴h, …. During a contact gravity changes the speed by g t_c, a height by 2 g t_c/v of itself.
TEST(FreeFlight, BouncesToHeightsThatFallByESquared) {
  for (const double e : {0.5, 0.9}) {
    const double r = 5e-3, m = 1.3e-3, k = 1e7, g = 9.81, h = 0.05, contact = contactDuration(k, m, e, false);
    Scenario s;
    s.model.gravity = {0, 0, -g};
    s.pair[Property::normalStiffness] = k;
    s.pair[Property::restitution] = e;
    s.grain(m, r, {0, 0, r + h});
    s.plane({0, 0, 0}, {0, 0, 1});
    Simulation sim = s.start(contact / 100);
    double expected = h, highest = 0, last = 1;
    int rises = 0;
    bool falling = true;
    while (rises < 3) {
      sim.advance(5);
      const Snapshot now = look(sim);
      const double v = now.velocity[0].z();
      highest = std::max(highest, now.position[0].z() - r);
      if (falling && v > 0 && last <= 0) {
        falling = false;
        highest = 0;
      } else if (!falling && v <= 0) {
        falling = true;
        ++rises;
        expected *= e * e;
        EXPECT_NEAR(highest, expected, 2 * g * contact / std::sqrt(2 * g * expected) * expected) << "bounce " << rises << ", e = " << e;
      }
      last = v;
    }
  }
}

}  // namespace
}  // namespace tsubu::sim::test
