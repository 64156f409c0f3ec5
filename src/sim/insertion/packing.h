#pragma once
// Spheres at random places in a region, without overlap, up to the density of random packings.
//
// Large spheres are placed first, each at the first free place of some tries, or at the least bad one. That settles thin packings. In
// dense ones the overlaps that remain are pushed apart, pair by pair in a fixed order, each pair by its overlap (the smaller sphere
// yields more), with radii a little enlarged so that the last overlaps vanish for good. Jodrey and Tory (1985), and the force-biased
// algorithm of Mościński et al. (1989), are the ancestors. Serial, keyed random numbers, +−×÷√ only: the same bits everywhere.

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "sim/insertion/region.h"
#include "sim/insertion/size_distribution.h"

namespace tsubu::sim {

/// How much to pack: exactly one is given.
struct PackingAmount {
  std::optional<std::uint64_t> count;
  std::optional<double> volume;  ///< m³ of all spheres together
};

/// Radii for this amount, in m: `count` of them, or so many that their volume is nearest to the one asked for.
std::vector<double> drawRadii(const SizeDistribution& sizes, const PackingAmount& amount, std::uint64_t seed, std::uint64_t source);

/// \brief Centres (m) for spheres with these radii (m), all inside the region, none overlapping another.
/// `source` tells equal packings of one seed apart. Equal spheres reach a solid fraction of 0.6 when the region is many diameters wide.
/// Throws Error(scene) with the fraction that was reached when the request cannot be met.
std::vector<Vec3> packSpheres(const Region& region, const std::vector<double>& radii, std::uint64_t seed, std::uint64_t source);

/// Two spheres that overlap.
struct Overlap {
  std::uint32_t first = 0, second = 0;
  double depth = 0;  ///< of the smaller radius
};

/// The deepest overlap among spheres, or nothing when there is none deeper than `tolerance` (of the smaller radius).
std::optional<Overlap> deepestOverlap(const std::vector<Vec3>& centres, const std::vector<double>& radii, double tolerance);

}  // namespace tsubu::sim
