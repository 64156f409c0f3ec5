// At which order the integrators converge, measured on contacts that are smooth while they last: started compressed and watched for
// less than their duration, so that nothing begins or ends. docs/physics.md quotes the table that this program prints.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "verification/models.h"

namespace tsubu::sim::test {
namespace {

constexpr double k = 1000, span = 2e-3;  // s, of each run

/// Everything that moves, in one column: m, and m/s scaled by a millisecond.
Eigen::VectorXd stateAfter(const Scenario& scenario, double dt) {
  Scenario s = scenario;
  Simulation sim = s.start(dt);
  sim.advance(static_cast<std::uint64_t>(std::lround(span / dt)));
  const Snapshot now = look(sim);
  std::vector<double> values;
  for (std::size_t g = 0; g < now.grains(); ++g) {
    for (int axis = 0; axis < 3; ++axis) {
      values.push_back(now.position[g][axis]);
      values.push_back(1e-3 * now.velocity[g][axis]);
      if (!now.angularVelocity.empty()) values.push_back(1e-3 * now.radius[g] * now.angularVelocity[g][axis]);
    }
  }
  return Eigen::Map<Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

struct Order {
  double order, error;  // error at the finer of two steps, m
};
Order measuredOrder(const Scenario& s, Integrator integrator) {
  Scenario same = s;
  same.model.integrator = Integrator::velocityVerlet;  // the reference: steps sixty-four times finer
  const double coarse = span / 200, fine = span / 400;
  const Eigen::VectorXd exact = stateAfter(same, span / 25600);
  same.model.integrator = integrator;
  const double a = (stateAfter(same, coarse) - exact).norm(), b = (stateAfter(same, fine) - exact).norm();
  return {std::log2(a / b), b};
}

/// One grain held between two planes, compressed by a tenth of a millimetre, swinging to and fro.
Scenario squeezed(double e) {
  Scenario s;
  s.model.contact.tension = true;
  s.pair[Property::normalStiffness] = k;
  s.pair[Property::restitution] = e;
  s.grain(1e-4, 2e-3, {0, 0, 3e-5}, {0, 0, 0.05});
  s.plane({0, 0, -1.9e-3}, {0, 0, 1});
  s.plane({0, 0, 1.9e-3}, {0, 0, -1});
  return s;
}

/// The same, drawn sideways by gravity: tangential springs that stick, or slide under a small μ. It starts without slip: a slip in the
/// first step is met by a spring that belongs half a step earlier (velocity Verlet), see docs/physics.md.
Scenario squeezedSideways(double e, double mu, const std::string& rolling) {
  Scenario s = squeezed(e);
  s.model.contact.tangential = "spring";
  s.model.contact.rolling = rolling;
  s.pair[Property::friction] = mu;
  s.pair[Property::rollingFriction] = 0.5;
  s.model.grains[0].position = s.model.grains[0].velocity = Vec3::Zero();
  s.model.gravity = {15, -20, 0};
  return s;
}

/// Two unequal grains deep in an oblique contact, turning like one rigid body at first, by a tenth of a radian while they are watched. As
/// the spring drives them apart their orbit slows down and their spins do not: slip sets in smoothly.
Scenario turningPair(double e, double mu, const std::string& rolling) {
  Scenario s;
  s.model.contact = {"linear", "spring", rolling, true};
  s.pair[Property::normalStiffness] = k;
  s.pair[Property::restitution] = e;
  s.pair[Property::friction] = mu;
  s.pair[Property::rollingFriction] = 0.5;
  const Vec3 turn(30, -40, 60), x(3e-3, 3e-3, 2e-3);
  s.grain(4e-3, 2e-3, {0, 0, 0}, Vec3::Zero(), turn);
  s.grain(9e-3, 3e-3, x, turn.cross(x), turn);
  return s;
}

struct Case {
  const char* name;
  Scenario scenario;
  double euler, verlet;  ///< expected orders
  double luck = 0.15;    ///< how far velocity Verlet may be off: a sticking contact begins to slide somewhere within a step
};

// Order 1 and 2, for springs, dashpots, sticking and sliding alike.
TEST(Convergence, OrdersOfTheIntegrators) {
  const std::array cases{Case{"spring", squeezed(1), 1, 2},
                         Case{"spring and dashpot, e = 0.5", squeezed(0.5), 1, 2},
                         Case{"sticking", squeezedSideways(1, 100, "none"), 1, 2},
                         Case{"sticking, damped", squeezedSideways(0.5, 100, "none"), 1, 2},
                         Case{"sliding", squeezedSideways(0.5, 0.01, "none"), 1, 2, 0.7},
                         Case{"turning pair", turningPair(1, 0, "none"), 1, 2},
                         Case{"turning pair, sticking", turningPair(1, 100, "none"), 1, 2},
                         Case{"turning pair, damped", turningPair(0.9, 100, "none"), 1, 2},
                         Case{"turning pair, rolling type C", turningPair(0.9, 100, "elastic_plastic"), 1, 2}};
  fmt::print("  {:<32} {:>22} {:>22}\n", "", "symplectic Euler", "velocity Verlet");
  for (const Case& each : cases) {
    const Order euler = measuredOrder(each.scenario, Integrator::symplecticEuler), verlet = measuredOrder(each.scenario, Integrator::velocityVerlet);
    fmt::print("  {:<32} {:>10.2f} ({:.1e} m) {:>10.2f} ({:.1e} m)\n", each.name, euler.order, euler.error, verlet.order, verlet.error);
    EXPECT_NEAR(euler.order, each.euler, 0.15) << each.name;
    EXPECT_NEAR(verlet.order, each.verlet, each.luck) << each.name;
  }
}

}  // namespace
}  // namespace tsubu::sim::test
