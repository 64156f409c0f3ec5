#include "sim/insertion/sphere_grid.h"

namespace tsubu::sim {

namespace {
constexpr std::size_t mostLevels = 16;
}

SphereGrid::SphereGrid(const Box& bounds, double largest, std::size_t count) : bounds_(bounds), largest_(largest), count_(count) {
  levels_.resize(1);
  levels_[0] = makeLevel(largest);
  levels_[0].head.clear();  // filled when the first sphere of its size comes
}

SphereGrid::Level SphereGrid::makeLevel(double largest) const {
  Level level;
  level.largest = largest;
  level.origin = bounds_.min();
  const Vec3 size = bounds_.sizes().cwiseMax(1e-300);
  // A box that is nearly empty must not cost memory for its emptiness: not many more cells than spheres.
  const double cellsAllowed = 4.0 * static_cast<double>(count_) + 64;
  double edge = std::max(2 * largest, size.maxCoeff() / 1e6);
  const auto cellsWith = [&size](double e) { return ((size / e).array().floor() + 1).prod(); };
  while (cellsWith(edge) > cellsAllowed) edge *= 1.26;
  level.inverseEdge = 1 / edge;
  for (std::size_t k = 0; k < 3; ++k) level.cells[k] = static_cast<int>(size[static_cast<int>(k)] / edge) + 1;
  level.head.assign(
      static_cast<std::size_t>(level.cells[0]) * static_cast<std::size_t>(level.cells[1]) * static_cast<std::size_t>(level.cells[2]), none);
  return level;
}

std::size_t SphereGrid::levelOf(double radius) const {
  std::size_t level = 0;
  for (double limit = largest_ / 2; radius <= limit && level + 1 < mostLevels; limit /= 2) ++level;
  return level;
}

void SphereGrid::insert(std::uint32_t sphere, const Vec3& centre, double radius) {
  const std::size_t l = levelOf(radius);
  if (l >= levels_.size()) levels_.resize(l + 1);
  Level& level = levels_[l];
  if (level.head.empty()) level = makeLevel(largest_ / static_cast<double>(1 << l));
  if (sphere >= next_.size()) next_.resize(std::max<std::size_t>(sphere + 1, next_.size() * 2));
  std::uint32_t& head = level.head[level.index(level.cellOf(centre))];
  next_[sphere] = head;
  head = sphere;
}

std::size_t SphereGrid::coarseCell(const Vec3& centre) const { return levels_[0].index(levels_[0].cellOf(centre)); }

}  // namespace tsubu::sim
