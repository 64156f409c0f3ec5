#pragma once
// Gravity that changes in time (docs/physics.md, F1).
//
//   F1   g(t): every change in turn;  dW/dt = −ġ·Σ m x
//
// The weight of grains is a potential −Σ m g·x as long as g stays. Whoever changes g does work on all of them at once; it is summed with
// the mean of both ends of a step, which is of second order. Source: the laws of motion in a frame that turns or shakes slowly; the
// centrifugal and Coriolis parts of a real turning box are not in it.

#include "sim/fields/fields.h"
#include "sim/state.h"

namespace tsubu::sim {

/// m/s²: gravity at time t (s). `gravity`: before any change.
Vec3 gravityAt(const Vec3& gravity, const std::vector<GravityChange>& changes, double t);

/// m/s²: never exceeded in size.
double strongestGravity(const Vec3& gravity, const std::vector<GravityChange>& changes);

/// Σ m x, kg m, in the order of memory.
Vec3 massMoment(const State& state);

/// Gravity of the present instant, and the work of its changes.
class GravityClock {
 public:
  GravityClock(const Vec3& gravity, std::vector<GravityChange> changes);

  bool changes() const { return !changes_.empty(); }
  const Vec3& now() const { return now_; }
  /// To the time t. `moment`: Σ m x of all that has weight, at the new instant and with the members of the last one.
  void moveTo(double t, const Vec3& moment);
  /// The same sum after grains have come and gone.
  void settle(const Vec3& moment) { moment_ = moment; }
  double work() const { return work_; }  ///< J, so far

 private:
  Vec3 start_;
  std::vector<GravityChange> changes_;
  Vec3 now_, moment_ = Vec3::Zero();
  double work_ = 0;
};

}  // namespace tsubu::sim
