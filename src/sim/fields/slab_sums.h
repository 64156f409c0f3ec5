#pragma once
// A loop over all grains, slab by slab on the team, that adds up energies in a fixed order.

#include <algorithm>
#include <vector>

#include "sim/pass.h"

namespace tsubu::sim {

/// What a field does to the grains of a slab in one step.
struct FieldShare {
  double dissipated = 0, work = 0;  ///< J/s
  double strongest = 0;             ///< the largest share of a grain's speed (or spin) that is taken in the step
  std::size_t where = 0;            ///< the grain of that
};

/// Calls each(grain, share) for every grain; returns the sum of the shares, slab by slab.
template <class Each>
FieldShare sumOverGrains(const World& world, std::vector<FieldShare>& shares, Each&& each) {
  shares.assign(static_cast<std::size_t>(world.slabs.count()), FieldShare{});
  world.team.run(world.slabs.count(), [&](int slab, int) {
    FieldShare share;
    for (std::int32_t g = world.slabs.begin(slab); g < world.slabs.end(slab); ++g) each(static_cast<std::size_t>(g), share);
    shares[static_cast<std::size_t>(slab)] = share;
  });
  FieldShare total;
  for (const FieldShare& share : shares) {
    total.dissipated += share.dissipated;
    total.work += share.work;
    if (share.strongest > total.strongest) total.strongest = share.strongest, total.where = share.where;
  }
  return total;
}

}  // namespace tsubu::sim
