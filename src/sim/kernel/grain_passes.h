#pragma once
// The loops over grains and over listed pairs that know no law: moving grains, and finding the pairs that are near. Row by row, four
// or eight doubles at once; the fourth goes along: what a row keeps there (radius, 1/m, 1/r) is multiplied by a step of 0 and stays.

#include "sim/kernel/grain_kernels.h"
#include "sim/kernel/lanes.h"

namespace tsubu::sim {
namespace {

/// What goes by the same rules: velocity and r ω of a grain, side by side, or its velocity alone where grains do not turn.
template <bool turns>
using Pace = std::conditional_t<turns, D8, D4>;

TSUBU_INLINE D4 linearOf(const D4& pace) { return pace; }
TSUBU_INLINE D4 linearOf(const D8& pace) { return lowHalf(pace); }

template <bool turns>
TSUBU_INLINE Pace<turns> loadPace(const double* from) {
  if constexpr (turns)
    return load8(from);
  else
    return load4(from);
}
TSUBU_INLINE void storePace(double* to, const D4& pace) { store4(to, pace); }
TSUBU_INLINE void storePace(double* to, const D8& pace) { store8(to, pace); }

/// Three numbers for velocities and three for spins; nothing for the fourth.
template <bool turns>
TSUBU_INLINE Pace<turns> lanesOf(V3 linear, double surface) {
  const D4 low{linear.x, linear.y, linear.z, 0};
  if constexpr (turns)
    return joined(low, D4{surface, surface, surface, 0});
  else
    return low;
}

/// What all grains have in common. Step lengths multiply rows: nothing for the fourth.
template <bool turns>
struct MoveLanes {
  Pace<turns> dt, half, gravity, perMass;
  D4 step, squared, perStep;

  explicit MoveLanes(const MoveContext& context)
      : dt(lanesOf<turns>({context.dt, context.dt, context.dt}, context.dt)),
        half(dt * 0.5),
        gravity(lanesOf<turns>(context.gravity, -0.0)),  // of zeros the one that changes no sign
        perMass(lanesOf<turns>({1, 1, 1}, -2.5)),        // T = −r Q, and r/I = 2.5/(m r)
        step(linearOf(dt)),
        squared(step * step),
        perStep{1 / context.dt, 1 / context.dt, 1 / context.dt, 0} {}
};

/// What acts on a grain, F and, where grains turn, Q; taken away from where it is.
template <bool turns, bool bySingle>
TSUBU_INLINE Pace<turns> takeForces(const MoveContext& context, std::int32_t g) {
  if constexpr (bySingle) {
    float* const from = &context.singleForces[g].fx;
    Pace<turns> taken;
    if constexpr (turns)
      taken = toDouble(load8(from));
    else
      taken = as<double>(load4(from));
    store8(from, F8{});
    return taken;
  } else {
    double* const from = &context.forces[g].fx;
    const Pace<turns> taken = loadPace<turns>(from);
    storePace(from, Pace<turns>{});
    return taken;
  }
}

/// Returns the squares of the velocity by which the grain has gone, and 1/r.
template <Integrator scheme, bool turns, bool keepsOrientation, bool mixed, bool bySingle>
TSUBU_INLINE D4 moveGrain(const MoveContext& context, const MoveLanes<turns>& lanes, std::int32_t g) {
  GrainRow& row = context.rows[g];
  const D4 x = load4(&row.x), perRadius = load4(&row.sx);  // in its fourth
  const Pace<turns> rowPace = loadPace<turns>(&row.vx), forces = takeForces<turns, bySingle>(context, g);
  const Pace<turns> a = (lanes.perMass * row.inverseMass) * forces + lanes.gravity;
  constexpr bool verlet = scheme == Integrator::velocityVerlet, old = scheme == Integrator::explicitEuler;
  const Pace<turns> before = verlet ? loadPace<turns>(&context.half[g].vx) : rowPace;
  Pace<turns> u = before + lanes.dt * a;
  D4 speed = linearOf(old ? before : u), next = x + lanes.step * speed;
  if constexpr (scheme == Integrator::centralDifferences) {
    next = 2 * x - load4(&context.previous[g].x) + lanes.squared * linearOf(a);
    store4(&context.previous[g].x, x);
    speed = lanes.perStep * (next - x);
    next = withFourth(next, x);
    const D4 v = withFourth(speed, linearOf(rowPace));
    if constexpr (turns)
      u = joined(v, highHalf(u));
    else
      u = v;
  }
  Pace<turns> now = u;
  if constexpr (verlet) {
    storePace(&context.half[g].vx, u);
    now = withFourth(u + lanes.half * a, rowPace);
  }
  store4(&row.x, next);
  storePace(&row.vx, now);
  if constexpr (mixed) {
    SingleRow& single = context.single[g];
    store4(&single.x, next);
    if constexpr (turns)
      store8(&single.vx, toSingle(now));
    else
      store4(&single.vx, as<float>(now));
  }
  if constexpr (keepsOrientation) {
    float* const turned = &context.turned[g].x;
    store4(turned, load4(turned) + as<float>((lanes.step * fill4(row.inverseRadius)) * highHalf(old ? before : u)));
  }
  return withFourth(speed * speed, perRadius);
}

/// The largest of a Motion, four grains side by side: one after the other, each would wait for the one before.
struct MotionLanes {
  D4 fastest2{}, travel2{}, haste2{};

  /// As Motion::add; what is not a number stays.
  TSUBU_INLINE void add(const D4& speed2, const D4& scale, const D4& perSkin2) {
    const D4 way2 = speed2 * scale * scale, hasteOfGrain2 = speed2 * perSkin2;
    haste2 = choose(hasteOfGrain2 > haste2, hasteOfGrain2, haste2);
    fastest2 = choose(speed2 > fastest2, speed2, fastest2);
    travel2 = choose((way2 <= travel2) | (travel2 != travel2), travel2, way2);
  }
  TSUBU_INLINE void addTo(Motion& motion) const {
    for (int k = 0; k < 4; ++k) {
      motion.haste2 = larger(haste2[k], motion.haste2);
      motion.fastest2 = larger(fastest2[k], motion.fastest2);
      motion.addTravel(travel2[k]);
    }
  }
};

constexpr std::int32_t rowsAhead = 64;

template <Integrator scheme, bool turns, bool keepsOrientation, bool mixed, bool bySingle>
Motion moveGrains(const MoveContext& given, std::int32_t first, std::int32_t last) {
  const MoveContext context = given;  // a copy that no store can change
  const MoveLanes<turns> lanes(context);
  Motion motion;
  MotionLanes largest;
  std::int32_t g = first;
  for (; g + 4 <= last; g += 4) {
    if constexpr (bySingle) {
      // Contacts have read the single rows alone, and these have not been seen in this step.
      const auto* const rows = reinterpret_cast<const char*>(context.rows + g + rowsAhead);
      for (std::size_t at = 0; at < 4 * sizeof(GrainRow); at += 64) __builtin_prefetch(rows + at, 1);
      if constexpr (keepsOrientation) __builtin_prefetch(context.turned + g + rowsAhead, 1);
    }
    D4 way[4];
    for (int k = 0; k < 4; ++k) way[k] = moveGrain<scheme, turns, keepsOrientation, mixed, bySingle>(context, lanes, g + k);
    transpose4(way[0], way[1], way[2], way[3]);
    largest.add(way[0] + way[1] + way[2], fill4(context.dt) * way[3], as<double>(load4(context.perSkin2 + g)));
  }
  largest.addTo(motion);
  for (; g < last; ++g) {
    const D4 way = moveGrain<scheme, turns, keepsOrientation, mixed, bySingle>(context, lanes, g);
    motion.add(way[0] + way[1] + way[2], context.dt * way[3], context.perSkin2[g]);
  }
  return motion;
}

template <Integrator scheme, bool turns, bool keepsOrientation>
MoveKernel moveBy(MoveKind kind) {
  if (!kind.mixed) return &moveGrains<scheme, turns, keepsOrientation, false, false>;
  return kind.bySingle ? &moveGrains<scheme, turns, keepsOrientation, true, true>
                       : &moveGrains<scheme, turns, keepsOrientation, true, false>;
}
template <Integrator scheme>
MoveKernel moveBy(MoveKind kind) {
  if (!kind.turns) return moveBy<scheme, false, false>(kind);
  return kind.keepsOrientation ? moveBy<scheme, true, true>(kind) : moveBy<scheme, true, false>(kind);
}

MoveKernel moveFor(Integrator scheme, MoveKind kind) {
  switch (scheme) {
    case Integrator::velocityVerlet:
      return moveBy<Integrator::velocityVerlet>(kind);
    case Integrator::explicitEuler:
      return moveBy<Integrator::explicitEuler>(kind);
    case Integrator::leapfrog:
      return moveBy<Integrator::leapfrog>(kind);
    case Integrator::centralDifferences:
      return moveBy<Integrator::centralDifferences>(kind);
    case Integrator::rungeKutta:  // not by single passes: runge_kutta.h
    case Integrator::symplecticEuler:
      break;
  }
  return moveBy<Integrator::symplecticEuler>(kind);
}

/// Quaternions of four grains, side by side.
struct Quat4 {
  D4 x, y, z, w;
};
TSUBU_INLINE Quat4 product(const Quat4& a, const Quat4& b) {
  return {a.w * b.x + a.x * b.w + (a.y * b.z - a.z * b.y), a.w * b.y + a.y * b.w + (a.z * b.x - a.x * b.z),
          a.w * b.z + a.z * b.w + (a.x * b.y - a.y * b.x), a.w * b.w - (a.x * b.x + a.y * b.y + a.z * b.z)};
}

/// exp(½ a). Series of cos and sin of half the angle, exact to rounding up to 0.2 rad: no library function, the same bits everywhere.
TSUBU_INLINE Quat4 rotationBySmall(const D4& x, const D4& y, const D4& z) {
  const D4 b = fill4(0.25) * (x * x + y * y + z * z);  // (half the angle)²
  const D4 c = 1 - b * (1.0 / 2) * (1 - b * (1.0 / 12) * (1 - b * (1.0 / 30) * (1 - b * (1.0 / 56) * (1 - b * (1.0 / 90)))));
  const D4 s = 1 - b * (1.0 / 6) * (1 - b * (1.0 / 20) * (1 - b * (1.0 / 42) * (1 - b * (1.0 / 72) * (1 - b * (1.0 / 110)))));
  const D4 half = fill4(0.5) * s;
  return {half * x, half * y, half * z, c};
}

/// Larger angles are halved until they are small, and the rotation is squared as often: each lane for itself.
TSUBU_INLINE Quat4 rotationBy(const D4& angleX, const D4& angleY, const D4& angleZ) {
  D4 x = angleX, y = angleY, z = angleZ;
  constexpr double small2 = 0.04;  // rad²
  constexpr int mostHalvings = 64;
  D4 halvings{};
  int most = 0;
  for (; most < mostHalvings; ++most) {
    const auto large = x * x + y * y + z * z > fill4(small2);
    if (!(large[0] || large[1] || large[2] || large[3])) break;
    const D4 scale = choose(large, fill4(0.5), fill4(1));
    x *= scale, y *= scale, z *= scale;
    halvings += choose(large, fill4(1), fill4(0));
  }
  Quat4 q = rotationBySmall(x, y, z);
  for (int k = 1; k <= most; ++k) {
    const Quat4 squared = product(q, q);
    const auto again = halvings >= fill4(k);
    q = {choose(again, squared.x, q.x), choose(again, squared.y, q.y), choose(again, squared.z, q.z), choose(again, squared.w, q.w)};
  }
  return q;
}

void turnGrains(double* orientations, const AngleRow* angles, std::int64_t count) {
  for (std::int64_t first = 0; first < count; first += 4) {
    const std::int64_t few = count - first < 4 ? count - first : 4;
    D4 a[4], o[4];
    for (int k = 0; k < 4; ++k) {
      const std::int64_t from = first + (k < few ? k : 0);
      a[k] = as<double>(load4(&angles[from].x));
      o[k] = load4(orientations + 4 * from);
    }
    transpose4(a[0], a[1], a[2], a[3]);
    transpose4(o[0], o[1], o[2], o[3]);
    const Quat4 q = product(rotationBy(a[0], a[1], a[2]), {o[0], o[1], o[2], o[3]});
    const D4 length2 = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
    const auto perLength = [&](int k) { return 1 / std::sqrt(length2[k]); };
    const D4 scale{perLength(0), perLength(1), perLength(2), perLength(3)};
    o[0] = scale * q.x, o[1] = scale * q.y, o[2] = scale * q.z, o[3] = scale * q.w;
    transpose4(o[0], o[1], o[2], o[3]);
    for (int k = 0; k < few; ++k) store4(orientations + 4 * (first + k), o[k]);
  }
}

std::int64_t nearBalls(const BallColumns& balls, const BallRun* runs, int count, const double (&ball)[4], std::int32_t after,
                       std::int32_t* found) {
  const auto all = [](double value) __attribute__((always_inline)) { return joined(fill4(value), fill4(value)); };
  const D8 x = all(ball[0]), y = all(ball[1]), z = all(ball[2]), radius = all(ball[3]);
  std::int64_t kept = 0;
  for (int n = 0; n < count; ++n) {
    for (std::int32_t from = runs[n].first; from < runs[n].last; from += 8) {
      const D8 dx = x - load8(balls.x + from), dy = y - load8(balls.y + from), dz = z - load8(balls.z + from);
      const D8 reach = radius + load8(balls.radius + from);
      const std::int32_t left = runs[n].last - from;
      const unsigned there = left < 8 ? (1U << left) - 1 : 255;
      kept += keepAbove(after, balls.number + from, whereLess(dx * dx + dy * dy + dz * dz, reach * reach) & there, found + kept);
    }
  }
  return kept;
}

template <class Row>
std::int64_t nearPairs(const Row* rows, const float* skins, double share, const std::int32_t* is, const std::int32_t* js,
                       std::int64_t count, std::int32_t* kept) {
  const D4 signs{-1, -1, -1, 1};
  std::int64_t found = 0;
  for (std::int64_t q = 0; q < count; q += 4) {
    const int few = static_cast<int>(count - q < 4 ? count - q : 4);
    D4 x[4];
    double skin[4];
    for (int k = 0; k < 4; ++k) {
      const std::int64_t from = q + (k < few ? k : few - 1);
      x[k] = plusSigned(load4(&rows[is[from]].x), signs, load4(&rows[js[from]].x));
      skin[k] = static_cast<double>(skins[is[from]]) + static_cast<double>(skins[js[from]]);
    }
    transpose4(x[0], x[1], x[2], x[3]);
    const D4 reach = x[3] + fill4(share) * D4{skin[0], skin[1], skin[2], skin[3]};
    const auto near = x[0] * x[0] + x[1] * x[1] + x[2] * x[2] < reach * reach;
    // Without a branch: which pairs are near cannot be foreseen.
    for (int k = 0; k < few; ++k) {
      kept[found] = static_cast<std::int32_t>(q) + k;
      found += near[k] != 0;
    }
  }
  return found;
}

}  // namespace
}  // namespace tsubu::sim
