#include "sim/walls/moving_wall.h"

#include <cmath>

namespace tsubu::sim {

void MovingWall::feel(const WallLoad& load, const Vec3& gravity, double time, double dt, const Scheme& scheme) {
  load_ = load.force.dot(axis_);
  contacts_ = load.contacts;
  if (time < body_.start) return;
  const bool letGo = held_;
  if (letGo) {
    held_ = false;
    seen_ = body_.velocity;
    push_ = 0.5 * body_.mass * seen_ * seen_;
  }
  acceleration_ = (load_ + body_.force - body_.damping * seen_) / body_.mass + (body_.weight ? gravity.dot(axis_) : 0.0);
  if (letGo) speed_ = seen_ - scheme.behind * dt * acceleration_;
  work_.add(body_.force * seen_ * dt);
  dissipated_.add(body_.damping * seen_ * seen_ * dt);
}

double MovingWall::move(double kick, double dt, const Scheme& scheme) {
  const double old = speed_;
  speed_ += kick * acceleration_;
  const double goes = dt * (scheme.lead > 0 ? speed_ : old);  // explicit Euler goes by the old one
  way_ += goes;
  seen_ = speed_ + scheme.ahead * dt * acceleration_;
  return std::abs(goes);
}

void MovingWall::account(double dt, const Scheme& scheme, const Vec3& gravity, Ledger& ledger) const {
  const double speed = speedNow(dt, scheme);
  ledger.kineticWalls += 0.5 * body_.mass * speed * speed;
  if (body_.weight) ledger.gravitational -= body_.mass * gravity.dot(axis_) * way_;
  ledger.workWalls += push_ + work_.now(scheme.lead);
  ledger.dissipatedDrag += dissipated_.now(scheme.lead);
}

std::vector<MovingWall> wallsUnderLoad(const Model& model) {
  std::vector<MovingWall> moving;
  for (std::size_t w = 0; w < model.walls.size(); ++w)
    if (model.walls[w].body) moving.emplace_back(*model.walls[w].body, w);
  return moving;
}

Vec3 massMoment(const std::vector<MovingWall>& walls) {
  Vec3 moment = Vec3::Zero();
  for (const MovingWall& wall : walls)
    if (wall.body().weight) moment += wall.body().mass * wall.way() * wall.axis();
  return moment;
}

}  // namespace tsubu::sim
