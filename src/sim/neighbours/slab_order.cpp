#include "sim/neighbours/slab_order.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tsubu::sim {

SlabOrder orderSlabs(const std::vector<double>& work, int threads) {
  SlabOrder order;
  order.slabs = static_cast<int>(work.size());
  order.begin.push_back(0);
  const int evens = (order.slabs + 1) / 2;
  const double total = std::accumulate(work.begin(), work.end(), 0.0);
  // A cut comes after so many even slabs; half of the odd slab there counts for each side.
  int first = 0;
  double before = 0;  // work of the slabs before the next even one
  int last = 0;
  for (int thread = 0; thread < threads; ++thread) {
    const double aim = total * (thread + 1) / threads;
    const auto workOf = [&](int slab) { return slab < order.slabs ? work[static_cast<std::size_t>(slab)] : 0.0; };
    while (last < evens) {
      const double even = workOf(2 * last), odd = workOf(2 * last + 1);
      const double without = before - (last > 0 ? 0.5 * workOf(2 * last - 1) : 0.0), with = before + even + 0.5 * odd;
      if (thread + 1 < threads && std::abs(with - aim) > std::abs(without - aim)) break;
      before += even + odd;
      ++last;
    }
    const bool between = first < last && last < evens;
    if (between) order.tasks.push_back(2 * (last - 1));
    for (int even = first; even < last - between; ++even) order.tasks.push_back(2 * even);
    if (between) order.tasks.push_back(2 * last - 1);
    order.begin.push_back(static_cast<int>(order.tasks.size()));
    first = last;
  }
  return order;
}

}  // namespace tsubu::sim
