#pragma once
// In which order slabs are worked on (slabs.h). What is done for a slab writes to it and the next one, so an odd slab waits for its even
// neighbours: whatever the threads do, every grain gets what its even slab adds first. A thread takes blocks of slabs, the same in every
// step, and does an odd slab as soon as it may, while its neighbours lie in the cache.

#include <algorithm>
#include <atomic>
#include <vector>

#include "core/thread_team.h"

namespace tsubu::sim {

/// Few, so that what a block works on stays with its thread; enough that no thread waits long for another.
inline constexpr int blocksPerThread = 4;

/// \brief Calls evaluate(slab, thread) once for each of `count` slabs, an odd one after both its neighbours, and complete(slab, thread) once
/// for each as soon as nothing will be added to it any more and nobody will read it: it and the slab before have been evaluated.
template <class Evaluate, class Complete>
void overSlabs(int count, ThreadTeam& team, const Evaluate& evaluate, const Complete& complete) {
  const int evens = (count + 1) / 2, blocks = std::min(blocksPerThread * team.threads(), evens);
  const auto firstOf = [&](int block) { return std::min(2 * (evens * block / blocks), count); };
  const auto finish = [&](int odd, int thread) {
    evaluate(odd, thread);
    for (int slab = odd; slab < std::min(odd + 2, count); ++slab) complete(slab, thread);
  };
  // The odd slab at the end of a block waits for the first slab of the next one: whoever comes last does it.
  std::vector<std::atomic<int>> arrived(static_cast<std::size_t>(blocks));
  const auto arriveAtEndOf = [&](int block, int thread) {
    if (arrived[static_cast<std::size_t>(block)].fetch_add(1) == 1) finish(firstOf(block + 1) - 1, thread);
  };
  team.run(blocks, [&](int block, int thread) {
    const int first = firstOf(block), end = firstOf(block + 1);
    for (int even = first; even < end; even += 2) {
      evaluate(even, thread);
      if (even > first) finish(even - 1, thread);
      if (even == first && block > 0) arriveAtEndOf(block - 1, thread);
    }
    if (block == 0 && count > 0) complete(0, thread);
    if (end < count)
      arriveAtEndOf(block, thread);
    else if (end % 2 == 0)
      finish(end - 1, thread);
  });
}

}  // namespace tsubu::sim
