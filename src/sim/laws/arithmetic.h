#pragma once
// The arithmetic in which contact laws are written: three doubles and what one does with them. Plain functions of plain doubles
// without branches, so that the compiler turns a loop over contacts into vector code, and the same line serves one contact and
// eight. Always inlined: the kernels are compiled once for each instruction set, and no copy of a function may leak between them.

#include <cmath>

#define TSUBU_LAW [[gnu::always_inline]] static inline
#define TSUBU_INLINE [[gnu::always_inline]] inline

namespace tsubu::sim {

struct V3 {
  double x, y, z;
};

TSUBU_INLINE V3 operator+(V3 a, V3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
TSUBU_INLINE V3 operator-(V3 a, V3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
TSUBU_INLINE V3 operator-(V3 a) { return {-a.x, -a.y, -a.z}; }
TSUBU_INLINE V3 operator*(double s, V3 a) { return {s * a.x, s * a.y, s * a.z}; }
TSUBU_INLINE double dot(V3 a, V3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
TSUBU_INLINE V3 cross(V3 a, V3 b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
TSUBU_INLINE double norm2(V3 a) { return dot(a, a); }
TSUBU_INLINE double norm(V3 a) { return std::sqrt(norm2(a)); }
TSUBU_INLINE double smaller(double a, double b) { return a < b ? a : b; }
TSUBU_INLINE double larger(double a, double b) { return a > b ? a : b; }
TSUBU_INLINE V3 select(bool which, V3 yes, V3 no) { return {which ? yes.x : no.x, which ? yes.y : no.y, which ? yes.z : no.z}; }

/// Smallest divisor: keeps 0/0 out of contacts that have no direction. Below any square of a force or length that matters.
inline constexpr double tiny = 1e-200;

/// limit/√square: the root and the division side by side, where one after the other would be twice as long to wait for.
TSUBU_INLINE double shareOf(double limit, double square) { return limit * (std::sqrt(square) * (1 / larger(square, tiny))); }

/// A vector that lives in the tangent plane of a contact (spring force, rolling moment), carried along while the contact turns:
/// turned about n with a mean spin of the two bodies, laid into the present tangent plane, length unchanged. Before that it is too long
/// by √(1 + ε), ε = φ² − (1 + φ²)(a·n)²/a². The series of 1/√(1 + ε) is off by 3e-13 where a contact turns by less than 0.01 rad in a
/// step and never too long: a root less on the longest chain of the step.
TSUBU_INLINE V3 carried(V3 a, V3 n, double frameAngle) {
  const double along = dot(a, n), angle2 = frameAngle * frameAngle;
  const V3 laid = a + frameAngle * cross(n, a) - along * n;
  const double e = smaller(angle2 - (1 + angle2) * (along * along * (1 / larger(norm2(a), tiny))), 1.0);
  return (1 + e * (-1.0 / 2 + e * (3.0 / 8 + e * (-5.0 / 16)))) * laid;
}

}  // namespace tsubu::sim
