#pragma once
// A contact law is put together from one normal, one tangential and one rolling law, evaluated in this order; each gets the earlier
// results by value. What a part does not do costs nothing: no memory, no torque, no arithmetic.

#include <algorithm>

#include "sim/laws/rolling.h"

namespace tsubu::sim {

/// What a contact does to i in one step, and where the energy of the contact went.
struct ContactForce {
  V3 force;    ///< on i, N; j gets the opposite
  V3 couple;   ///< n × F_t in N; the torque of F_t is −l_i times this on i and −l_j times the same on j
  V3 moment;   ///< rolling moment on i, N m; j gets the opposite
};

/// Energies of one contact, J: stored (at the instant of the force) and dissipated (in this step).
struct ContactEnergy {
  double storedNormal, storedTangential, storedRolling;
  double normal, tangential, friction, rolling;
};

template <class N, class T, class R>
struct ContactLaw {
  using Normal = N;
  using Tangential = T;
  using Rolling = R;

  struct Pair {
    typename N::Pair normal;
    typename T::Pair tangential;
    typename R::Pair rolling;
  };

  static constexpr bool turns = T::acts || R::acts;     ///< grains rotate
  static constexpr bool rolls = R::acts;                ///< the contact needs the relative spin
  static constexpr int stateSize = T::stateSize + R::stateSize;  ///< doubles of memory per contact

  static Pair prepare(const PropertyValues& values, bool tension) {
    const typename N::Pair normal = N::prepare(values, tension);
    const double stiffness = N::stiffness(normal);
    return {normal, T::prepare(values, stiffness), R::prepare(values, stiffness)};
  }

  /// `state` holds the two memories; `energy` is filled when asked for at compile time.
  template <bool withEnergy>
  TSUBU_LAW ContactForce evaluate(const Pair& p, const Contact& c, StepOf step, V3& tangentialMemory, V3& rollingMemory,
                                  ContactEnergy& energy) {
    const NormalForce normal = N::force(p.normal, c, step);
    ContactForce result{normal.force * c.n, {0, 0, 0}, {0, 0, 0}};
    if constexpr (withEnergy) {
      energy = {normal.energy, 0, 0, (normal.elastic - normal.force) * c.separationSpeed * step.dt, 0, 0, 0};
    }
    if constexpr (T::acts) {
      const TangentialForce tangential = T::force(p.tangential, c, normal, step, tangentialMemory);
      result.force = result.force + tangential.force;
      result.couple = cross(c.n, tangential.force);
      if constexpr (withEnergy) {
        energy.storedTangential = (1 - step.lead) * tangential.storedBefore + step.lead * tangential.storedAfter;
        energy.tangential = tangential.dashpot;
        energy.friction = tangential.friction;
      }
    }
    if constexpr (R::acts) {
      const RollingMoment rolling = R::moment(p.rolling, c, normal, step, rollingMemory);
      result.moment = rolling.moment;
      if constexpr (withEnergy) {
        energy.storedRolling = (1 - step.lead) * rolling.storedBefore + step.lead * rolling.storedAfter;
        energy.rolling = rolling.dissipated;
      }
    }
    return result;
  }
};

}  // namespace tsubu::sim
