#include "sim/walls/motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/portable_math.h"

namespace tsubu::sim {

namespace {

constexpr double tau = 2 * std::numbers::pi;

/// Pose and twist of one part at the time s on its own clock. The twist's origin is the point about which it turns.
struct State {
  Pose pose;
  Twist twist;
};

State turned(const Vec3& point, const Vec3& axis, double angle, double angularSpeed) {
  const Vec3 unit = axis.normalized();
  State state;
  state.pose.rotation = portable::turnBy(angle, unit);
  state.pose.translation = point - state.pose.rotation * point;
  state.twist = {Vec3::Zero(), angularSpeed * unit, point};
  return state;
}

State stateOf(const Translation& m, double s) {
  State state;
  state.pose.translation = s * m.velocity;
  state.twist.velocity = m.velocity;
  return state;
}

State stateOf(const Rotation& m, double s) { return turned(m.point, m.axis, m.angularSpeed * s, m.angularSpeed); }

State stateOf(const Oscillation& m, double s) {
  const double phase = tau * m.frequency * s + m.phase;
  State state;
  state.pose.translation = (portable::sin(phase) - portable::sin(m.phase)) * m.amplitude;
  state.twist.velocity = tau * m.frequency * portable::cos(phase) * m.amplitude;
  return state;
}

State stateOf(const Rocking& m, double s) {
  const double phase = tau * m.frequency * s + m.phase;
  return turned(m.point, m.axis, m.amplitude * (portable::sin(phase) - portable::sin(m.phase)),
                m.amplitude * tau * m.frequency * portable::cos(phase));
}

State stateAt(const MotionPart& part, double t) {
  const double s = std::clamp(t, part.start, part.end) - part.start;
  State state = std::visit([s](const auto& kind) { return stateOf(kind, s); }, part.kind);
  if (t < part.start || t >= part.end) state.twist = {};
  return state;
}

bool moves(const MotionPart& part) {
  if (!(part.end > part.start)) return false;
  struct {
    bool operator()(const Translation& m) const { return !m.velocity.isZero(0); }
    bool operator()(const Rotation& m) const { return m.angularSpeed != 0; }
    bool operator()(const Oscillation& m) const { return !m.amplitude.isZero(0) && m.frequency != 0; }
    bool operator()(const Rocking& m) const { return m.amplitude != 0 && m.frequency != 0; }
  } test;
  return std::visit(test, part.kind);
}

/// Bounds of one part: how fast it translates and turns, about which point, and how far it carries a point without turning it.
struct Bound {
  double speed = 0;         ///< m/s
  double angularSpeed = 0;  ///< rad/s
  double shift = 0;         ///< m
  Vec3 point = Vec3::Zero();
  bool turns = false;
};

Bound boundOf(const MotionPart& part, double t0, double t1) {
  const double seconds = std::clamp(t1, part.start, part.end) - part.start;
  const bool acts = t1 >= part.start && t0 < part.end;
  struct {
    double s;
    Bound operator()(const Translation& m) const { return {m.velocity.norm(), 0, m.velocity.norm() * s, Vec3::Zero(), false}; }
    Bound operator()(const Rotation& m) const { return {0, std::abs(m.angularSpeed), 0, m.point, true}; }
    Bound operator()(const Oscillation& m) const {
      return {m.amplitude.norm() * tau * std::abs(m.frequency), 0, 2 * m.amplitude.norm(), Vec3::Zero(), false};
    }
    Bound operator()(const Rocking& m) const { return {0, std::abs(m.amplitude * tau * m.frequency), 0, m.point, true}; }
  } visitor{seconds};
  Bound bound = std::visit(visitor, part.kind);
  if (!acts) bound.speed = bound.angularSpeed = 0;
  return bound;
}

}  // namespace

WallMotion::WallMotion(std::vector<MotionPart> parts) : parts_(std::move(parts)) {
  for (const MotionPart& part : parts_) {
    const Vec3* axis = nullptr;
    if (const auto* rotation = std::get_if<Rotation>(&part.kind)) axis = &rotation->axis;
    if (const auto* rocking = std::get_if<Rocking>(&part.kind)) axis = &rocking->axis;
    if (axis && !(axis->norm() > 0)) throw Error(ErrorKind::scene, "The axis about which a wall turns must not be zero.");
    if (!(part.end >= part.start)) throw Error(ErrorKind::scene, "The motion of a wall ends before it starts.");
  }
}

bool WallMotion::still() const { return std::none_of(parts_.begin(), parts_.end(), moves); }

Pose WallMotion::at(double t) const {
  Pose pose;
  for (const MotionPart& part : parts_) {
    const Pose next = stateAt(part, t).pose;
    pose.translation = next.toWorld(pose.translation);
    pose.rotation = (next.rotation * pose.rotation).normalized();
  }
  return pose;
}

// A later part carries the earlier motion along: with x' = R x + p, the velocity R v(x) adds to the part's own at x'. The sum is
// collected at the place to which the origin of the wall has come.
Twist WallMotion::twistAt(double t) const {
  Twist total;
  for (const MotionPart& part : parts_) {
    const State next = stateAt(part, t);
    const Vec3 origin = next.pose.toWorld(total.origin);
    total.velocity = next.pose.rotation * total.velocity + next.twist.at(origin);
    total.angularVelocity = next.pose.rotation * total.angularVelocity + next.twist.angularVelocity;
    total.origin = origin;
  }
  return total;
}

double WallMotion::maxSpeed(const Box& local, double t0, double t1) const {
  if (local.isEmpty()) return 0;
  // Every point stays within a ball; each part may move the ball and adds the speed of its fastest point.
  const bool bounded = local.sizes().allFinite();
  Vec3 centre = bounded ? Vec3(local.center()) : Vec3(Vec3::Zero());
  double radius = bounded ? 0.5 * local.diagonal().norm() : std::numeric_limits<double>::infinity(), speed = 0;
  for (const MotionPart& part : parts_) {
    const Bound bound = boundOf(part, t0, t1);
    const double arm = (centre - bound.point).norm() + radius;
    speed += bound.speed + (bound.angularSpeed > 0 ? bound.angularSpeed * arm : 0);
    if (bound.turns) {
      centre = bound.point;  // anywhere on the circles about the point
      radius = arm;
    } else {
      radius += bound.shift;
    }
  }
  return speed;
}

}  // namespace tsubu::sim
