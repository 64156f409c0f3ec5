// Which number of threads wins, when steps take what is made up here.

#include "core/thread_choice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>

#include "core/random.h"

namespace tsubu {
namespace {

/// Steps through a choice; `cost` gives s for a number of threads. Returns how many steps had which number.
std::map<int, int> stepsBy(ThreadChoice& choice, int steps, const std::function<double(int)>& cost) {
  std::map<int, int> by;
  for (int k = 0; k < steps; ++k) {
    ++by[choice.threads()];
    choice.took(choice.listens() ? cost(choice.threads()) : 0);
  }
  return by;
}

/// With which number most of some hundred steps are taken: now and then there is a trial.
int usual(ThreadChoice& choice, const std::function<double(int)>& cost) {
  const std::map<int, int> by = stepsBy(choice, 400, cost);
  return std::max_element(by.begin(), by.end(), [](const auto& a, const auto& b) { return a.second < b.second; })->first;
}

/// Work that is shared, and a price for each thread that takes part.
std::function<double(int)> shared(double work, double price) {
  return [=](int threads) { return work / threads + price * (threads - 1); };
}

TEST(ThreadChoice, TakesOneForLittleWork) {
  for (const int most : {2, 3, 8, 64}) {
    ThreadChoice choice(most);
    stepsBy(choice, 4000, shared(5e-6, 3e-6));
    EXPECT_GT(stepsBy(choice, 100000, shared(5e-6, 3e-6))[1], 99500) << most;  // and hardly tries another any more
  }
}

TEST(ThreadChoice, TakesAllForMuchWork) {
  for (const int most : {2, 3, 8, 64}) {
    ThreadChoice choice(most);
    EXPECT_GT(stepsBy(choice, 100000, shared(1e-2, 1e-6))[most], 99600) << most;
  }
}

TEST(ThreadChoice, FindsTheBestBetween) {
  ThreadChoice choice(64);  // 100/n + (n − 1): best at 10; half and double of 8 are worse
  stepsBy(choice, 20000, shared(100e-6, 1e-6));
  EXPECT_EQ(usual(choice, shared(100e-6, 1e-6)), 8);
}

TEST(ThreadChoice, FollowsWorkThatGrowsAndShrinks) {
  ThreadChoice choice(4);
  stepsBy(choice, 20000, shared(2e-6, 3e-6));
  EXPECT_EQ(usual(choice, shared(2e-6, 3e-6)), 1);
  stepsBy(choice, 60000, shared(1e-3, 3e-6));
  EXPECT_EQ(usual(choice, shared(1e-3, 3e-6)), 4);
  stepsBy(choice, 60000, shared(2e-6, 3e-6));
  EXPECT_EQ(usual(choice, shared(2e-6, 3e-6)), 1);
}

// Steps that make lists anew take ten times as long, others vary by a tenth: that changes nothing.
TEST(ThreadChoice, IsNotLedByOutliers) {
  Random random(3, 1);
  for (const double work : {5e-6, 1e-2}) {
    ThreadChoice choice(2);
    const auto cost = [&, plain = shared(work, 3e-6)](int threads) {
      return plain(threads) * random.uniform(0.95, 1.05) * (random.uniform() < 0.05 ? 10 : 1);
    };
    stepsBy(choice, 1000, cost);
    const int best = work < 1e-3 ? 1 : 2;
    EXPECT_GT(stepsBy(choice, 200000, cost)[best], 199000);
  }
}

TEST(ThreadChoice, OfOneThreadTimesNothing) {
  ThreadChoice choice(1);
  for (int k = 0; k < 1000; ++k) {
    EXPECT_FALSE(choice.listens());
    EXPECT_EQ(choice.threads(), 1);
    choice.took(0);
  }
}

}  // namespace
}  // namespace tsubu
