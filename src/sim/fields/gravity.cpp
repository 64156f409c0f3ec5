#include "sim/fields/gravity.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/portable_math.h"

namespace tsubu::sim {

namespace {

struct Changed {
  const Vec3& before;
  double seconds;  // since the start of the change
  bool acts;

  Vec3 operator()(const GravityTurn& turn) const {
    const double angle = std::min(std::abs(turn.angularSpeed) * seconds, turn.angle);
    return portable::turnBy(std::copysign(angle, turn.angularSpeed), turn.axis.normalized()) * before;
  }
  Vec3 operator()(const GravityShake& shake) const {
    if (!acts) return before;
    return before + portable::sin(2 * std::numbers::pi * shake.frequency * seconds + shake.phase) * shake.amplitude;
  }
};

}  // namespace

Vec3 gravityAt(const Vec3& gravity, const std::vector<GravityChange>& changes, double t) {
  Vec3 g = gravity;
  for (const GravityChange& change : changes) {
    if (t < change.start) continue;
    g = std::visit(Changed{g, std::min(t, change.end) - change.start, t < change.end}, change.kind);
  }
  return g;
}

double strongestGravity(const Vec3& gravity, const std::vector<GravityChange>& changes) {
  double most = gravity.norm();
  for (const GravityChange& change : changes)
    if (const auto* shake = std::get_if<GravityShake>(&change.kind)) most += shake->amplitude.norm();
  return most;
}

Vec3 massMoment(const State& state) {
  Vec3 moment = Vec3::Zero();
  for (std::size_t g = 0; g < state.size(); ++g) {
    const GrainRow& row = state.rows[g];
    moment += Vec3(row.x, row.y, row.z) / row.inverseMass;
  }
  return moment;
}

GravityClock::GravityClock(const Vec3& gravity, std::vector<GravityChange> changes)
    : start_(gravity), changes_(std::move(changes)), now_(gravityAt(start_, changes_, 0)) {}

void GravityClock::moveTo(double t, const Vec3& moment) {
  const Vec3 next = gravityAt(start_, changes_, t);
  work_ -= 0.5 * (next - now_).dot(moment_ + moment);
  now_ = next;
  moment_ = moment;
}

}  // namespace tsubu::sim
