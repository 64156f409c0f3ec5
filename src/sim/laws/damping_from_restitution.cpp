#include "sim/laws/damping_from_restitution.h"

#include <cmath>
#include <numbers>

#include "core/portable_math.h"

namespace tsubu::sim {

namespace {

constexpr double pi = std::numbers::pi;

// Without tension. The three branches are one smooth function of ζ: with ω² = 1 − ζ² the exponent is (ζ/ω)·angle, where angle runs
// from π down as atan2 follows it through ζ = 1/√2, and becomes its hyperbolic twin above 1. Near ζ = 1 both tend to exponent 2.
double exponentWithoutTension(double zeta) {
  const double w2 = 1 - zeta * zeta;
  if (std::abs(w2) < 1e-10) return 2;
  const double w = std::sqrt(std::abs(w2));
  if (zeta < 1) return zeta / w * (pi - portable::atan2(2 * zeta * w, w2 - zeta * zeta));
  return zeta / w * portable::log((zeta + w) * (zeta + w));  // (ζ+ω)/(ζ−ω) = (ζ+ω)², since (ζ+ω)(ζ−ω) = 1
}

}  // namespace

double restitutionOf(double zeta, bool tension) {
  if (!tension) return portable::exp(-exponentWithoutTension(zeta));
  return zeta < 1 ? portable::exp(-pi * zeta / std::sqrt(1 - zeta * zeta)) : 0.0;
}

double dampingRatio(double restitution, bool tension) {
  if (restitution >= 1) return 0;
  const double l = -portable::log(restitution);
  if (tension) return l / std::sqrt(pi * pi + l * l);
  double low = 0, high = 1;
  while (restitutionOf(high, false) > restitution) high *= 2;
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    (restitutionOf(middle, false) > restitution ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace tsubu::sim
