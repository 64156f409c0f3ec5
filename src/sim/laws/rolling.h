#pragma once
// What every rolling law returns, and the law that resists nothing.

#include "sim/laws/tangential.h"

namespace tsubu::sim {

struct RollingMoment {
  V3 moment;            ///< on i, N m; j gets the opposite
  double storedBefore;  ///< J
  double storedAfter;   ///< J
  double dissipated;    ///< in this step, J
};

/// Grains roll freely: no moment, no memory.
struct FreeRolling {
  static constexpr std::string_view name = "none";
  static constexpr std::string_view sentence = "Grains roll freely.";
  static constexpr std::array<Need, 0> reads{};
  static constexpr bool acts = false, common = true;
  template <bool growing>
  using Memory = NoMemory<Family::rolling>;
  struct Pair {};
  static Pair prepare(const PairValues&) { return {}; }
  static ContactMode mode(const Pair&, double, double) { return {}; }
};

}  // namespace tsubu::sim
