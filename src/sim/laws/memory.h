#pragma once
// What a contact may remember. A law names one of these; its numbers lie in the memory columns of the contact lists in this order. What
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
  template <class Real>
  TSUBU_INLINE void carry(V3In<Real>, Real) {}
  template <class F>
  TSUBU_INLINE void each(F&&) {}
};

/// The force (or moment) of a spring in the tangent plane, on j (the opposite of what acts on i).
template <class Real>
struct VectorMemoryIn {
  static constexpr unsigned odd = 0b111;  ///< components that change sign when i and j change places
  V3In<Real> spring;
  TSUBU_INLINE void carry(V3In<Real> n, Real frameAngle) { spring = carried(spring, n, frameAngle); }
  template <class F>
  TSUBU_INLINE void each(F&& f) {
    f(spring.x), f(spring.y), f(spring.z);
  }
};
using VectorMemory = VectorMemoryIn<double>;

/// The same where the stiffness of the spring varies: with the stiffness that the memory belongs to.
template <class Real>
struct GrowingVectorMemoryIn {
  static constexpr unsigned odd = 0b0111;
  V3In<Real> spring;
  Real stiffness;
  TSUBU_INLINE void carry(V3In<Real> n, Real frameAngle) { spring = carried(spring, n, frameAngle); }
  template <class F>
  TSUBU_INLINE void each(F&& f) {
    f(spring.x), f(spring.y), f(spring.z), f(stiffness);
  }
};
using GrowingVectorMemory = GrowingVectorMemoryIn<double>;

/// A spring about n: the moment is n times this for both orders of i and j.
template <class Real>
struct ScalarMemoryIn {
  static constexpr unsigned odd = 0;
  Real spring;
  TSUBU_INLINE void carry(V3In<Real>, Real) {}
  template <class F>
  TSUBU_INLINE void each(F&& f) {
    f(spring);
  }
};
using ScalarMemory = ScalarMemoryIn<double>;
template <class Real>
struct GrowingScalarMemoryIn {
  static constexpr unsigned odd = 0;
  Real spring;
  Real stiffness;
  TSUBU_INLINE void carry(V3In<Real>, Real) {}
  template <class F>
  TSUBU_INLINE void each(F&& f) {
    f(spring), f(stiffness);
  }
};
using GrowingScalarMemory = GrowingScalarMemoryIn<double>;

/// How many numbers a struct of nothing else has.
template <class T, class Real = double>
inline constexpr int numbersIn = std::is_empty_v<T> ? 0 : static_cast<int>(sizeof(T) / sizeof(Real));

// The braces of nested structs are left out: the columns know nothing of them.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmissing-braces"

/// A struct of numbers from columns: member k from column[first + k][q].
template <class T, class Real, class Columns>
TSUBU_INLINE T fromColumns(const Columns& columns, int first, int q) {
  if constexpr (std::is_empty_v<T>) {
    return T{};
  } else {
    return [&]<std::size_t... k>(std::index_sequence<k...>) __attribute__((always_inline)) {
      return T{columns[static_cast<std::size_t>(first) + k][q]...};
    }
    (std::make_index_sequence<static_cast<std::size_t>(numbersIn<T, Real>)>{});
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
template <class Real>
struct Eased {
  Real factor;  ///< of the force
  Real before;  ///< energy before, J
};
template <class Real>
TSUBU_INLINE Eased<Real> eased(const GrowingVectorMemoryIn<Real>& memory, Like<Real> k, Like<Real> rescales) {
  const Real old = larger(memory.stiffness, tinyIn<Real>);
  return {rescales != 0 && k < old ? k / old : 1, Real(0.5) * norm2(memory.spring) / old};
}
template <class Real>
TSUBU_INLINE Eased<Real> eased(const GrowingScalarMemoryIn<Real>& memory, Like<Real> k, Like<Real>) {
  const Real old = larger(memory.stiffness, tinyIn<Real>);
  return {k < old ? k / old : 1, Real(0.5) * memory.spring * memory.spring / old};
}
// A constant spring has nothing to adapt to.
template <class Real>
TSUBU_INLINE Eased<Real> eased(const VectorMemoryIn<Real>& memory, Like<Real> k, Like<Real>) {
  return {1, Real(0.5) * norm2(memory.spring) / larger(k, tinyIn<Real>)};
}
template <class Real>
TSUBU_INLINE Eased<Real> eased(const ScalarMemoryIn<Real>& memory, Like<Real> k, Like<Real>) {
  return {1, Real(0.5) * memory.spring * memory.spring / larger(k, tinyIn<Real>)};
}

template <class Real>
TSUBU_INLINE void setStiffness(GrowingVectorMemoryIn<Real>& memory, Like<Real> k) {
  memory.stiffness = k;
}
template <class Real>
TSUBU_INLINE void setStiffness(GrowingScalarMemoryIn<Real>& memory, Like<Real> k) {
  memory.stiffness = k;
}
template <class Real>
TSUBU_INLINE void setStiffness(VectorMemoryIn<Real>&, Like<Real>) {}
template <class Real>
TSUBU_INLINE void setStiffness(ScalarMemoryIn<Real>&, Like<Real>) {}

}  // namespace tsubu::sim
