#pragma once
// Grains sorted into slabs along the longest axis. A slab is at least as thick as the farthest contact reaches, so a contact joins
// neighbours at most: slab k writes only to k and k + 1, and an odd slab waits for its even neighbours (slab_order.h). The layout depends
// on the grains alone and never on the number of threads.

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "core/thread_team.h"
#include "core/vec.h"
#include "sim/grain_rows.h"

namespace tsubu::sim {

struct Slabs {
  std::vector<std::int32_t> first;  ///< first grain of each slab, and the number of grains at the end

  int count() const { return static_cast<int>(first.size()) - 1; }
  std::int32_t begin(int slab) const { return first[static_cast<std::size_t>(slab)]; }
  /// The slab of a grain.
  int of(std::int32_t grain) const { return static_cast<int>(std::upper_bound(first.begin(), first.end(), grain) - first.begin()) - 1; }
  std::int32_t end(int slab) const { return first[static_cast<std::size_t>(slab) + 1]; }
};

/// The axes of a box from its shortest side to its longest. Grains follow each other along the shortest: the partners of one are then not
/// far from it in the order.
std::array<int, 3> axesByExtent(const Vec3& extent);

/// \brief The order in which grains are to lie in memory: by slab, then by cells within the slab, then as they were.
/// \param reach  m: the farthest distance of the centres of a listed pair
/// \param order  filled: new place → old place
Slabs sortIntoSlabs(const std::vector<GrainRow>& rows, double reach, std::vector<std::int32_t>& order, ThreadTeam& team);

}  // namespace tsubu::sim
