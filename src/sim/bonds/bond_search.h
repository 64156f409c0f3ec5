#pragma once
// Who can be bonded with whom, and what a bond between two grains is like when it is made.

#include <cstdint>
#include <vector>

#include "sim/bonds/bond_law.h"
#include "sim/grain_rows.h"
#include "sim/model.h"
#include "sim/periodic.h"

namespace tsubu::sim {

/// The grains that a search looks at, by place.
struct BondableGrains {
  const std::vector<GrainRow>& rows;
  const std::vector<std::uint32_t>& ids;
  const std::vector<std::uint16_t>& materials;
  const Periods& periods;
};

/// Two places, that of the lower id first.
struct BondedPair {
  std::int32_t i, j;
};

/// A grain and the nearest point of a wall.
struct WallFoot {
  std::int32_t grain;
  Vec3 point;  ///< m, in the world
};

/// All pairs that a kind of bonds would join now: at its ends the right grains, near enough, and drawn when there is a probability, which
/// is keyed by `seed`, the number of the kind, and the two ids.
std::vector<BondedPair> bondablePairs(const Bonding& bonding, std::size_t kind, std::uint64_t seed, const BondableGrains& grains);

/// The same with the wall of the kind, which is at `pose`.
std::vector<WallFoot> bondableFeet(const Bonding& bonding, std::size_t kind, std::uint64_t seed, const BondableGrains& grains,
                                   const Wall& wall, const Pose& pose);

/// One number of two ids or places, the same whichever comes first.
inline std::uint64_t keyOfPair(std::uint32_t a, std::uint32_t b) { return (std::uint64_t{a < b ? a : b} << 32) | (a < b ? b : a); }

/// What has half the reduced mass and inertia of two grains to do with each other: sums of 1/m and 1/I.
struct BondInertia {
  double inverseMass, inverseMoment;
};
BondInertia inertiaOf(const GrainRow& a, const GrainRow& b);

/// A bond of this kind between spheres whose smaller radius is `smaller`, at distance `length`.
BondBody bodyOf(const Bonding& bonding, double smaller, double length, const BondInertia& inertia);

}  // namespace tsubu::sim
