#include "sim/integrate.h"

#include <cmath>
#include <limits>

namespace tsubu::sim {

namespace {

V3 v3(const Vec3& a) { return {a.x(), a.y(), a.z()}; }

struct Acceleration {
  V3 linear, surface;  // dv/dt and d(rω)/dt
};

Acceleration accelerationOf(const GrainRow& row, const ForceRow& force, V3 gravity) {
  return {row.inverseMass * V3{force.fx, force.fy, force.fz} + gravity, (-2.5 * row.inverseMass) * V3{force.qx, force.qy, force.qz}};
}

template <bool verlet, bool turns>
Motion integrateRange(State& state, std::int32_t first, std::int32_t last, V3 gravity, double dt) {
  Motion motion;
  for (std::int32_t g = first; g < last; ++g) {
    const auto k = static_cast<std::size_t>(g);
    GrainRow& row = state.rows[k];
    ForceRow& force = state.forces[k];
    const Acceleration a = accelerationOf(row, force, gravity);
    force = ForceRow{};
    V3 u = row.velocity(), w = row.surfaceSpin();
    if constexpr (verlet) {
      const HalfStepRow& half = state.half[k];
      u = {half.vx, half.vy, half.vz};
      w = {half.sx, half.sy, half.sz};
    }
    u = u + dt * a.linear;
    if constexpr (turns) w = w + dt * a.surface;
    const V3 x = row.position() + dt * u;
    row.x = x.x, row.y = x.y, row.z = x.z;
    V3 v = u, s = w;
    if constexpr (verlet) {
      state.half[k] = {u.x, u.y, u.z, 0, w.x, w.y, w.z, 0};
      v = u + (0.5 * dt) * a.linear;
      if constexpr (turns) s = w + (0.5 * dt) * a.surface;
    }
    row.vx = v.x, row.vy = v.y, row.vz = v.z;
    if constexpr (turns) {
      row.sx = s.x, row.sy = s.y, row.sz = s.z;
      AngleRow& angle = state.turned[k];
      const double scale = dt * row.inverseRadius;
      angle.x += scale * w.x, angle.y += scale * w.y, angle.z += scale * w.z;
    }
    const double speed2 = norm2(u);
    const double travel2 = speed2 * dt * dt * row.inverseRadius * row.inverseRadius;
    motion.fastest2 = speed2 > motion.fastest2 ? speed2 : motion.fastest2;
    if (!(travel2 <= motion.travel2)) motion.travel2 = travel2 == travel2 ? travel2 : std::numeric_limits<double>::infinity();
  }
  return motion;
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
  const V3 g = v3(gravity);
  if (!state.turns) return state.verlet ? integrateRange<true, false>(state, first, last, g, dt) : integrateRange<false, false>(state, first, last, g, dt);
  const Motion motion =
      state.verlet ? integrateRange<true, true>(state, first, last, g, dt) : integrateRange<false, true>(state, first, last, g, dt);
  for (std::int32_t grain = first; turn && grain < last; ++grain) {
    const auto k = static_cast<std::size_t>(grain);
    state.orientation[k] = orientationNow(state, k);
    state.turned[k] = {};
  }
  return motion;
}

void startVerlet(State& state, std::uint32_t firstId, const Vec3& gravity, double dt) {
  for (std::size_t k = 0; k < state.half.size(); ++k) {
    if (state.id[k] < firstId) continue;
    const GrainRow& row = state.rows[k];
    const Acceleration a = accelerationOf(row, state.forces[k], v3(gravity));
    const V3 u = row.velocity() - (0.5 * dt) * a.linear, w = row.surfaceSpin() - (0.5 * dt) * a.surface;
    state.half[k] = {u.x, u.y, u.z, 0, w.x, w.y, w.z, 0};
  }
}

Velocities velocitiesNow(const State& state, std::size_t grain, const Vec3& gravity, double dt) {
  const GrainRow& row = state.rows[grain];
  V3 v = row.velocity(), s = row.surfaceSpin();
  if (state.verlet) {
    const HalfStepRow& half = state.half[grain];
    const Acceleration a = accelerationOf(row, state.forces[grain], v3(gravity));
    v = V3{half.vx, half.vy, half.vz} + (0.5 * dt) * a.linear;
    s = V3{half.sx, half.sy, half.sz} + (0.5 * dt) * a.surface;
  }
  return {Vec3(v.x, v.y, v.z), Vec3(s.x, s.y, s.z)};
}

}  // namespace tsubu::sim
