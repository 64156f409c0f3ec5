#pragma once
// Walls with a will: walls of a mass that move under load along an axis (docs/physics.md, W4).
//
//   W4   M s″ = a·(Σ F + M g) + F₀ − c s′
//
// s is the way along the unit axis a, Σ F what grains do to the wall; a guide holds the wall against everything else and does no work. A
// piston or a falling plate has a mass and weight; a wall held at a constant force has a force and a damping, and no weight: at rest
// the grains carry exactly that force. The integrators are those of grains (I1, I2, I4–I6); loads are summed over the slabs in their order.

#include <vector>

#include "sim/ledger.h"
#include "sim/model.h"

namespace tsubu::sim {

/// What grains do to a wall in one step.
struct WallLoad {
  Vec3 force = Vec3::Zero();  ///< N, on the wall
  int contacts = 0;
};

/// One such wall. Every call names the integrator's scheme.
class MovingWall {
 public:
  MovingWall(const WallBody& body, std::size_t wall) : body_(body), wall_(wall), axis_(body.axis.normalized()) {}

  std::size_t wall() const { return wall_; }  ///< index into the walls of the model
  const WallBody& body() const { return body_; }
  const Vec3& axis() const { return axis_; }
  double way() const { return way_; }    ///< s, m
  double load() const { return load_; }  ///< N: a·ΣF
  int contacts() const { return contacts_; }

  /// m/s: what contacts see (I1, I2), and that of the present instant (load known).
  double speedSeen() const { return seen_; }
  double speedNow(double dt, const Scheme& scheme) const { return speed_ + scheme.behind * dt * acceleration_; }

  /// The load of the present instant is known.
  void feel(const WallLoad& load, const Vec3& gravity, double time, double dt, const Scheme& scheme);
  /// Takes a step, pushed for `kick` seconds and going for `dt`; returns how far it goes, m.
  double move(double kick, double dt, const Scheme& scheme);

  void account(double dt, const Scheme& scheme, const Vec3& gravity, Ledger& ledger) const;

 private:
  WallBody body_;
  std::size_t wall_;
  Vec3 axis_;
  double way_ = 0, speed_ = 0, seen_ = 0;  // speed_: at half steps where the scheme has them
  double acceleration_ = 0, load_ = 0;
  int contacts_ = 0;
  bool held_ = true;
  double push_ = 0;  // J: of what lets it go with a speed
  Tally work_, dissipated_;
};

/// The moving walls of a model, in the order of its walls.
std::vector<MovingWall> wallsUnderLoad(const Model& model);

/// Σ M s a, kg m: what changes of gravity act on (F1).
Vec3 massMoment(const std::vector<MovingWall>& walls);

}  // namespace tsubu::sim
