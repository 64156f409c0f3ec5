#pragma once
// What every tangential law returns.

#include <array>
#include <string_view>

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

/// No friction: no tangential force, no torque, no memory.
struct Frictionless {
  static constexpr std::string_view name = "none";
  static constexpr std::string_view sentence = "No friction: grains slide freely and do not turn; no memory.";
  static constexpr std::array<Need, 0> reads{};
  static constexpr int stateSize = 0;
  static constexpr bool acts = false;
  struct Pair {};
  static Pair prepare(const PropertyValues&, double) { return {}; }
  static ContactMode mode(const Pair&, double, double) { return {}; }
};

}  // namespace tsubu::sim
