#include "render/neighbours.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/random.h"

namespace tsubu::render {
namespace {

std::vector<std::uint32_t> numbersOf(const std::vector<Occluder>& found) {
  std::vector<std::uint32_t> numbers;
  for (const Occluder& o : found) numbers.push_back(o.grain);
  std::sort(numbers.begin(), numbers.end());
  return numbers;
}

void expectBruteForce(const std::vector<Vec3>& centres, const std::vector<double>& radii) {
  const NeighbourGrid grid(centres, radii);
  std::vector<Occluder> found;
  for (std::uint32_t i = 0; i < centres.size(); ++i) {
    std::vector<std::uint32_t> expected;
    for (std::uint32_t j = 0; j < centres.size(); ++j) {
      if (j != i && (centres[j] - centres[i]).norm() < radii[i] + 2 * radii[j]) expected.push_back(j);
    }
    found.clear();
    grid.near(centres[i], radii[i], i, found);
    ASSERT_EQ(numbersOf(found), expected) << i;
    for (const Occluder& o : found) ASSERT_EQ(o.offset, Vec3(centres[o.grain] - centres[i]));
  }
}

TEST(NeighbourGrid, FindsEachNeighbourOnce) {
  Random random(1, 1);
  std::vector<Vec3> centres;
  std::vector<double> radii;
  for (int k = 0; k < 800; ++k) {
    centres.push_back({random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
    radii.push_back(0.07);
  }
  expectBruteForce(centres, radii);
}

TEST(NeighbourGrid, FindsSmallAndLargeOnes) {
  Random random(2, 1);
  std::vector<Vec3> centres;
  std::vector<double> radii;
  for (int k = 0; k < 600; ++k) {
    centres.push_back({random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
    radii.push_back(random.uniform() < 0.05 ? random.uniform(0.2, 0.4) : random.uniform(0.02, 0.06));
  }
  expectBruteForce(centres, radii);
}

TEST(NeighbourGrid, LivesWithGrainsFarAwayAndWithNone) {
  expectBruteForce({{0, 0, 0}, {1e15, 0, 0}, {0.15, 0, 0}, {-1e15, 3, 1e15}}, {0.1, 0.1, 0.1, 0.1});
  expectBruteForce({}, {});
}

}  // namespace
}  // namespace tsubu::render
