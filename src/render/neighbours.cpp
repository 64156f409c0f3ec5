#include "render/neighbours.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace tsubu::render {

NeighbourGrid::NeighbourGrid(std::span<const Vec3> centres, std::span<const double> radii) : centres_(centres), radii_(radii) {
  if (radii.empty()) return;
  const double smallest = *std::min_element(radii.begin(), radii.end());
  std::vector<std::vector<std::uint32_t>> members;
  for (std::uint32_t k = 0; k < radii.size(); ++k) {
    const auto level = static_cast<std::size_t>(std::max(0, std::ilogb(radii[k] / smallest)));
    if (level >= members.size()) members.resize(level + 1);
    members[level].push_back(k);
  }
  for (const auto& list : members) {
    if (!list.empty()) fill(levels_.emplace_back(), list);
  }
}

NeighbourGrid::Cell NeighbourGrid::cellOf(const Vec3& position, double size) {
  // Grains that far from the origin share the outermost cells; distances are checked anyway.
  const auto index = [&](double v) { return static_cast<std::int32_t>(std::clamp(std::floor(v / size), -1e9, 1e9)); };
  return {index(position.x()), index(position.y()), index(position.z())};
}

std::uint32_t NeighbourGrid::hashOf(const Cell& cell, std::size_t buckets) {
  std::uint32_t h = static_cast<std::uint32_t>(cell.x) * 0x8da6b343u ^ static_cast<std::uint32_t>(cell.y) * 0xd8163841u ^
                    static_cast<std::uint32_t>(cell.z) * 0xcb1ab31fu;
  h ^= h >> 15;
  return h & static_cast<std::uint32_t>(buckets - 1);
}

void NeighbourGrid::fill(Level& level, const std::vector<std::uint32_t>& members) {
  for (const std::uint32_t k : members) level.largest = std::max(level.largest, radii_[k]);
  const std::size_t buckets = std::bit_ceil(2 * members.size());
  level.starts.assign(buckets + 1, 0);
  std::vector<Entry> unsorted;
  std::vector<std::uint32_t> hashes;
  for (const std::uint32_t k : members) {
    unsorted.push_back({cellOf(centres_[k], 2 * level.largest), k});
    hashes.push_back(hashOf(unsorted.back().cell, buckets));
    ++level.starts[hashes.back() + 1];
  }
  for (std::size_t b = 0; b < buckets; ++b) level.starts[b + 1] += level.starts[b];
  level.entries.resize(members.size());
  std::vector<std::uint32_t> next(level.starts.begin(), level.starts.end() - 1);
  for (std::size_t m = 0; m < members.size(); ++m) level.entries[next[hashes[m]]++] = unsorted[m];
}

void NeighbourGrid::compare(const Entry& entry, const Vec3& centre, double radius, std::uint32_t self, std::vector<Occluder>& found) const {
  if (entry.grain == self) return;
  const Vec3 offset = centres_[entry.grain] - centre;
  const double within = radius + 2 * radii_[entry.grain];
  if (offset.squaredNorm() < within * within) found.push_back({offset, radii_[entry.grain], entry.grain});
}

void NeighbourGrid::near(const Vec3& centre, double radius, std::uint32_t self, std::vector<Occluder>& found) const {
  for (const Level& level : levels_) {
    const double size = 2 * level.largest, reach = radius + 2 * level.largest;
    // A grain among much smaller ones may span more cells than there are grains.
    if (std::pow(2 * reach / size, 3) > static_cast<double>(level.entries.size())) {
      for (const Entry& entry : level.entries) compare(entry, centre, radius, self, found);
      continue;
    }
    const Cell low = cellOf(centre - Vec3::Constant(reach), size), high = cellOf(centre + Vec3::Constant(reach), size);
    for (Cell cell{0, 0, low.z}; cell.z <= high.z; ++cell.z) {
      for (cell.y = low.y; cell.y <= high.y; ++cell.y) {
        for (cell.x = low.x; cell.x <= high.x; ++cell.x) {
          const std::uint32_t bucket = hashOf(cell, level.starts.size() - 1);
          for (std::uint32_t e = level.starts[bucket]; e < level.starts[bucket + 1]; ++e) {
            if (level.entries[e].cell == cell) compare(level.entries[e], centre, radius, self, found);
          }
        }
      }
    }
  }
}

}  // namespace tsubu::render
