// Grains on walls made of triangles, and on walls that move, through the whole simulation.

#include <gtest/gtest.h>

#include "verification/models.h"
#include "verification/shapes.h"

namespace tsubu::sim::test {
namespace {

constexpr double k = 2e4, mass = 2e-4, radius = 2.5e-3, g = 9.81, sink = mass * g / k;

Scenario frictional(double mu, double e) {
  Scenario s;
  s.model.contact = {"linear", mu > 0 ? "spring" : "none", "none", false};
  s.model.gravity = {0, 0, -g};
  s.model.domain = Box(Vec3::Constant(-1), Vec3::Constant(1));
  s.pair[Property::normalStiffness] = k;
  s.pair[Property::restitution] = e;
  s.pair[Property::friction] = mu;
  return s;
}

std::vector<Vec3> trajectory(Simulation& sim, int looks, std::uint64_t steps) {
  std::vector<Vec3> path;
  for (int n = 0; n < looks; ++n) {
    sim.advance(steps);
    path.push_back(look(sim).position[0]);
  }
  return path;
}

// A sphere that bounces, slides and rolls over a plane cannot tell into how many triangles it is cut.
TEST(Seams, TriangulationOfAPlaneIsNotFelt) {
  const auto run = [](Surface surface) {
    Scenario s = frictional(0.3, 0.6);
    s.grain(mass, radius, {-0.04, -0.013, radius + 3e-4}, {0.5, 0.17, 0}, {3, -20, 40});
    s.wall(std::move(surface));
    Simulation sim = s.start(4e-6);
    return trajectory(sim, 50, 800);
  };
  const std::vector<Vec3> plane = run(Surface::plane("plane", Vec3::Zero(), Vec3::UnitZ()));
  EXPECT_GT(plane.back().x(), 0.0);
  struct Cut {
    int nx, ny;
    double shake;
  };
  for (const Cut cut : {Cut{1, 1, 0}, Cut{5, 5, 0.3}, Cut{50, 50, 0.3}}) {
    const std::vector<Vec3> path = run(Surface(rectangle(-0.1, 0.11, -0.1, 0.12, 0, cut.nx, cut.ny, cut.shake)));
    for (std::size_t n = 0; n < path.size(); ++n) ASSERT_LT((path[n] - plane[n]).norm(), 1e-9) << 2 * cut.nx * cut.ny << " triangles";
  }
}

// Over the edge of a cube a grain pivots on one point: without friction and damping nothing is lost, for either integrator to its
// order; with friction the account closes, though the contact wanders from face to edge.
TEST(Edges, RollingOverAnEdgeKeepsTheAccount) {
  for (const double mu : {0.0, 0.4}) {
    for (const double speed : {0.02, 0.12}) {
      Scenario s = frictional(mu, 1);
      s.model.gravity = {0, 0, -g};
      s.grain(mass, radius, {0.0199, 7e-4, 0.02 + radius - sink}, {speed, 0, 0}, {0, mu > 0 ? speed / radius : 0, 0});
      s.wall(Surface(cube(0.02)));
      Simulation sim = s.start(2e-6);
      for (int n = 0; n < 40; ++n) {
        sim.advance(1250);
        const Ledger now = sim.ledger();
        EXPECT_NEAR(now.residual(), 0, 1e-6 * mass * g * radius) << "mu " << mu << ", t = " << sim.time();
        EXPECT_GE(now.dissipatedFriction, -1e-12 * mass * g * radius);
      }
      const Snapshot now = look(sim);
      EXPECT_LT(now.position[0].z(), 0.02);  // it fell
      EXPECT_NEAR(now.position[0].y(), 7e-4, 1e-9);
    }
  }
}

// With no friction a sphere on an edge is a pendulum upside down: from the top it leaves the edge at cos θ = 2/3 (the bead on a
// sphere), when it starts from rest.
TEST(Edges, LeavesTheEdgeLikeABeadOnASphere) {
  const double stiff = 2e6, start = 0.02;
  Scenario s = frictional(0, 0.5);
  s.pair[Property::normalStiffness] = stiff;
  s.grain(mass, radius, Vec3(0.02, 0, 0.02) + (radius - mass * g / stiff) * Vec3(std::sin(start), 0, std::cos(start)));
  s.wall(Surface(cube(0.02)));
  Simulation sim = s.start(4e-7);
  double angle = 0;
  for (int n = 0, apart = 0; n < 20000 && apart < 100; ++n) {
    sim.advance(50);
    const Vec3 x = look(sim).position[0] - Vec3(0.02, 0, 0.02);
    apart = sim.contacts().touching == 0 ? apart + 1 : 0;
    if (apart == 0) angle = std::atan2(x.x(), x.z());
  }
  EXPECT_NEAR(std::cos(angle), 2.0 / 3.0, 2e-3);
}

// In a cone of more and more facets the way of a grain tends to a limit, with errors that fall as 1/n², as the geometry's do.
TEST(Facets, ConesOfManyFacetsAgree) {
  const auto endOf = [](int facets) {
    Scenario s = frictional(0.4, 0.5);
    const double scale = 1 / std::cos(pi / facets), start = 0.03, slope = std::sqrt(0.5);
    s.wall(Surface(frustum(0.002 * scale, 0, 0.1 * scale, 0.098, facets)));
    // On the middle of a facet of the 45° cone, at rest, and let go across the slope.
    s.grain(mass, radius, {start - radius * slope, 0, start - 0.002 + radius * slope}, {0, 0.1, 0});
    Simulation sim = s.start(4e-6);
    sim.advance(10000);
    const Ledger end = sim.ledger();
    EXPECT_LT(end.residualFraction(), 1e-3) << facets;
    EXPECT_GE(end.dissipatedFriction, 0);
    return look(sim).position[0];
  };
  const Vec3 limit = endOf(800);
  const double coarse = (endOf(10) - limit).norm(), middle = (endOf(50) - limit).norm(), fine = (endOf(200) - limit).norm();
  EXPECT_LT(coarse, 0.1 * radius);  // of ten facets it sees only one
  EXPECT_LT(middle, coarse);
  EXPECT_LT(fine, middle / 4);
}

// A sheet without thickness has two sides, and grains on both bounce off the same triangles.
TEST(Sheets, BothSidesHold) {
  Scenario s = frictional(0, 1);
  s.model.gravity = Vec3::Zero();
  s.grain(mass, radius, {0.001, 0.002, 0.004}, {0, 0, -0.3});
  s.grain(mass, radius, {0.012, -0.003, -0.005}, {0, 0, 0.3});
  s.wall(Surface(rectangle(-0.02, 0.02, -0.02, 0.02, 0, 1, 1)));
  Simulation sim = s.start(5e-6);
  sim.advance(6000);
  const Snapshot now = look(sim);
  EXPECT_NEAR(now.velocity[0].z(), 0.3, 1e-4);
  EXPECT_NEAR(now.velocity[1].z(), -0.3, 1e-4);
  EXPECT_EQ(sim.counts().lost, 0u);
}

// A ball laid on a conveyor of speed V slides until it rolls at 2V/7. The belt's work is μ m g V · 2V/(7μg) = 2/7 m V², of which half
// is lost to sliding and half is the ball's motion.
TEST(MovingWalls, ConveyorCarriesABall) {
  const double V = 0.4, mu = 0.3;
  for (const bool mesh : {false, true}) {
    Scenario s = frictional(mu, 0.5);
    s.grain(mass, radius, {0, 0, radius - sink});
    const WallMotion motion({{Translation{{V, 0, 0}}, 0, std::numeric_limits<double>::infinity()}});
    if (mesh)
      s.wall(Surface(rectangle(-0.3, 0.1, -0.1, 0.1, 0, 3, 3, 0.2)), motion);
    else
      s.plane(Vec3::Zero(), Vec3::UnitZ(), motion);
    Simulation sim = s.start(4e-6);
    sim.advance(static_cast<std::uint64_t>(2 * 2 * V / (7 * mu * g) / 4e-6));
    const Snapshot now = look(sim);
    EXPECT_NEAR(now.velocity[0].x(), 2 * V / 7, 1e-3 * V);
    EXPECT_NEAR(now.angularVelocity[0].y() * radius, -5 * V / 7, 1e-3 * V);
    const Ledger end = sim.ledger();
    EXPECT_NEAR(end.workWalls, 2.0 / 7 * mass * V * V, 2e-3 * mass * V * V);
    EXPECT_NEAR(end.kinetic(), mass * V * V / 7, 2e-3 * mass * V * V);
    EXPECT_NEAR(end.dissipated(), mass * V * V / 7, 2e-3 * mass * V * V);
    EXPECT_LT(end.residualFraction(), 1e-4);
  }
}

// A ball on a turntable rolls in circles of 2/7 of the turning rate (the classic that only the right slip velocity gives): with
// angular speed Ω of the table the ball's velocity turns with 2/7 Ω.
TEST(MovingWalls, BallOnATurntable) {
  const double table = 5, v = 0.02;
  Scenario s = frictional(1, 0.5);
  s.plane(Vec3::Zero(), Vec3::UnitZ(),
          WallMotion({{Rotation{Vec3::Zero(), Vec3::UnitZ(), table}, 0, std::numeric_limits<double>::infinity()}}));
  // Rolling on the table at (ρ, 0): v − Ω ẑ × x = r ω × ẑ-part. Start with the rolling spin for velocity (0, v, 0).
  const double rho = 0.03;
  const Vec3 slip = Vec3(0, v - table * rho, 0);
  s.grain(mass, radius, {rho, 0, radius - sink}, {0, v, 0}, Vec3::UnitZ().cross(slip) / radius);
  Simulation sim = s.start(4e-6);
  sim.advance(100000);
  const double t = sim.time(), turn = 2.0 / 7 * table * t;
  const Vec3 velocity = look(sim).velocity[0];
  EXPECT_NEAR(velocity.head<2>().norm(), v, 5e-3 * v);
  EXPECT_NEAR(std::atan2(velocity.y(), velocity.x()), 0.5 * pi + turn, 1e-2);
  EXPECT_LT(sim.ledger().residualFraction(), 1e-3);
}

// A grain on a plate that shakes gently stays on it and goes where it goes; the plate's work is what the grain's account shows.
TEST(MovingWalls, ShakenPlateCarriesAGrain) {
  const double amplitude = 5e-4, frequency = 15;  // acceleration 0.45 g
  for (const bool mesh : {false, true}) {
    Scenario s = frictional(0.5, 0.3);
    s.grain(mass, radius, {0, 0, radius - sink});
    const WallMotion motion({{Oscillation{{0, 0, amplitude}, frequency, 0.5 * pi}, 0, std::numeric_limits<double>::infinity()}});
    if (mesh)
      s.wall(Surface(rectangle(-0.01, 0.01, -0.01, 0.01, 0, 1, 1)), motion);
    else
      s.plane(Vec3::Zero(), Vec3::UnitZ(), motion);
    Simulation sim = s.start(4e-6);
    for (int n = 0; n < 100; ++n) {
      sim.advance(500);
      const double plate = amplitude * (std::cos(2 * pi * frequency * sim.time()) - 1);
      ASSERT_NEAR(look(sim).position[0].z() - radius, plate, 2 * sink);
    }
    EXPECT_LT(sim.ledger().residualFraction(), 2e-3);
  }
}

// A ball in a turning drum of few facets: it is thrown from crease to crease, friction drives it, and the account closes to second
// order in the step.
TEST(MovingWalls, DrumKeepsTheAccount) {
  const auto residual = [](double dt) {
    Scenario s = frictional(0.4, 0.5);
    s.model.gravity = {0, -g, 0};
    s.wall(Surface(frustum(0.05, -0.05, 0.05, 0.05, 20)), WallMotion({{Rotation{Vec3::Zero(), Vec3::UnitZ(), 10.0}, 0, 100}}));
    s.grain(mass, radius, {0, -0.05 * std::cos(pi / 20) + radius, 0});
    Simulation sim = s.start(dt);
    for (int n = 0; n < 25; ++n) {
      sim.advance(static_cast<std::uint64_t>(0.02 / dt));
      sim.ledger();
    }
    EXPECT_GT(sim.ledger().workWalls, 0);
    EXPECT_EQ(sim.counts().lost, 0u);
    return sim.ledger().residualFraction();
  };
  const double coarse = residual(4e-6), fine = residual(1e-6);
  EXPECT_LT(coarse, 2e-3);
  EXPECT_LT(fine, coarse / 8);
}

}  // namespace
}  // namespace tsubu::sim::test
