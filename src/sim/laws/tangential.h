#pragma once
// What every tangential law returns, and the law that does nothing.

#include <array>
#include <string_view>

#include "sim/laws/memory.h"
#include "sim/laws/normal.h"
#include "sim/properties.h"

namespace tsubu::sim {

struct TangentialForce {
  V3 force;             ///< on i, N
  double storedBefore;  ///< energy in the memory as it was, J
  double storedAfter;   ///< energy in the memory as it is left, J
  double dashpot;       ///< dissipated by the dashpot in this step, J
  double friction;      ///< dissipated by sliding in this step, J
};

// A tangential law says: does it `act`; does it `needGrowing` stiffness, that of a Hertz contact; is it `passive` (never gives more
// energy than it got); does its force stay `withinLimit`, that of Coulomb; is it `common` enough for kernels of its own for every instruction set.

/// No friction: no tangential force, no torque, no memory.
struct Frictionless {
  static constexpr std::string_view name = "none";
  static constexpr std::string_view sentence = "No friction: grains slide freely and do not turn; no memory.";
  static constexpr std::array<Need, 0> reads{};
  static constexpr bool acts = false, needsGrowing = false, passive = true, withinLimit = true, common = true;
  template <bool growing>
  using Memory = NoMemory<Family::tangential>;
  struct Pair {};
  static Pair prepare(const PairValues&, double, bool) { return {}; }
  static ContactMode mode(const Pair&, double, double, double) { return {}; }
};

}  // namespace tsubu::sim
