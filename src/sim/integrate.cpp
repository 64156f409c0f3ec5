#include "sim/integrate.h"

#include <cmath>

namespace tsubu::sim {

namespace {

V3 v3(const Vec3& a) { return {a.x(), a.y(), a.z()}; }

/// Where a grain goes in a step and with what spin.
struct Way {
  V3 x, speed, spin;
};

template <Integrator scheme, bool turns>
TSUBU_INLINE Way advance(State& state, std::size_t k, GrainRow& row, const Acceleration& a, double dt) {
  V3 u = row.velocity(), w = row.surfaceSpin();
  if constexpr (scheme == Integrator::velocityVerlet) {
    const HalfStepRow& half = state.half[k];
    u = {half.vx, half.vy, half.vz};
    w = {half.sx, half.sy, half.sz};
  }
  Way way{row.position(), u, w};
  u = u + dt * a.linear;
  if constexpr (turns) w = w + dt * a.surface;
  if constexpr (scheme != Integrator::explicitEuler) way.speed = u, way.spin = w;
  if constexpr (scheme == Integrator::centralDifferences) {
    const Vec3 before = state.previous[k];
    state.previous[k] = {way.x.x, way.x.y, way.x.z};
    const V3 next = 2 * way.x - V3{before.x(), before.y(), before.z()} + (dt * dt) * a.linear;
    u = (1 / dt) * (next - way.x);
    way = {next, u, w};
  } else {
    way.x = way.x + dt * way.speed;
  }
  V3 v = u, s = w;
  if constexpr (scheme == Integrator::velocityVerlet) {
    state.half[k] = {u.x, u.y, u.z, 0, w.x, w.y, w.z, 0};
    v = u + (0.5 * dt) * a.linear;
    if constexpr (turns) s = w + (0.5 * dt) * a.surface;
  }
  row.x = way.x.x, row.y = way.x.y, row.z = way.x.z;
  row.vx = v.x, row.vy = v.y, row.vz = v.z;
  if constexpr (turns) row.sx = s.x, row.sy = s.y, row.sz = s.z;
  return way;
}

template <Integrator scheme, bool turns>
Motion integrateRange(State& state, std::int32_t first, std::int32_t last, V3 gravity, double dt) {
  Motion motion;
  for (std::int32_t g = first; g < last; ++g) {
    const auto k = static_cast<std::size_t>(g);
    GrainRow& row = state.rows[k];
    ForceRow& force = state.forces[k];
    const Acceleration a = accelerationOf(row, force, gravity);
    force = ForceRow{};
    const Way way = advance<scheme, turns>(state, k, row, a, dt);
    if constexpr (turns) {
      AngleRow& angle = state.turned[k];
      const double scale = dt * row.inverseRadius;
      angle.x += scale * way.spin.x, angle.y += scale * way.spin.y, angle.z += scale * way.spin.z;
    }
    motion.add(norm2(way.speed), dt * row.inverseRadius);
  }
  return motion;
}

template <Integrator scheme>
Motion integrateGrains(State& state, std::int32_t first, std::int32_t last, V3 gravity, double dt) {
  return state.turns ? integrateRange<scheme, true>(state, first, last, gravity, dt)
                     : integrateRange<scheme, false>(state, first, last, gravity, dt);
}

Motion integrateBy(Integrator scheme, State& state, std::int32_t first, std::int32_t last, V3 gravity, double dt) {
  switch (scheme) {
    case Integrator::velocityVerlet:
      return integrateGrains<Integrator::velocityVerlet>(state, first, last, gravity, dt);
    case Integrator::explicitEuler:
      return integrateGrains<Integrator::explicitEuler>(state, first, last, gravity, dt);
    case Integrator::leapfrog:
      return integrateGrains<Integrator::leapfrog>(state, first, last, gravity, dt);
    case Integrator::centralDifferences:
      return integrateGrains<Integrator::centralDifferences>(state, first, last, gravity, dt);
    case Integrator::rungeKutta:  // not by single passes: runge_kutta.h
    case Integrator::symplecticEuler:
      break;
  }
  return integrateGrains<Integrator::symplecticEuler>(state, first, last, gravity, dt);
}

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
  const Motion motion = integrateBy(state.integrator, state, first, last, v3(gravity), dt);
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
    const V3 u = row.velocity() - (0.5 * dt) * a.linear, w = row.surfaceSpin() - (0.5 * dt) * a.surface;
    if (verlet) {
      state.half[k] = {u.x, u.y, u.z, 0, w.x, w.y, w.z, 0};
      continue;
    }
    row.vx = u.x, row.vy = u.y, row.vz = u.z;
    row.sx = w.x, row.sy = w.y, row.sz = w.z;
    if (state.integrator == Integrator::centralDifferences) state.previous[k] = Vec3(row.x, row.y, row.z) - dt * Vec3(u.x, u.y, u.z);
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
    s = s + (0.5 * dt) * a.surface;
  }
  return {Vec3(v.x, v.y, v.z), Vec3(s.x, s.y, s.z)};
}

}  // namespace tsubu::sim
