#include "sim/integrate.h"

#include <algorithm>

namespace tsubu::sim {

namespace {

V3 v3(const Vec3& a) { return {a.x(), a.y(), a.z()}; }

}  // namespace

Quat orientationNow(const State& state, std::size_t grain) {
  Quat now = state.orientation[grain];
  kernels().grains->turn(now.coeffs().data(), &state.turned[grain], 1);
  return now;
}

Motion integrate(State& state, std::int32_t first, std::int32_t last, const Vec3& gravity, double dt, bool turn, bool bySingle) {
  const MoveContext context{state.rows.data(),   state.forces.data(),
                            state.single.data(), state.singleForces.data(),
                            state.half.data(),   state.previous.data(),
                            state.turned.data(), state.perSkin2.data(),
                            v3(gravity),         dt};
  const Motion motion =
      kernels().grains->move(state.integrator, {state.turns, state.keepsOrientation, state.mixed, bySingle})(context, first, last);
  if (turn && state.keepsOrientation && first < last) {
    kernels().grains->turn(state.orientation[static_cast<std::size_t>(first)].coeffs().data(),
                           &state.turned[static_cast<std::size_t>(first)], last - first);
    std::fill(state.turned.begin() + first, state.turned.begin() + last, AngleRow{});
  }
  return motion;
}

void startHalfSteps(State& state, std::uint32_t firstId, const Vec3& gravity, double dt) {
  const bool verlet = state.integrator == Integrator::velocityVerlet;
  if (schemeOf(state.integrator).behind == 0) return;
  for (std::size_t k = 0; k < state.size(); ++k) {
    if (state.id[k] < firstId) continue;
    GrainRow& row = state.rows[k];
    // Where contacts see half-step velocities, gravity has been taken back already (State::add).
    const Acceleration a = accelerationOf(row, state.forces[k], verlet ? v3(gravity) : V3{0, 0, 0});
    const V3 u = row.velocity() - (0.5 * dt) * a.linear, w = state.turns ? row.surfaceSpin() - (0.5 * dt) * a.surface : row.surfaceSpin();
    if (verlet) {
      state.half[k] = {u.x, u.y, u.z, 0, w.x, w.y, w.z, 0};
      continue;
    }
    row.vx = u.x, row.vy = u.y, row.vz = u.z;
    row.sx = w.x, row.sy = w.y, row.sz = w.z;
    if (state.mixed) state.toSingle(k);
    if (state.integrator == Integrator::centralDifferences) state.previous[k] = {row.x - dt * u.x, row.y - dt * u.y, row.z - dt * u.z, 0};
  }
}

Velocities velocitiesNow(const State& state, std::size_t grain, const Vec3& gravity, double dt) {
  const GrainRow& row = state.rows[grain];
  V3 v = row.velocity(), s = row.surfaceSpin();
  if (state.integrator == Integrator::velocityVerlet) {
    const HalfStepRow& half = state.half[grain];
    v = {half.vx, half.vy, half.vz};
    s = {half.sx, half.sy, half.sz};
  }
  if (schemeOf(state.integrator).behind > 0) {
    const Acceleration a = accelerationOf(row, state.forces[grain], v3(gravity));
    v = v + (0.5 * dt) * a.linear;
    if (state.turns) s = s + (0.5 * dt) * a.surface;
  }
  return {Vec3(v.x, v.y, v.z), Vec3(s.x, s.y, s.z)};
}

}  // namespace tsubu::sim
