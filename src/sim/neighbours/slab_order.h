#pragma once
// In which order slabs are worked on (slabs.h). What is done for a slab writes to it and the next one, so an odd slab waits for its even
// neighbours: whatever the threads do, every grain gets what its even slab adds first. A thread takes blocks of slabs, the same in every
// step, and does an odd slab as soon as it may, while its neighbours lie in the cache.

#include <algorithm>
#include <atomic>
#include <numeric>
#include <vector>

#include "core/thread_team.h"

namespace tsubu::sim {

/// Few, so that what a block works on stays with its thread; enough that no thread waits long for another.
inline constexpr int blocksPerThread = 4;

/// \brief Shares slabs out in blocks of about the same work: where each begins, at an even slab, and the number of slabs at the end.
/// \param work  of each slab, in any unit
inline std::vector<int> shareSlabs(const std::vector<double>& work, int threads) {
  const int count = static_cast<int>(work.size()), blocks = std::min(blocksPerThread * threads, (count + 1) / 2);
  const double each = std::accumulate(work.begin(), work.end(), 0.0) / std::max(blocks, 1);
  std::vector<int> begin;
  double done = 0;
  for (int slab = 0; slab < count; ++slab) {
    const auto begun = static_cast<int>(begin.size());
    if (slab % 2 == 0 && begun < blocks && done >= each * begun) begin.push_back(slab);
    done += work[static_cast<std::size_t>(slab)];
  }
  begin.push_back(count);
  return begin;
}

/// \brief Calls evaluate(slab, thread) once for each slab of the blocks (`begin`: see shareSlabs), an odd one after both its neighbours,
/// and complete(slab, thread) once for each as soon as nothing will be added to it any more and nobody will read it: it and the slab before
/// have been evaluated.
template <class Evaluate, class Complete>
void overSlabs(const std::vector<int>& begin, ThreadTeam& team, const Evaluate& evaluate, const Complete& complete) {
  const int count = begin.back(), blocks = static_cast<int>(begin.size()) - 1;
  const auto firstOf = [&](int block) { return begin[static_cast<std::size_t>(block)]; };
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
