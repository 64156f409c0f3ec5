#include "core/thread_team.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <string>

namespace tsubu {
namespace {

class ThreadTeamOf : public testing::TestWithParam<int> {};

TEST_P(ThreadTeamOf, TakesEveryTaskOnce) {
  ThreadTeam team(GetParam());
  EXPECT_EQ(team.threads(), GetParam());
  for (const int tasks : {0, 1, 2, 7, 1000}) {
    std::vector<int> taken(static_cast<std::size_t>(tasks), 0);
    std::atomic<bool> known = true;
    team.run(tasks, [&](int task, int thread) {
      ++taken[static_cast<std::size_t>(task)];
      if (thread < 0 || thread >= team.threads()) known = false;
    });
    EXPECT_EQ(taken, std::vector<int>(static_cast<std::size_t>(tasks), 1));
    EXPECT_TRUE(known);
  }
}

// Shares may differ, and be empty; whoever has nothing left takes from others.
TEST_P(ThreadTeamOf, TakesEveryTaskOfGivenShares) {
  ThreadTeam team(GetParam());
  std::vector<int> begin{0};
  for (int thread = 0; thread < team.threads(); ++thread) begin.push_back(begin.back() + (thread % 2 == 0 ? 50 : 0));
  std::vector<int> taken(static_cast<std::size_t>(begin.back()), 0);
  team.run(begin, [&](int task, int) { ++taken[static_cast<std::size_t>(task)]; });
  EXPECT_EQ(taken, std::vector<int>(taken.size(), 1));
  begin.push_back(begin.back());
  EXPECT_THROW(team.run(begin, [](int, int) {}), std::logic_error);
}

TEST_P(ThreadTeamOf, PartsMakeUpTheWhole) {
  ThreadTeam team(GetParam());
  for (const std::size_t size : {0, 1, 999, 2500, 100'001}) {
    std::vector<int> taken(size, 0);
    std::atomic<int> parts = 0;
    team.runParts(size, [&](std::size_t first, std::size_t last) {
      ++parts;
      for (std::size_t k = first; k < last; ++k) ++taken[k];
    });
    EXPECT_EQ(taken, std::vector<int>(size, 1));
    EXPECT_EQ(parts, size > 100'000 ? team.threads() : std::min(team.threads(), size > 2000 ? 2 : 1));
  }
}

// What one run wrote, the next one reads, without a lock: run() returns only when all is done and visible. Under the thread
// sanitizer this is the test that a missing barrier fails.
TEST_P(ThreadTeamOf, EveryRunSeesWhatTheLastOneWrote) {
  constexpr int tasks = 16, rounds = 2000;
  ThreadTeam team(GetParam());
  std::vector<int> here(tasks, 0), there(tasks, 0);
  for (int round = 0; round < rounds; ++round) {
    team.run(tasks, [&](int k, int) { there[static_cast<std::size_t>(k)] = here[static_cast<std::size_t>((k + 1) % tasks)] + 1; });
    std::swap(here, there);
  }
  EXPECT_EQ(here, std::vector<int>(tasks, rounds));
}

TEST_P(ThreadTeamOf, HandsOnAnExceptionAndGoesOn) {
  ThreadTeam team(GetParam());
  for (int round = 0; round < 10; ++round) {
    try {
      team.run(20, [](int task, int) {
        if (task == 13) throw std::runtime_error("task 13");
      });
      FAIL() << "the exception got lost";
    } catch (const std::runtime_error& error) {
      EXPECT_EQ(std::string(error.what()), "task 13");
    }
    std::atomic<int> taken = 0;
    team.run(20, [&](int, int) { ++taken; });
    EXPECT_EQ(taken, 20);
  }
}

TEST_P(ThreadTeamOf, WakesAfterASleep) {
  ThreadTeam team(GetParam());
  for (int round = 0; round < 3; ++round) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));  // longer than it looks for work before sleeping
    std::atomic<int> taken = 0;
    team.run(5, [&](int, int) { ++taken; });
    EXPECT_EQ(taken, 5);
  }
}

// Fewer for a while, and more again; what is left out must not stand in the way of the others, asleep or awake.
TEST_P(ThreadTeamOf, UsesAsManyAsItIsTold) {
  ThreadTeam team(GetParam());
  for (int round = 0; round < 200; ++round) {
    const int used = 1 + round * 7 % team.threads();
    team.use(used);
    if (round % 50 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(20));
    std::vector<int> taken(40, 0);
    std::atomic<int> highest = 0;
    team.run(40, [&](int task, int thread) {
      ++taken[static_cast<std::size_t>(task)];
      int seen = highest.load();
      while (thread > seen && !highest.compare_exchange_weak(seen, thread)) {
      }
    });
    EXPECT_EQ(taken, std::vector<int>(40, 1));
    EXPECT_LT(highest, used);
  }
}

INSTANTIATE_TEST_SUITE_P(Threads, ThreadTeamOf, testing::Values(1, 2, 3, 8));

TEST(ThreadTeam, CanBeMadeAndDroppedIdle) {
  for (int i = 0; i < 100; ++i) ThreadTeam team(4);
}

}  // namespace
}  // namespace tsubu
