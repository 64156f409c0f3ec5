#pragma once
// A contact law is put together from a normal, a tangential, a rolling and a twisting law, evaluated in this order; each gets the
// earlier results by value. What a part does not do costs nothing: no memory, no torque, no arithmetic.

#include <algorithm>

#include "sim/laws/rolling.h"
#include "sim/laws/twisting.h"

namespace tsubu::sim {

/// What a contact does to i in one step, and where the energy of the contact went.
struct ContactForce {
  V3 force;    ///< on i, N; j gets the opposite
  V3 couple;   ///< n × F_t in N; the torque of F_t is −l_i times this on i and −l_j times the same on j
  V3 moment;   ///< rolling and twisting moment on i, N m; j gets the opposite
};

/// Energies of one contact, J: stored (at the instant of the force) and dissipated (in this step).
struct ContactEnergy {
  double storedNormal, storedTangential, storedRolling;
  double normal, tangential, friction, rolling;
};

template <class N, class T, class R, class W>
struct ContactLaw {
  using Normal = N;
  using Tangential = T;
  using Rolling = R;
  using Twisting = W;

  /// Constants of a pair of materials: nothing but doubles, in this order.
  struct Pair {
    typename N::Pair normal;
    [[no_unique_address]] typename T::Pair tangential;
    [[no_unique_address]] typename R::Pair rolling;
    [[no_unique_address]] typename W::Pair twisting;
  };

  struct Memory {
    [[no_unique_address]] typename T::template Memory<N::growing> tangential;
    [[no_unique_address]] typename R::template Memory<N::growing> rolling;
    [[no_unique_address]] typename W::template Memory<N::growing> twisting;
  };

  static constexpr int tangentialSize = doublesIn<decltype(Memory::tangential)>;
  static constexpr int rollingSize = doublesIn<decltype(Memory::rolling)>;
  static constexpr int stateSize = tangentialSize + rollingSize + doublesIn<decltype(Memory::twisting)>;  ///< doubles of memory per contact
  /// Components of the memory that change sign when i and j change places.
  static constexpr unsigned odd = decltype(Memory::tangential)::odd | decltype(Memory::rolling)::odd << tangentialSize |
                                  decltype(Memory::twisting)::odd << (tangentialSize + rollingSize);

  static constexpr bool turns = T::acts || R::acts || W::acts;            ///< grains rotate
  static constexpr bool rolls = R::acts || W::acts;                       ///< the contact needs the relative spin
  static constexpr bool readsRadius = rolls || N::growing;                ///< the contact needs R*
  static constexpr bool common = N::common && T::common && R::common && W::common;  ///< worth a kernel for every instruction set

  static Pair prepare(const PairValues& values, bool tension, bool rescales) {
    const typename N::Pair normal = N::prepare(values, tension);
    const double constantStiffness = N::growing ? std::numeric_limits<double>::quiet_NaN() : N::stiffness(normal, 0, 0);
    return {normal, T::prepare(values, constantStiffness, rescales), R::prepare(values), W::prepare(values)};
  }

  /// Carries what is remembered along with the contact (T3): before `evaluate`.
  TSUBU_LAW void carry(V3 n, double frameAngle, Memory& memory) {
    memory.tangential.carry(n, frameAngle);
    memory.rolling.carry(n, frameAngle);
    memory.twisting.carry(n, frameAngle);
  }

  /// `energy` is filled when asked for at compile time.
  template <bool withEnergy>
  TSUBU_LAW ContactForce evaluate(const Pair& p, const Contact& c, StepOf step, Memory& memory, ContactEnergy& energy) {
    const NormalForce normal = N::force(p.normal, c, step);
    ContactForce result{normal.force * c.n, {0, 0, 0}, {0, 0, 0}};
    if constexpr (withEnergy) {
      energy = {normal.energy, 0, 0, (normal.elastic - normal.force) * c.separationSpeed * step.dt, 0, 0, 0};
    }
    if constexpr (T::acts) {
      const TangentialForce tangential = T::force(p.tangential, c, normal, step, memory.tangential);
      result.force = result.force + tangential.force;
      result.couple = cross(c.n, tangential.force);
      if constexpr (withEnergy) {
        energy.storedTangential = (1 - step.lead) * tangential.storedBefore + step.lead * tangential.storedAfter;
        energy.tangential = tangential.dashpot;
        energy.friction = tangential.friction;
      }
    }
    if constexpr (R::acts) addMoment<withEnergy>(R::moment(p.rolling, c, normal, step, memory.rolling), step, result, energy);
    if constexpr (W::acts) addMoment<withEnergy>(W::moment(p.twisting, c, normal, step, memory.twisting), step, result, energy);
    return result;
  }

  /// What the memory holds, J: let go when the contact ends.
  TSUBU_LAW double storedTangential(const Pair& p, const Memory& memory) {
    if constexpr (tangentialSize > 0)
      return T::stored(p.tangential, memory.tangential);
    else
      return 0;
  }
  TSUBU_LAW double storedRolling(const Pair& p, const Contact& c, double normalStiffness, const Memory& memory) {
    double energy = 0;
    if constexpr (rollingSize > 0) energy += R::stored(p.rolling, c, normalStiffness, memory.rolling);
    if constexpr (stateSize > tangentialSize + rollingSize) energy += W::stored(p.twisting, c, normalStiffness, memory.twisting);
    return energy;
  }

 private:
  template <bool withEnergy>
  TSUBU_LAW void addMoment(const RollingMoment& moment, StepOf step, ContactForce& result, ContactEnergy& energy) {
    result.moment = result.moment + moment.moment;
    if constexpr (withEnergy) {
      energy.storedRolling += (1 - step.lead) * moment.storedBefore + step.lead * moment.storedAfter;
      energy.rolling += moment.dissipated;
    }
  }
};

}  // namespace tsubu::sim
