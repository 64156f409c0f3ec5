#pragma once
// What every tangential law returns, and the law that does nothing.

#include <array>
#include <string_view>

#include "sim/laws/memory.h"
#include "sim/laws/normal.h"
#include "sim/properties.h"

namespace tsubu::sim {

template <class Real>
struct TangentialForceIn {
  V3In<Real> force;   ///< on i, N
  Real storedBefore;  ///< energy in the memory as it was, J
  Real storedAfter;   ///< energy in the memory as it is left, J
  Real dashpot;       ///< dissipated by the dashpot in this step, J
  Real friction;      ///< dissipated by sliding in this step, J
};
using TangentialForce = TangentialForceIn<double>;

// A tangential law says: does it `act`; does it `needGrowing` stiffness, that of a Hertz contact; is it `passive` (never gives more
// energy than it got); does its force stay `withinLimit`, that of Coulomb; is it `common` enough for loops of its own without accounts,
// for a single material and in single precision. It has: MemoryIn<growing, Real>, one of those of memory.h, and `stored` where that is not
// NoMemory; PairIn<Real> and prepare(values, k_n or NaN where it grows, rescales); force; mode, for the time step.

/// No friction: no tangential force, no torque, no memory.
struct Frictionless {
  static constexpr std::string_view name = "none";
  static constexpr std::string_view sentence = "No friction: grains slide freely and do not turn; no memory.";
  static constexpr std::array<Need, 0> reads{};
  static constexpr bool acts = false, needsGrowing = false, passive = true, withinLimit = true, common = true;
  template <bool growing, class Real>
  using MemoryIn = NoMemory<Family::tangential>;
  template <class>
  struct PairIn {};
  using Pair = PairIn<double>;
  static Pair prepare(const PairValues&, double, bool) { return {}; }
  static ContactMode mode(const Pair&, double, double, double) { return {}; }
};

}  // namespace tsubu::sim
