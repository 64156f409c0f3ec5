#include "sim/integrate.h"

namespace tsubu::sim {

namespace {

V3 v3(const Vec3& a) { return {a.x(), a.y(), a.z()}; }

}  // namespace

Quat rotationBy(const Vec3& angle) {
  const double a2 = 0.25 * angle.squaredNorm();  // (half the angle)²
  if (a2 < 0.01) {
    // Series of cos a and sin a / a, exact to rounding here; no library function, the same bits everywhere.
    const double c = 1 - a2 / 2 * (1 - a2 / 12 * (1 - a2 / 30 * (1 - a2 / 56 * (1 - a2 / 90))));
    const double s = 1 - a2 / 6 * (1 - a2 / 20 * (1 - a2 / 42 * (1 - a2 / 72 * (1 - a2 / 110))));
    const Vec3 v = 0.5 * s * angle;
    return {c, v.x(), v.y(), v.z()};
  }
  // Larger angles by repeated squaring.
  const Quat half = rotationBy(0.5 * angle);
  return half * half;
}

Quat orientationNow(const State& state, std::size_t grain) {
  const AngleRow& angle = state.turned[grain];
  return (rotationBy(Vec3(angle.x, angle.y, angle.z)) * state.orientation[grain]).normalized();
}

Motion integrate(State& state, std::int32_t first, std::int32_t last, const Vec3& gravity, double dt, bool turn) {
  const MoveContext context{state.rows.data(),     state.forces.data(), state.half.data(), state.previous.data(),
                            state.turned.data(), state.perSkin2.data(), v3(gravity), dt};
  const Motion motion = kernels().grains->move(state.integrator, state.turns)(context, first, last);
  for (std::int32_t grain = first; turn && state.turns && grain < last; ++grain) {
    const auto k = static_cast<std::size_t>(grain);
    state.orientation[k] = orientationNow(state, k);
    state.turned[k] = {};
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
