#include "render/cull.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/random.h"

namespace tsubu::render {
namespace {

Splat disc(float x, float y, float radius, float front, float back) { return {x, y, radius, x, y, radius, front, back}; }

TEST(Cull, HidesWhatLiesWhollyBehindALargerDisc) {
  const auto shown = notHidden({disc(20, 20, 4, 5, 6), disc(20, 20, 10, 1, 2)}, 40, 40);
  EXPECT_EQ(shown, (std::vector<std::uint32_t>{1}));
}

TEST(Cull, KeepsWhatShowsAtAnEdgeOrStandsInFront) {
  EXPECT_EQ(notHidden({disc(20, 20, 10, 5, 6), disc(20, 20, 10, 1, 2)}, 40, 40).size(), 2u) << "cells at the rim are not wholly covered";
  EXPECT_EQ(notHidden({disc(20, 20, 4, 1.5f, 6), disc(20, 20, 10, 1, 2)}, 40, 40).size(), 2u) << "begins before the other ends";
  EXPECT_EQ(notHidden({disc(34, 20, 4, 5, 6), disc(20, 20, 15, 1, 2)}, 40, 40).size(), 2u);
}

TEST(Cull, LeavesOutWhatIsOutsideTheRaster) {
  EXPECT_TRUE(notHidden({disc(-20, 5, 4, 1, 2), disc(5, 60, 4, 1, 2)}, 40, 40).empty());
  EXPECT_EQ(notHidden({disc(-2, 5, 4, 1, 2)}, 40, 40).size(), 1u);
}

TEST(Cull, ComesFromFrontToBack) {
  EXPECT_EQ(notHidden({disc(5, 5, 2, 3, 4), disc(15, 5, 2, 1, 2), disc(25, 5, 2, 2, 3)}, 40, 40), (std::vector<std::uint32_t>{1, 2, 0}));
}

TEST(Cull, NeverHidesWhatASampleWouldShow) {
  // Random discs at random depths against brute force: at every point of a fine lattice, whatever no covering disc is in front of is shown.
  Random random(1, 1);
  std::vector<Splat> splats;
  for (int k = 0; k < 400; ++k) {
    const auto f = [&](double low, double high) { return static_cast<float>(random.uniform(low, high)); };
    const float depth = f(1, 10);
    splats.push_back(disc(f(-3, 63), f(-3, 43), f(1, 8), depth - 0.3f, depth));
  }
  const auto list = notHidden(splats, 60, 40);
  const std::set<std::uint32_t> shown(list.begin(), list.end());
  EXPECT_LT(shown.size(), splats.size() / 2) << "else it culls nothing";
  for (int y = 0; y < 40 * 4; ++y) {
    for (int x = 0; x < 60 * 4; ++x) {
      const float px = (static_cast<float>(x) + 0.5f) / 4, py = (static_cast<float>(y) + 0.5f) / 4;
      float nearestBack = 1e9f;
      const auto covers = [&](const Splat& s) { return std::hypot(px - s.x, py - s.y) < s.inner; };
      for (const Splat& s : splats) {
        if (covers(s)) nearestBack = std::min(nearestBack, s.back);
      }
      for (std::uint32_t k = 0; k < splats.size(); ++k) {
        const bool visible = covers(splats[k]) && splats[k].front < nearestBack;
        ASSERT_TRUE(!visible || shown.count(k)) << k;
      }
    }
  }
}

}  // namespace
}  // namespace tsubu::render
