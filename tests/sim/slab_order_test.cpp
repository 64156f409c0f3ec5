#include "sim/neighbours/slab_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <numeric>
#include <string>
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
          orderSlabs(work, threads), team, [&](int slab, int) { note(evaluated, slab, 1); },
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

// Grains fall at one end and lie at the other: no thread has much more to do than another, and every slab is done.
TEST(SlabOrder, ThreadsHaveAboutTheSameWork) {
  for (const int threads : {1, 2, 3, 5}) {
    for (const int slabs : {37, 38, 39, 40, 61}) {
      SCOPED_TRACE(std::to_string(slabs) + " slabs, " + std::to_string(threads) + " threads");
      std::vector<double> work;
      for (int slab = 0; slab < slabs; ++slab) work.push_back(slab < 10 ? 10 : 50 + slab);
      const SlabOrder order = orderSlabs(work, threads);
      ASSERT_EQ(order.begin.size(), static_cast<std::size_t>(threads) + 1);
      ASSERT_EQ(order.begin.back(), static_cast<int>(order.tasks.size()));
      // Of each thread: the even slabs, and the odd ones between them; what lies between two threads goes to who has less to do.
      std::vector<double> own(static_cast<std::size_t>(threads), 0);
      std::vector<int> owner(static_cast<std::size_t>(slabs), -1);
      for (std::size_t t = 0; t < own.size(); ++t)
        for (int n = order.begin[t]; n < order.begin[t + 1]; ++n)
          if (const int slab = order.tasks[static_cast<std::size_t>(n)]; slab % 2 == 0)
            owner[static_cast<std::size_t>(slab)] = static_cast<int>(t);
      int between = 0;
      for (std::size_t slab = 0; slab < owner.size(); slab += 2) {
        ASSERT_GE(owner[slab], 0);
        own[static_cast<std::size_t>(owner[slab])] += work[slab];
      }
      for (std::size_t odd = 1; odd < owner.size(); odd += 2) {
        const int low = owner[odd - 1], high = odd + 1 < owner.size() ? owner[odd + 1] : low;
        ASSERT_LE(low, high);
        const bool isTask = std::count(order.tasks.begin(), order.tasks.end(), static_cast<int>(odd)) == 1;
        EXPECT_EQ(isTask, low != high) << odd;
        between += low != high;
        const int to = own[static_cast<std::size_t>(low)] < own[static_cast<std::size_t>(high)] ? low : high;
        own[static_cast<std::size_t>(to)] += work[odd];
      }
      EXPECT_EQ(between, threads - 1);
      const double total = std::accumulate(work.begin(), work.end(), 0.0);
      EXPECT_LE(*std::max_element(own.begin(), own.end()), total / threads + (threads > 2 ? 1.5 : 1.0) * work.back());
    }
  }
}

// The slab between two threads is left for the end, and its neighbours are done first: nobody waits for it.
TEST(SlabOrder, TwoThreadsBeginAtTheSlabBetweenThem) {
  const SlabOrder order = orderSlabs(std::vector<double>(38, 1.0), 2);
  EXPECT_EQ(order.tasks, (std::vector<int>{18, 0, 2, 4, 6, 8, 10, 12, 14, 16, 19, 20, 22, 24, 26, 28, 30, 32, 34, 36}));
  EXPECT_EQ(order.begin, (std::vector<int>{0, 11, 20}));
}

TEST(SlabOrder, MoreThreadsThanSlabs) {
  EXPECT_TRUE(orderSlabs({}, 2).tasks.empty());
  EXPECT_EQ(orderSlabs({}, 2).begin, (std::vector<int>{0, 0, 0}));
  for (const double work : {0.0, 1.0}) {
    const SlabOrder order = orderSlabs({work, work, work}, 5);
    EXPECT_EQ(order.begin.size(), 6U);
    EXPECT_EQ(std::count(order.tasks.begin(), order.tasks.end(), 0), 1);
    EXPECT_EQ(std::count(order.tasks.begin(), order.tasks.end(), 2), 1);
  }
}

// One thread goes back and forth among neighbours, which lie in its cache, and not through all even slabs first.
TEST(SlabOrder, OneThreadGoesThroughNeighboursTogether) {
  ThreadTeam team(1);
  std::vector<int> order;
  overSlabs(
      orderSlabs(std::vector<double>(9, 1.0), 1), team, [&](int slab, int) { order.push_back(slab); }, [](int, int) {});
  for (std::size_t n = 1; n < order.size(); ++n) EXPECT_LE(std::abs(order[n] - order[n - 1]), 3) << n;
}

}  // namespace
}  // namespace tsubu::sim
