#pragma once
// Functions whose last bit does not depend on the processor (docs/decisions/0006). Those of the C library for double do: glibc has variants
// with fused multiply–add and chooses when a program starts. Worked out in more digits than are kept, they round to the same double,
// but for one argument in thousands. For what is set up, or worked out once a step: they are slower.

#include <cmath>

#include "core/vec.h"

namespace tsubu::portable {

inline double exp(double x) { return static_cast<double>(std::exp(static_cast<long double>(x))); }
inline double log(double x) { return static_cast<double>(std::log(static_cast<long double>(x))); }
inline double sin(double x) { return static_cast<double>(std::sin(static_cast<long double>(x))); }
inline double cos(double x) { return static_cast<double>(std::cos(static_cast<long double>(x))); }
inline double tan(double x) { return static_cast<double>(std::tan(static_cast<long double>(x))); }
inline double cbrt(double x) { return static_cast<double>(std::cbrt(static_cast<long double>(x))); }
inline double atan2(double y, double x) {
  return static_cast<double>(std::atan2(static_cast<long double>(y), static_cast<long double>(x)));
}

/// A turn by an angle (rad) about a direction of length 1.
inline Quat turnBy(double angle, const Vec3& direction) {
  const Vec3 v = sin(0.5 * angle) * direction;
  return {cos(0.5 * angle), v.x(), v.y(), v.z()};
}

}  // namespace tsubu::portable
