#include "sim/neighbours/slab_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

#include "core/random.h"

namespace tsubu::sim {
namespace {

/// When something began and ended, on a clock that counts such moments; how often it was done.
struct Span {
  std::atomic<int> began{0}, ended{0}, times{0};
};

// Whatever the threads do: an odd slab after both its neighbours, and a slab is complete after all that adds to it or reads it, once.
TEST(SlabOrder, OddSlabsWaitForBothNeighbours) {
  for (const int threads : {1, 2, 3, 8}) {
    ThreadTeam team(threads);
    for (int count = 0; count <= 70; count += count < 20 ? 1 : 7) {
      SCOPED_TRACE(std::to_string(count) + " slabs, " + std::to_string(threads) + " threads");
      const auto slabs = static_cast<std::size_t>(count);
      std::vector<Span> evaluated(slabs), completed(slabs);
      std::atomic<int> clock{0};
      const auto note = [&](std::vector<Span>& spans, int slab, std::uint64_t what) {
        Span& span = spans[static_cast<std::size_t>(slab)];
        span.began = ++clock;
        Random random(7, what, static_cast<std::uint64_t>(slab));
        for (int n = static_cast<int>(random.uniform(0, 4)); n > 0; --n) std::this_thread::yield();  // some slabs take longer than others
        span.ended = ++clock;
        ++span.times;
      };
      std::vector<double> work(slabs);
      for (std::size_t k = 0; k < slabs; ++k) work[k] = k % 9 < 4 ? 0 : Random(8, k).uniform(0, 10);
      overSlabs(
          shareSlabs(work, threads), team, [&](int slab, int) { note(evaluated, slab, 1); },
          [&](int slab, int) { note(completed, slab, 2); });
      for (std::size_t k = 0; k < slabs; ++k) {
        EXPECT_EQ(evaluated[k].times, 1);
        EXPECT_EQ(completed[k].times, 1);
        EXPECT_GT(completed[k].began, evaluated[k].ended);
        if (k == 0) continue;
        EXPECT_GT(completed[k].began, evaluated[k - 1].ended);
        if (k % 2 == 1) {
          EXPECT_GT(evaluated[k].began, evaluated[k - 1].ended);
          if (k + 1 < slabs) {
            EXPECT_GT(evaluated[k].began, evaluated[k + 1].ended);
          }
        }
      }
    }
  }
}

// Grains fall at one end and lie at the other: no block has much more to do than another, and all slabs are in one.
TEST(SlabOrder, BlocksHaveAboutTheSameWork) {
  for (const int threads : {1, 2, 5}) {
    std::vector<double> work;
    for (int slab = 0; slab < 61; ++slab) work.push_back(slab < 30 ? 10 : 50 * (slab - 29));
    const std::vector<int> begin = shareSlabs(work, threads);
    ASSERT_EQ(begin.front(), 0);
    ASSERT_EQ(begin.back(), 61);
    ASSERT_LE(begin.size(), static_cast<std::size_t>(blocksPerThread * threads) + 1);
    ASSERT_GT(begin.size(), static_cast<std::size_t>(2 * threads));
    double total = 0, most = 0;
    for (std::size_t b = 0; b + 1 < begin.size(); ++b) {
      ASSERT_LT(begin[b], begin[b + 1]);
      EXPECT_EQ(begin[b] % 2, 0);
      double own = 0;
      for (int slab = begin[b]; slab < begin[b + 1]; ++slab) own += work[static_cast<std::size_t>(slab)];
      total += own, most = std::max(most, own);
    }
    EXPECT_LE(most, total / (blocksPerThread * threads) + 2 * work.back());  // a block ends at an even slab
  }
  EXPECT_EQ(shareSlabs({}, 2), std::vector<int>{0});
  EXPECT_EQ(shareSlabs({0, 0, 0}, 2), (std::vector<int>{0, 2, 3}));
}

// One thread goes back and forth among neighbours, which lie in its cache, and not through all even slabs first.
TEST(SlabOrder, OneThreadGoesThroughNeighboursTogether) {
  ThreadTeam team(1);
  std::vector<int> order;
  overSlabs(
      shareSlabs(std::vector<double>(9, 1.0), 1), team, [&](int slab, int) { order.push_back(slab); }, [](int, int) {});
  for (std::size_t n = 1; n < order.size(); ++n) EXPECT_LE(std::abs(order[n] - order[n - 1]), 3) << n;
}

}  // namespace
}  // namespace tsubu::sim
