#pragma once
// The loops over grains and over listed pairs that know no law: moving grains, and finding the pairs that are near. Row by row, four
// doubles at once; the fourth goes along: what a row keeps there (radius, 1/m, 1/r) is multiplied by a step of 0 and stays.

#include "sim/kernel/grain_kernels.h"
#include "sim/kernel/lanes.h"

namespace tsubu::sim {
namespace {

/// The first three of `a` with the fourth of `b`.
TSUBU_INLINE D4 withFourth(const D4& a, const D4& b) { return __builtin_shufflevector(a, b, 0, 1, 2, 7); }

/// Step lengths by which rows are multiplied: nothing for the fourth.
struct StepLanes {
  D4 dt, half, squared, perStep;

  explicit StepLanes(double step)
      : dt{step, step, step, 0}, half{0.5 * step, 0.5 * step, 0.5 * step, 0}, squared{step * step, step * step, step * step, 0},
        perStep{1 / step, 1 / step, 1 / step, 0} {}
};

/// Returns the velocity by which the grain has gone.
template <Integrator scheme, bool turns>
TSUBU_INLINE D4 moveGrain(const MoveContext& context, const StepLanes& step, const D4& gravity, std::int32_t g) {
  GrainRow& row = context.rows[g];
  ForceRow& force = context.forces[g];
  const D4 x = load4(&row.x), rowV = load4(&row.vx), rowS = load4(&row.sx), none{0, 0, 0, 0};
  const D4 a = fill4(row.inverseMass) * load4(&force.fx) + gravity;
  const D4 b = fill4(-2.5 * row.inverseMass) * load4(&force.qx);
  store4(&force.fx, none);
  store4(&force.qx, none);
  constexpr bool verlet = scheme == Integrator::velocityVerlet;
  const D4 before = verlet ? load4(&context.half[g].vx) : rowV, spinBefore = verlet ? load4(&context.half[g].sx) : rowS;
  D4 u = before + step.dt * a;
  const D4 w = turns ? spinBefore + step.dt * b : spinBefore;
  const bool old = scheme == Integrator::explicitEuler;
  D4 speed = old ? before : u, next = x + step.dt * speed;
  if constexpr (scheme == Integrator::centralDifferences) {
    next = 2 * x - load4(&context.previous[g].x) + step.squared * a;
    store4(&context.previous[g].x, x);
    speed = step.perStep * (next - x);
    u = withFourth(speed, rowV);
    next = withFourth(next, x);
  }
  const D4 spin = old ? spinBefore : w;
  D4 v = u, s = w;
  if constexpr (verlet) {
    store4(&context.half[g].vx, u);
    store4(&context.half[g].sx, w);
    v = withFourth(u + step.half * a, rowV);
    s = withFourth(turns ? w + step.half * b : w, rowS);
  }
  store4(&row.x, next);
  store4(&row.vx, v);
  if constexpr (turns) {
    store4(&row.sx, s);
    add4(&context.turned[g].x, (step.dt * fill4(row.inverseRadius)) * spin);
  }
  return speed;
}

/// The largest of a Motion, four grains side by side: one after the other, each would wait for the one before.
struct MotionLanes {
  D4 fastest2{}, travel2{}, haste2{};

  /// As Motion::add; what is not a number stays.
  TSUBU_INLINE void add(const D4& speed2, const D4& scale, const D4& perSkin2) {
    const D4 way2 = speed2 * scale * scale, hasteOfGrain2 = speed2 * perSkin2;
    haste2 = hasteOfGrain2 > haste2 ? hasteOfGrain2 : haste2;
    fastest2 = speed2 > fastest2 ? speed2 : fastest2;
    travel2 = ((way2 <= travel2) | (travel2 != travel2)) ? travel2 : way2;
  }
  TSUBU_INLINE void addTo(Motion& motion) const {
    for (int k = 0; k < 4; ++k) {
      motion.haste2 = larger(haste2[k], motion.haste2);
      motion.fastest2 = larger(fastest2[k], motion.fastest2);
      motion.addTravel(travel2[k]);
    }
  }
};

template <Integrator scheme, bool turns>
Motion moveGrains(const MoveContext& context, std::int32_t first, std::int32_t last) {
  const StepLanes step(context.dt);
  const D4 gravity{context.gravity.x, context.gravity.y, context.gravity.z, 0};
  Motion motion;
  MotionLanes lanes;
  std::int32_t g = first;
  for (; g + 4 <= last; g += 4) {
    D4 square[4], scale;
    for (int k = 0; k < 4; ++k) {
      const D4 speed = moveGrain<scheme, turns>(context, step, gravity, g + k);
      square[k] = speed * speed;
      scale[k] = context.rows[g + k].inverseRadius;
    }
    transpose4(square[0], square[1], square[2], square[3]);
    lanes.add(square[0] + square[1] + square[2], fill4(context.dt) * scale, load4(context.perSkin2 + g));
  }
  lanes.addTo(motion);
  for (; g < last; ++g) {
    const D4 speed = moveGrain<scheme, turns>(context, step, gravity, g), square = speed * speed;
    motion.add(square[0] + square[1] + square[2], context.dt * context.rows[g].inverseRadius, context.perSkin2[g]);
  }
  return motion;
}

MoveKernel moveFor(Integrator scheme, bool turns) {
  switch (scheme) {
    case Integrator::velocityVerlet:
      return turns ? &moveGrains<Integrator::velocityVerlet, true> : &moveGrains<Integrator::velocityVerlet, false>;
    case Integrator::explicitEuler:
      return turns ? &moveGrains<Integrator::explicitEuler, true> : &moveGrains<Integrator::explicitEuler, false>;
    case Integrator::leapfrog:
      return turns ? &moveGrains<Integrator::leapfrog, true> : &moveGrains<Integrator::leapfrog, false>;
    case Integrator::centralDifferences:
      return turns ? &moveGrains<Integrator::centralDifferences, true> : &moveGrains<Integrator::centralDifferences, false>;
    case Integrator::rungeKutta:  // not by single passes: runge_kutta.h
    case Integrator::symplecticEuler:
      break;
  }
  return turns ? &moveGrains<Integrator::symplecticEuler, true> : &moveGrains<Integrator::symplecticEuler, false>;
}

std::int64_t nearPairs(const GrainRow* rows, const double* skins, double share, const std::int32_t* is, const std::int32_t* js,
                       std::int64_t count, std::int32_t* kept) {
  const D4 signs{-1, -1, -1, 1};
  std::int64_t found = 0;
  for (std::int64_t q = 0; q < count; q += 4) {
    const int few = static_cast<int>(count - q < 4 ? count - q : 4);
    D4 x[4], skin{};
    for (int k = 0; k < 4; ++k) {
      const std::int64_t from = q + (k < few ? k : few - 1);
      x[k] = load4(&rows[is[from]].x) + signs * load4(&rows[js[from]].x);
      skin[k] = skins[is[from]] + skins[js[from]];
    }
    transpose4(x[0], x[1], x[2], x[3]);
    const D4 reach = x[3] + fill4(share) * skin;
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
