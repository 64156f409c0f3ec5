#pragma once
// How large the grains are. Draws use only +, −, ×, ÷ and comparisons, so that every machine draws the same bits.

#include <variant>
#include <vector>

#include "core/random.h"

namespace tsubu::sim {

/// All radii equal, m.
struct ConstantRadius {
  double radius = 0;
  bool operator==(const ConstantRadius&) const = default;
};

/// Radii uniform in [min, max), m.
struct UniformRadius {
  double min = 0, max = 0;
  bool operator==(const UniformRadius&) const = default;
};

/// Radii normal with this mean and deviation, those outside [min, max] drawn anew; min ≤ mean ≤ max. m.
struct NormalRadius {
  double mean = 0, deviation = 0, min = 0, max = 0;
  bool operator==(const NormalRadius&) const = default;
};

/// Some radii, each with its share of the whole MASS (as a sieve analysis gives it). Shares are positive and add up to 1. The number of
/// grains of a radius is in proportion to share / radius³: half the mass at half the radius is eight ninths of the grains.
struct RadiusTable {
  std::vector<double> radii;  ///< m
  std::vector<double> massFractions;
  bool operator==(const RadiusTable&) const = default;
};

struct SizeDistribution {
  std::variant<ConstantRadius, UniformRadius, NormalRadius, RadiusTable> kind;

  double draw(Random& random) const;
  double smallest() const;
  double largest() const;
  /// Mean over the number of grains of r³, m³: an estimate for counting in advance (the normal one by quadrature).
  double meanCube() const;

  bool operator==(const SizeDistribution&) const = default;
};

}  // namespace tsubu::sim
