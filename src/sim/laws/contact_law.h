#pragma once
// A contact law is put together from a normal, a tangential, a rolling and a twisting law, evaluated in this order; each gets the
// earlier results by value. What a part does not do costs nothing: no memory, no torque, no arithmetic.

#include <algorithm>

#include "sim/laws/rolling.h"
#include "sim/laws/twisting.h"

namespace tsubu::sim {

/// What a contact does to i in one step, and where the energy of the contact went.
template <class Real>
struct ContactForceIn {
  V3In<Real> force;   ///< on i, N; j gets the opposite
  V3In<Real> couple;  ///< n × F_t in N; the torque of F_t is −l_i times this on i and −l_j times the same on j
  V3In<Real> moment;  ///< rolling and twisting moment on i, N m; j gets the opposite
};
using ContactForce = ContactForceIn<double>;

/// Energies of one contact, J: stored (at the instant of the force) and dissipated (in this step).
template <class Real>
struct ContactEnergyIn {
  Real storedNormal, storedTangential, storedRolling;
  Real normal, tangential, friction, rolling;
};
using ContactEnergy = ContactEnergyIn<double>;

template <class N, class T, class R, class W>
struct ContactLaw {
  using Normal = N;
  using Tangential = T;
  using Rolling = R;
  using Twisting = W;

  /// Constants of a pair of materials: nothing but numbers, in this order.
  template <class Real>
  struct PairIn {
    typename N::template PairIn<Real> normal;
    [[no_unique_address]] typename T::template PairIn<Real> tangential;
    [[no_unique_address]] typename R::template PairIn<Real> rolling;
    [[no_unique_address]] typename W::template PairIn<Real> twisting;
  };
  using Pair = PairIn<double>;

  template <class Real>
  struct MemoryIn {
    [[no_unique_address]] typename T::template MemoryIn<N::growing, Real> tangential;
    [[no_unique_address]] typename R::template MemoryIn<N::growing, Real> rolling;
    [[no_unique_address]] typename W::template MemoryIn<N::growing, Real> twisting;
  };
  using Memory = MemoryIn<double>;

  static constexpr int tangentialSize = numbersIn<decltype(Memory::tangential)>;
  static constexpr int rollingSize = numbersIn<decltype(Memory::rolling)>;
  static constexpr int stateSize = tangentialSize + rollingSize + numbersIn<decltype(Memory::twisting)>;  ///< numbers of memory per contact
  /// Components of the memory that change sign when i and j change places.
  static constexpr unsigned odd = decltype(Memory::tangential)::odd | decltype(Memory::rolling)::odd << tangentialSize |
                                  decltype(Memory::twisting)::odd << (tangentialSize + rollingSize);

  static constexpr bool turns = T::acts || R::acts || W::acts;  ///< grains rotate
  static constexpr bool rolls = R::acts || W::acts;             ///< the contact needs the relative spin
  static constexpr bool readsRadius = rolls || N::growing;      ///< the contact needs R*
  static constexpr bool common =
      N::common && T::common && R::common && W::common;  ///< worth a loop for each choice of accounts, classes, precision

  static Pair prepare(const PairValues& values, bool tension, bool rescales) {
    const typename N::Pair normal = N::prepare(values, tension);
    const double constantStiffness = N::growing ? std::numeric_limits<double>::quiet_NaN() : N::stiffness(normal, 0, 0);
    return {normal, T::prepare(values, constantStiffness, rescales), R::prepare(values), W::prepare(values)};
  }

  /// Carries what is remembered along with the contact (T3): before `evaluate`.
  template <class Real>
  TSUBU_LAW void carry(V3In<Real> n, Real frameAngle, MemoryIn<Real>& memory) {
    memory.tangential.carry(n, frameAngle);
    memory.rolling.carry(n, frameAngle);
    memory.twisting.carry(n, frameAngle);
  }

  /// `energy` is filled when asked for at compile time.
  template <bool withEnergy, class Real>
  TSUBU_LAW ContactForceIn<Real> evaluate(const PairIn<Real>& p, const ContactIn<Real>& c, StepIn<Real> step, MemoryIn<Real>& memory,
                                          ContactEnergyIn<Real>& energy) {
    const NormalForceIn<Real> normal = N::force(p.normal, c, step);
    ContactForceIn<Real> result{normal.force * c.n, {0, 0, 0}, {0, 0, 0}};
    if constexpr (withEnergy) {
      energy = {normal.energy, 0, 0, (normal.elastic - normal.force) * c.separationSpeed * step.dt, 0, 0, 0};
    }
    if constexpr (T::acts) {
      const TangentialForceIn<Real> tangential = T::force(p.tangential, c, normal, step, memory.tangential);
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
  template <class Real>
  TSUBU_LAW Real storedTangential(const PairIn<Real>& p, const MemoryIn<Real>& memory) {
    if constexpr (tangentialSize > 0)
      return T::stored(p.tangential, memory.tangential);
    else
      return 0;
  }
  template <class Real>
  TSUBU_LAW Real storedRolling(const PairIn<Real>& p, const ContactIn<Real>& c, Like<Real> normalStiffness, const MemoryIn<Real>& memory) {
    Real energy = 0;
    if constexpr (rollingSize > 0) energy += R::stored(p.rolling, c, normalStiffness, memory.rolling);
    if constexpr (stateSize > tangentialSize + rollingSize) energy += W::stored(p.twisting, c, normalStiffness, memory.twisting);
    return energy;
  }

 private:
  template <bool withEnergy, class Real>
  TSUBU_LAW void addMoment(const RollingMomentIn<Real>& moment, StepIn<Real> step, ContactForceIn<Real>& result,
                           ContactEnergyIn<Real>& energy) {
    result.moment = result.moment + moment.moment;
    if constexpr (withEnergy) {
      energy.storedRolling += (1 - step.lead) * moment.storedBefore + step.lead * moment.storedAfter;
      energy.rolling += moment.dissipated;
    }
  }
};

}  // namespace tsubu::sim
