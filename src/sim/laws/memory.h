#pragma once
// What a contact may remember. A law names one of these; its doubles lie in the memory columns of the contact lists in this order. What
// points along the contact is carried with it (T3) before a law sees it.

#include <cstddef>
#include <type_traits>
#include <utility>

#include "sim/laws/arithmetic.h"

namespace tsubu::sim {

/// Nothing: costs nothing. One type for each family, since two empty members of the same type would not share an address.
enum class Family { tangential, rolling, twisting };
template <Family>
struct NoMemory {
  static constexpr unsigned odd = 0;
  TSUBU_INLINE void carry(V3, double) {}
  template <class F>
  TSUBU_INLINE void each(F&&) {}
};

/// The force (or moment) of a spring in the tangent plane, on j (the opposite of what acts on i).
struct VectorMemory {
  static constexpr unsigned odd = 0b111;  ///< components that change sign when i and j change places
  V3 spring;
  TSUBU_INLINE void carry(V3 n, double frameAngle) { spring = carried(spring, n, frameAngle); }
  template <class F>
  TSUBU_INLINE void each(F&& f) { f(spring.x), f(spring.y), f(spring.z); }
};

/// The same where the stiffness of the spring varies: with the stiffness that the memory belongs to.
struct GrowingVectorMemory {
  static constexpr unsigned odd = 0b0111;
  V3 spring;
  double stiffness;
  TSUBU_INLINE void carry(V3 n, double frameAngle) { spring = carried(spring, n, frameAngle); }
  template <class F>
  TSUBU_INLINE void each(F&& f) { f(spring.x), f(spring.y), f(spring.z), f(stiffness); }
};

/// A spring about n: the moment is n times this for both orders of i and j.
struct ScalarMemory {
  static constexpr unsigned odd = 0;
  double spring;
  TSUBU_INLINE void carry(V3, double) {}
  template <class F>
  TSUBU_INLINE void each(F&& f) { f(spring); }
};
struct GrowingScalarMemory {
  static constexpr unsigned odd = 0;
  double spring;
  double stiffness;
  TSUBU_INLINE void carry(V3, double) {}
  template <class F>
  TSUBU_INLINE void each(F&& f) { f(spring), f(stiffness); }
};

/// Number of doubles in a struct of doubles.
template <class T>
inline constexpr int doublesIn = std::is_empty_v<T> ? 0 : static_cast<int>(sizeof(T) / sizeof(double));

// The braces of nested structs are left out: the columns know nothing of them.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmissing-braces"

/// A struct of doubles from columns: member k from column[first + k][q].
template <class T, class Columns>
TSUBU_INLINE T fromColumns(const Columns& columns, int first, int q) {
  if constexpr (std::is_empty_v<T>) {
    return T{};
  } else {
    return [&]<std::size_t... k>(std::index_sequence<k...>) __attribute__((always_inline)) {
      return T{columns[static_cast<std::size_t>(first) + k][q]...};
    }(std::make_index_sequence<static_cast<std::size_t>(doublesIn<T>)>{});
  }
}

#pragma GCC diagnostic pop

/// Most memory that any law keeps for a contact, in doubles.
inline constexpr int mostMemory = 10;

/// A spring whose stiffness varies (Mindlin, and rolling springs on Hertz): what happens to its force and energy when the stiffness
/// goes to k with the grains held still.
///
///   T8   k rises: the force stays, since what touches anew is not stretched;  k falls: the force falls with it
///
/// Neither creates energy: F²/(2k) falls in both. Without the second (`rescales` = 0) it grows whenever the load falls.
struct Eased {
  double factor;  ///< of the force
  double before;  ///< energy before, J
};
TSUBU_INLINE Eased eased(const GrowingVectorMemory& memory, double k, double rescales) {
  const double old = larger(memory.stiffness, tiny);
  return {rescales != 0 && k < old ? k / old : 1.0, 0.5 * norm2(memory.spring) / old};
}
TSUBU_INLINE Eased eased(const GrowingScalarMemory& memory, double k, double) {
  const double old = larger(memory.stiffness, tiny);
  return {k < old ? k / old : 1.0, 0.5 * memory.spring * memory.spring / old};
}
// A constant spring has nothing to adapt to.
TSUBU_INLINE Eased eased(const VectorMemory& memory, double k, double) { return {1.0, 0.5 * norm2(memory.spring) / larger(k, tiny)}; }
TSUBU_INLINE Eased eased(const ScalarMemory& memory, double k, double) { return {1.0, 0.5 * memory.spring * memory.spring / larger(k, tiny)}; }

TSUBU_INLINE void setStiffness(GrowingVectorMemory& memory, double k) { memory.stiffness = k; }
TSUBU_INLINE void setStiffness(GrowingScalarMemory& memory, double k) { memory.stiffness = k; }
TSUBU_INLINE void setStiffness(VectorMemory&, double) {}
TSUBU_INLINE void setStiffness(ScalarMemory&, double) {}

}  // namespace tsubu::sim
