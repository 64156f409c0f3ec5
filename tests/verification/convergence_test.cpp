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

constexpr std::array integrators{Integrator::explicitEuler,      Integrator::symplecticEuler, Integrator::leapfrog,
                                 Integrator::centralDifferences, Integrator::velocityVerlet,  Integrator::rungeKutta};

struct Order {
  double order, error;  // error at the finer of two steps, m
};
/// `exact`: the state at the end.
Order measuredOrder(const Scenario& s, const Eigen::VectorXd& exact, Integrator integrator) {
  Scenario same = s;
  same.model.integrator = integrator;
  const double a = (stateAfter(same, span / 200) - exact).norm(), b = (stateAfter(same, span / 400) - exact).norm();
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

/// The same with Hertz's law: the stiffness changes by a third to either side while it swings.
Scenario squeezedHertz(double e) {
  Scenario s = squeezed(e);
  s.model.contact.normal = "hertz";
  s.model.materials[0].values[Property::youngModulus] = 2e6;
  s.model.materials[0].values[Property::poissonRatio] = 0.3;
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
  std::array<double, 6> orders;  ///< expected, in the order of `integrators`
  double luck = 0.2;             ///< how far they may be off: a sticking contact begins to slide somewhere within a step
};

TEST(Convergence, OrdersOfTheIntegrators) {
  const std::array cases{Case{"spring", squeezed(1), {1, 1, 2, 2, 2, 4}},
                         Case{"spring and dashpot, e = 0.5", squeezed(0.5), {1, 1, 1, 1, 2, 4}},
                         Case{"Hertz", squeezedHertz(1), {1, 1, 2, 2, 2, 4}},
                         Case{"Hertz and dashpot, e = 0.5", squeezedHertz(0.5), {1, 1, 1, 1, 2, 4}},
                         Case{"sticking", squeezedSideways(1, 100, "none"), {1, 1, 2, 2, 2, 4}},
                         Case{"sticking, damped", squeezedSideways(0.5, 100, "none"), {1, 1, 1, 1, 2, 4}},
                         Case{"sliding", squeezedSideways(0.5, 0.01, "none"), {1, 1, 1, 1, 2, 2}, 0.7},
                         Case{"turning pair", turningPair(1, 0, "none"), {1, 1, 2, 2, 2, 4}},
                         Case{"turning pair, sticking", turningPair(1, 100, "none"), {1, 1, 1, 1, 2, 4}},
                         Case{"turning pair, damped", turningPair(0.9, 100, "none"), {1, 1, 1, 1, 2, 4}},
                         Case{"turning pair, rolling type C", turningPair(0.9, 100, "elastic_plastic"), {1, 1, 1, 1, 2, 4}}};
  fmt::print("| contact |");
  for (const Integrator integrator : integrators) fmt::print(" {} |", schemeOf(integrator).name);
  fmt::print("\n");
  for (const Case& each : cases) {
    Scenario reference = each.scenario;
    reference.model.integrator = Integrator::rungeKutta;
    const Eigen::VectorXd exact = stateAfter(reference, span / 12800);
    fmt::print("| {} |", each.name);
    for (std::size_t n = 0; n < integrators.size(); ++n) {
      const Order order = measuredOrder(each.scenario, exact, integrators[n]);
      fmt::print(" {:.2f} ({:.1e} m) |", order.order, order.error);
      EXPECT_NEAR(order.order, each.orders[n], each.luck) << each.name << ", " << schemeOf(integrators[n]).name;
    }
    fmt::print("\n");
  }
}

}  // namespace
}  // namespace tsubu::sim::test
