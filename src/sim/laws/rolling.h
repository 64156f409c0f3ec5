#pragma once
// What every rolling law returns, and the law that resists nothing.

#include "sim/laws/tangential.h"

namespace tsubu::sim {

template <class Real>
struct RollingMomentIn {
  V3In<Real> moment;  ///< on i, N m; j gets the opposite
  Real storedBefore;  ///< J
  Real storedAfter;   ///< J
  Real dissipated;    ///< in this step, J
};
using RollingMoment = RollingMomentIn<double>;

/// Grains roll freely: no moment, no memory.
struct FreeRolling {
  static constexpr std::string_view name = "none";
  static constexpr std::string_view sentence = "Grains roll freely.";
  static constexpr std::array<Need, 0> reads{};
  static constexpr bool acts = false, common = true;
  template <bool growing, class Real>
  using MemoryIn = NoMemory<Family::rolling>;
  template <class>
  struct PairIn {};
  using Pair = PairIn<double>;
  static Pair prepare(const PairValues&) { return {}; }
  static ContactMode mode(const Pair&, double, double) { return {}; }
};

}  // namespace tsubu::sim
