// One collision of Hertz and Mindlin, at parameters drawn at random: unequal spheres of unequal materials, oblique and spinning, and a
// sphere on the face, edge and corner of a cube that stands or moves. The answer is known from an integration that shares no line with the
// program: the equations N6–N8, T0–T4, T7, T8 and R3–R5 of docs/physics.md in steps fifty times finer.

#include <functional>
#include <optional>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "verification/models.h"
#include "verification/shapes.h"

namespace tsubu::sim::test {
namespace {

struct Ball {
  double mass, radius, young, poisson;
  Vec3 x, v, w;
};
struct Pair {
  double restitution, friction, rolling;  // 0: free
  bool tension;
};
/// What a ball meets: another ball, or the nearest point of a body that cannot be moved.
using Nearest = std::function<Vec3(const Vec3&)>;

/// The balls after `span`. `a` and `b` are changed; with `nearest` b stands for the body: its materials count, its mass does not.
void integrate(Ball& a, Ball& b, const Nearest& nearest, const Pair& pair, double span, double dt) {
  const double perMass = nearest ? 0 : 1 / b.mass, mass = 1 / (1 / a.mass + perMass);
  const double radius = nearest ? a.radius : 1 / (1 / a.radius + 1 / b.radius);
  const auto shear = [](const Ball& ball) { return ball.young / (2 * (1 + ball.poisson)); };
  const double E = 1 / ((1 - a.poisson * a.poisson) / a.young + (1 - b.poisson * b.poisson) / b.young);
  const double G = 1 / ((2 - a.poisson) / shear(a) + (2 - b.poisson) / shear(b));
  const double zeta = dampingRatio(pair.restitution, pair.tension);
  const double inertiaA = 0.4 * a.mass * a.radius * a.radius, inertiaB = 0.4 * b.mass * b.radius * b.radius;
  const double rollingInertia = 3.5 / (1 / inertiaA + (nearest ? 0 : 1 / inertiaB));
  Vec3 spring = Vec3::Zero(), moment = Vec3::Zero(), before = Vec3::Zero();  // on a
  double stiffnessBefore = 0;
  for (double t = 0; t < span; t += dt) {
    const Vec3 other = nearest ? nearest(a.x) : b.x;
    const double distance = (a.x - other).norm(), overlap = a.radius + (nearest ? 0 : b.radius) - distance;
    if (overlap > 0) {
      const Vec3 n = (a.x - other) / distance;
      const double share = distance / (a.radius + (nearest ? 0 : b.radius)), armA = share * a.radius, armB = nearest ? 0 : share * b.radius;
      const Vec3 relative = a.v - (nearest ? Vec3(Vec3::Zero()) : b.v);
      const double separation = relative.dot(n);
      const Vec3 slip = relative - separation * n - (armA * a.w + armB * b.w).cross(n);
      const double S = 2 * E * std::sqrt(radius * overlap), eta = 2 * std::sqrt(5.0 / 6) * zeta * std::sqrt(S * mass);
      double normal = 2.0 / 3 * S * overlap - eta * separation;
      if (!pair.tension) normal = std::max(0.0, normal);

      const double k = 4 * G / E * S;
      if (stiffnessBefore > 0) {
        const Vec3 mean = nearest ? Vec3(0.5 * a.w) : Vec3((a.radius * a.w + b.radius * b.w) / (a.radius + b.radius));
        const double eased = std::min(1.0, k / stiffnessBefore);
        const Eigen::Quaterniond turn = Eigen::AngleAxisd(mean.dot(n) * dt, n) * Eigen::Quaterniond::FromTwoVectors(before, n);
        spring = eased * (turn * spring);
        moment = eased * (turn * moment);
      }
      spring -= k * dt * slip;
      const Vec3 trial = spring - std::sqrt(2.0 / 7) * eta * std::sqrt(k / S) * slip;
      const double keep = std::min(1.0, pair.friction * std::abs(normal) / std::max(trial.norm(), 1e-300));
      spring *= keep;
      before = n;
      stiffnessBefore = k;

      const Vec3 spin = a.w - (nearest ? Vec3(Vec3::Zero()) : b.w), roll = spin - spin.dot(n) * n;
      const double stiff = 2.25 * S * std::pow(pair.rolling * radius, 2), most = pair.rolling * radius * std::abs(normal);
      moment -= stiff * dt * roll;
      const bool yields = moment.norm() > most;
      if (yields) moment *= most / std::max(moment.norm(), 1e-300);
      const Vec3 resistance = yields ? moment : Vec3(moment - 0.6 * std::sqrt(rollingInertia * stiff) * roll);

      const Vec3 force = normal * n + keep * trial, couple = n.cross(keep * trial);
      a.v += dt / a.mass * force;
      a.w += dt / inertiaA * (resistance - armA * couple);
      if (!nearest) {
        b.v -= dt / b.mass * force;
        b.w += dt / inertiaB * (-resistance - armB * couple);
      }
    } else {
      spring.setZero();
      moment.setZero();
      stiffnessBefore = 0;
    }
    a.x += dt * a.v;
    b.x += dt * b.v;
  }
}

Vec3 direction(Random& random) {
  for (;;) {
    const Vec3 d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    if (d.norm() > 0.1 && d.norm() < 1) return d.normalized();
  }
}

Ball someBall(Random& random) {
  Ball ball;
  ball.radius = 1e-3 * std::pow(10.0, random.uniform(-0.3, 0.7));
  ball.mass = random.uniform(800, 8000) * 4.0 / 3 * pi * std::pow(ball.radius, 3);
  ball.young = 1e8 * std::pow(10.0, random.uniform(-1, 1));
  ball.poisson = random.uniform(0, 0.45);
  ball.x = ball.v = Vec3::Zero();
  ball.w = random.uniform(-1, 1) / ball.radius * direction(random);  // up to 1 m/s at the surface
  return ball;
}

Pair somePair(Random& random, int n) {
  return {random.uniform(0.2, 1), 0.05 * std::pow(30.0, random.uniform()), n % 4 < 2 ? 0.0 : random.uniform(0.02, 0.5), n % 2 == 0};
}

/// Hertz: 2.8683 (m*²/(R* E*² v))^{1/5}.
double duration(const Ball& a, const Ball& b, bool wall, double speed) {
  const double E = 1 / ((1 - a.poisson * a.poisson) / a.young + (1 - b.poisson * b.poisson) / b.young);
  const double R = wall ? a.radius : 1 / (1 / a.radius + 1 / b.radius), m = wall ? a.mass : 1 / (1 / a.mass + 1 / b.mass);
  return 2.8683 * std::pow(m * m / (R * E * E * speed), 0.2);
}

struct Scene : Scenario {
  Scene(const Pair& values) {
    model.contact = {"hertz", "mindlin", values.rolling > 0 ? "elastic_plastic" : "none", values.tension};
    model.domain = Box(Vec3::Constant(-1), Vec3::Constant(1));
    pair[Property::restitution] = values.restitution;
    pair[Property::friction] = values.friction;
    pair[Property::rollingFriction] = values.rolling;
  }
  void ball(const Ball& ball, const Vec3& drift = Vec3::Zero()) {
    grain(ball.mass, ball.radius, ball.x, ball.v + drift, ball.w);
    elastic(ball);
  }
  void elastic(const Ball& ball) {
    model.materials.back().values[Property::youngModulus] = ball.young;
    model.materials.back().values[Property::poissonRatio] = ball.poisson;
  }
};

void expectSame(const Snapshot& now, std::size_t grain, const Ball& ball, const Vec3& drift, double speed) {
  EXPECT_LT((now.velocity[grain] - drift - ball.v).norm(), 5e-4 * speed);
  EXPECT_LT((now.angularVelocity[grain] - ball.w).norm() * ball.radius, 1.2e-3 * speed);
}

TEST(Collision, OfUnequalSpinningSpheres) {
  for (int n = 0; n < 40; ++n) {
    SCOPED_TRACE(n);
    Random random(17, 1, static_cast<std::uint64_t>(n));
    Ball a = someBall(random), b = someBall(random);
    const Pair pair = somePair(random, n);
    const Vec3 towards = direction(random);
    const double speed = random.uniform(0.2, 2), dt = duration(a, b, false, 0.5 * speed) / 1000;
    b.x = a.x + (a.radius + b.radius + 1e-9) * towards;
    a.v = Vec3(0.3, -0.2, 0.5);
    Vec3 along = direction(random);
    if (along.dot(towards) > -0.3) along = (along - (along.dot(towards) + 0.5) * towards).normalized();  // b approaches
    b.v = a.v + speed * along;

    Scene s(pair);
    s.ball(a);
    s.ball(b);
    Simulation sim = s.start(dt);
    const Ledger start = sim.ledger();
    sim.advance(6000);
    integrate(a, b, {}, pair, 6000 * dt, dt / 50);
    const Snapshot now = look(sim);
    expectSame(now, 0, a, Vec3::Zero(), speed);
    expectSame(now, 1, b, Vec3::Zero(), speed);
    const Ledger end = sim.ledger();
    EXPECT_EQ(sim.contacts().touching, 0);
    EXPECT_LT((end.momentum - start.momentum).norm(), 1e-12 * start.momentum.norm());
    EXPECT_LT((end.angularMomentumRest - start.angularMomentumRest).norm(), 1e-11 * start.angularMomentumRest.norm());
    EXPECT_LT(end.residualFraction(), 1e-3);
    EXPECT_LT(end.mechanical(), start.mechanical() * (1 + 1e-5));
  }
}

/// A ball that starts `from` the centre of a cube of half a length h, in units of h, and reaches it at about `at`.
struct Meeting {
  const char* what;
  Vec3 at, normal;
};

TEST(Collision, OfASphereWithFaceEdgeAndCornerOfACube) {
  const double h = 0.02;
  const Nearest nearest = [h](const Vec3& x) { return Vec3(x.cwiseMax(-h).cwiseMin(h)); };
  const Meeting meetings[] = {{"face", {0.3, -0.2, 1}, {0, 0, 1}},
                              {"edge", {1, -0.1, 1}, Vec3(1, 0, 0.7).normalized()},
                              {"corner", {-1, 1, 1}, Vec3(-0.5, 1, 0.8).normalized()},
                              {"face, then edge", {0.9999, 0.3, 1}, {0, 0, 1}}};
  for (const Meeting& meeting : meetings) {
    for (int n = 0; n < 12; ++n) {
      SCOPED_TRACE(fmt::format("{} {}", meeting.what, n));
      Random random(18, 1, static_cast<std::uint64_t>(n));
      Ball ball = someBall(random), cube = someBall(random);
      const Pair pair = somePair(random, n);
      const double speed = random.uniform(0.2, 2), dt = duration(ball, cube, true, 0.5 * speed) / 1000;
      cube.v = cube.w = Vec3::Zero();
      const Vec3 drift = n % 3 == 0 ? Vec3::Zero() : Vec3(0.4 * direction(random));
      ball.x = h * meeting.at + (ball.radius + 1e-9) * meeting.normal;
      Vec3 along = direction(random);
      if (along.dot(meeting.normal) > -0.3) along = (along - (along.dot(meeting.normal) + 0.5) * meeting.normal).normalized();
      ball.v = speed * along;

      Scene s(pair);
      s.ball(ball, drift);
      Wall& wall = s.wall(Surface(test::cube(h)), WallMotion({{Translation{drift}, 0, std::numeric_limits<double>::infinity()}}));
      wall.material = static_cast<std::uint16_t>(s.model.materials.size());
      s.model.materials.push_back({"cube", {}});
      s.elastic(cube);
      Simulation sim = s.start(dt);
      sim.advance(6000);
      integrate(ball, cube, nearest, pair, 6000 * dt, dt / 50);
      expectSame(look(sim), 0, ball, drift, speed);
      EXPECT_EQ(sim.contacts().touching, 0);
      EXPECT_LT(sim.ledger().residualFraction(), 1e-3);
    }
  }
}

}  // namespace
}  // namespace tsubu::sim::test
