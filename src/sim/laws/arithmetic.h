#pragma once
// The arithmetic in which contact laws are written: three numbers and what one does with them. Plain functions of plain numbers
// without branches, so that the compiler turns a loop over contacts into vector code, and the same line serves one contact and
// eight. Always inlined: the kernels are compiled once for each instruction set, and no copy of a function may leak between them.

#include <cmath>
#include <type_traits>

#define TSUBU_LAW [[gnu::always_inline]] static inline
#define TSUBU_INLINE [[gnu::always_inline]] inline

namespace tsubu::sim {

/// Three numbers. Laws are written for any `Real`: double is what a simulation is made of, float what its contacts may be computed in
/// (docs/decisions/0012-precision.md).
template <class Real>
struct V3In {
  Real x, y, z;
};
using V3 = V3In<double>;

/// A number that takes its type from the other arguments.
template <class Real>
using Like = std::type_identity_t<Real>;

template <class Real>
TSUBU_INLINE V3In<Real> operator+(V3In<Real> a, V3In<Real> b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class Real>
TSUBU_INLINE V3In<Real> operator-(V3In<Real> a, V3In<Real> b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class Real>
TSUBU_INLINE V3In<Real> operator-(V3In<Real> a) {
  return {-a.x, -a.y, -a.z};
}
template <class Real>
TSUBU_INLINE V3In<Real> operator*(Like<Real> s, V3In<Real> a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <class Real>
TSUBU_INLINE Real dot(V3In<Real> a, V3In<Real> b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class Real>
TSUBU_INLINE V3In<Real> cross(V3In<Real> a, V3In<Real> b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class Real>
TSUBU_INLINE Real norm2(V3In<Real> a) {
  return dot(a, a);
}
template <class Real>
TSUBU_INLINE Real norm(V3In<Real> a) {
  return std::sqrt(norm2(a));
}
template <class Real>
TSUBU_INLINE Real smaller(Real a, Like<Real> b) {
  return a < b ? a : b;
}
template <class Real>
TSUBU_INLINE Real larger(Real a, Like<Real> b) {
  return a > b ? a : b;
}
template <class Real>
TSUBU_INLINE V3In<Real> select(bool which, V3In<Real> yes, V3In<Real> no) {
  return {which ? yes.x : no.x, which ? yes.y : no.y, which ? yes.z : no.z};
}

/// Smallest divisor: keeps 0/0 out of contacts that have no direction. Below any square of a force or length that matters.
template <class Real>
inline constexpr Real tinyIn = 1e-200;
template <>
inline constexpr float tinyIn<float> = 1e-37F;
inline constexpr double tiny = tinyIn<double>;

/// limit/√square: the root and the division side by side, where one after the other would be twice as long to wait for.
template <class Real>
TSUBU_INLINE Real shareOf(Real limit, Like<Real> square) {
  return limit * (std::sqrt(square) * (1 / larger(square, tinyIn<Real>)));
}

/// A vector that lives in the tangent plane of a contact (spring force, rolling moment), carried along while the contact turns:
/// turned about n with a mean spin of the two bodies, laid into the present tangent plane, length unchanged. Before that it is too long
/// by √(1 + ε), ε = φ² − (1 + φ²)(a·n)²/a². The series of 1/√(1 + ε) is off by 3e-13 where a contact turns by less than 0.01 rad in a
/// step and never too long: a root less on the longest chain of the step.
template <class Real>
TSUBU_INLINE V3In<Real> carried(V3In<Real> a, V3In<Real> n, Like<Real> frameAngle) {
  const Real along = dot(a, n), angle2 = frameAngle * frameAngle;
  const V3In<Real> laid = a + frameAngle * cross(n, a) - along * n;
  const Real e = smaller(angle2 - (1 + angle2) * (along * along * (1 / larger(norm2(a), tinyIn<Real>))), 1);
  return (1 + e * (Real(-1.0 / 2) + e * (Real(3.0 / 8) + e * Real(-5.0 / 16)))) * laid;
}

}  // namespace tsubu::sim
