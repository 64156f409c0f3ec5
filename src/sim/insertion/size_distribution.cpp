#include "sim/insertion/size_distribution.h"

#include <algorithm>
#include <cmath>

#include "core/portable_math.h"

namespace tsubu::sim {

namespace {

double drawFrom(const ConstantRadius& d, Random&) { return d.radius; }

double drawFrom(const UniformRadius& d, Random& random) { return random.uniform(d.min, d.max); }

// A cut close to the mean would throw nearly every normal number away; there the density is nearly flat, and uniform numbers kept
// with probability exp(−z²/2) do the same. Either way about every second draw counts at least.
double drawFrom(const NormalRadius& d, Random& random) {
  if (d.deviation <= 0) return d.mean;
  const double below = (d.mean - d.min) / d.deviation, above = (d.max - d.mean) / d.deviation;
  const bool narrow = std::max(below, above) <= 1.4;
  for (;;) {
    if (narrow) {
      const double r = random.uniform(d.min, d.max), z = (r - d.mean) / d.deviation;
      if (random.chanceExp(z * z / 2)) return r;
    } else {
      const double r = d.mean + d.deviation * random.normal();
      if (r >= d.min && r <= d.max) return r;
    }
  }
}

double drawFrom(const RadiusTable& d, Random& random) {
  double total = 0;
  for (std::size_t i = 0; i < d.radii.size(); ++i) total += d.massFractions[i] / (d.radii[i] * d.radii[i] * d.radii[i]);
  double left = total * random.uniform();
  for (std::size_t i = 0; i + 1 < d.radii.size(); ++i) {
    left -= d.massFractions[i] / (d.radii[i] * d.radii[i] * d.radii[i]);
    if (left < 0) return d.radii[i];
  }
  return d.radii.back();
}

struct Range {
  double low, high;
};
Range rangeOf(const ConstantRadius& d) { return {d.radius, d.radius}; }
Range rangeOf(const UniformRadius& d) { return {d.min, d.max}; }
Range rangeOf(const NormalRadius& d) { return {d.min, d.max}; }
Range rangeOf(const RadiusTable& d) {
  const auto [low, high] = std::minmax_element(d.radii.begin(), d.radii.end());
  return {*low, *high};
}

double meanCubeOf(const ConstantRadius& d) { return d.radius * d.radius * d.radius; }
double meanCubeOf(const UniformRadius& d) { return (d.min * d.min + d.max * d.max) * (d.min + d.max) / 4; }

double meanCubeOf(const NormalRadius& d) {
  if (d.deviation <= 0 || d.max <= d.min) return d.mean * d.mean * d.mean;
  // Nothing to integrate beyond eight deviations.
  const double a = std::max(d.min, d.mean - 8 * d.deviation), b = std::min(d.max, d.mean + 8 * d.deviation);
  constexpr int intervals = 400;  // Simpson
  double moment = 0, weight = 0;
  for (int i = 0; i <= intervals; ++i) {
    const double r = a + (b - a) * i / intervals, z = (r - d.mean) / d.deviation;
    const double w = (i == 0 || i == intervals ? 1 : i % 2 ? 4 : 2) * portable::exp(-z * z / 2);
    moment += w * r * r * r;
    weight += w;
  }
  return moment / weight;
}

double meanCubeOf(const RadiusTable& d) {
  double number = 0, mass = 0;
  for (std::size_t i = 0; i < d.radii.size(); ++i) {
    number += d.massFractions[i] / (d.radii[i] * d.radii[i] * d.radii[i]);
    mass += d.massFractions[i];
  }
  return mass / number;
}

}  // namespace

double SizeDistribution::draw(Random& random) const {
  return std::visit([&](const auto& d) { return drawFrom(d, random); }, kind);
}
double SizeDistribution::smallest() const {
  return std::visit([](const auto& d) { return rangeOf(d).low; }, kind);
}
double SizeDistribution::largest() const {
  return std::visit([](const auto& d) { return rangeOf(d).high; }, kind);
}
double SizeDistribution::meanCube() const {
  return std::visit([](const auto& d) { return meanCubeOf(d); }, kind);
}

}  // namespace tsubu::sim
