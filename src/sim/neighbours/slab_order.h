#pragma once
// In which order slabs are worked on (slabs.h). What is done for a slab writes to it and the next one, so an odd slab waits for its even
// neighbours: whatever the threads do, every grain gets what its even slab adds first. A thread goes along neighbours, the same in every
// step, and does an odd slab as soon as it may, while its neighbours lie in the cache.

#include <atomic>
#include <vector>

#include "core/thread_team.h"

namespace tsubu::sim {

/// What threads do, and in which order.
struct SlabOrder {
  int slabs = 0;
  /// Slabs to be evaluated: all even ones, and each odd one that lies between two threads. The others are evaluated as soon as they may.
  std::vector<int> tasks;
  std::vector<int> begin;  ///< where the tasks of each thread begin, and their number
};

/// \brief Gives each thread about the same work. It begins at the ends of what it is given: the slab between two threads may then be
/// evaluated early, and is left for the end: of two threads, for the one that is done first.
/// \param work  of each slab, in any unit
SlabOrder orderSlabs(const std::vector<double>& work, int threads);

/// \brief Calls evaluate(slab, thread) once for each slab, an odd one after both its neighbours, and complete(slab, thread) once for each
/// as soon as nothing will be added to it any more and nobody will read it (unless as the owner of an image): it and the slab before have
/// been evaluated.
template <class Evaluate, class Complete>
void overSlabs(const SlabOrder& order, ThreadTeam& team, const Evaluate& evaluate, const Complete& complete) {
  // What an odd slab waits for: its neighbours, and its turn. Whoever comes last does it.
  std::vector<std::atomic<int>> awaited(static_cast<std::size_t>(order.slabs));
  for (int odd = 1; odd < order.slabs; odd += 2) awaited[static_cast<std::size_t>(odd)] = odd + 1 < order.slabs ? 2 : 1;
  for (const int task : order.tasks) ++awaited[static_cast<std::size_t>(task)];
  const auto arriveAt = [&](int odd, int thread) {
    if (odd < 0 || odd >= order.slabs || --awaited[static_cast<std::size_t>(odd)] > 0) return;
    evaluate(odd, thread);
    complete(odd, thread);
    if (odd + 1 < order.slabs) complete(odd + 1, thread);
  };
  team.run(order.begin, [&](int task, int thread) {
    const int slab = order.tasks[static_cast<std::size_t>(task)];
    if (slab % 2 == 1) return arriveAt(slab, thread);
    evaluate(slab, thread);
    if (slab == 0) complete(slab, thread);
    arriveAt(slab - 1, thread);
    arriveAt(slab + 1, thread);
  });
}

}  // namespace tsubu::sim
