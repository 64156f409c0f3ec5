#include "sim/neighbours/slabs.h"

#include <algorithm>
#include <array>
#include <utility>

namespace tsubu::sim {

namespace {

constexpr int mostSlabs = 256;      // three of them in the cache of a core, as far as that goes; few enough for full slabs
constexpr double mostCells = 4096;  // per axis, within a slab

struct Keyed {
  std::uint64_t key;
  std::int32_t place;
};

// Stable, eleven bits at a time.
void radixSort(std::vector<Keyed>& items, std::uint64_t largest) {
  std::vector<Keyed> other(items.size());
  for (int shift = 0; shift < 64 && (largest >> shift) > 0; shift += 11) {
    std::array<std::size_t, 2049> start{};
    for (const Keyed& item : items) ++start[((item.key >> shift) & 2047) + 1];
    for (std::size_t b = 1; b < start.size(); ++b) start[b] += start[b - 1];
    for (const Keyed& item : items) other[start[(item.key >> shift) & 2047]++] = item;
    items.swap(other);
  }
}

}  // namespace

std::array<int, 3> axesByExtent(const Vec3& extent) {
  int longest = 0;
  extent.maxCoeff(&longest);
  int middle = (longest + 1) % 3, shortest = (longest + 2) % 3;
  if (extent[shortest] > extent[middle]) std::swap(middle, shortest);
  return {shortest, middle, longest};
}

Slabs sortIntoSlabs(const std::vector<GrainRow>& rows, double reach, std::vector<std::int32_t>& order, ThreadTeam& team) {
  Box box;
  for (const GrainRow& row : rows) box.extend(Vec3(row.x, row.y, row.z));
  Slabs slabs;
  order.resize(rows.size());
  if (rows.empty()) {
    slabs.first = {0, 0};
    return slabs;
  }
  const Vec3 extent = box.sizes();
  const auto [last, across, along] = axesByExtent(extent);
  // A little more than the reach: rounding must not put a pair into slabs that are not neighbours.
  const double least = reach * (1 + 1e-9);
  const int count = static_cast<int>(std::clamp(std::floor(extent[along] / least), 1.0, static_cast<double>(mostSlabs)));
  const double thickness = std::max(extent[along] / count, least);
  const double cell = std::max({reach, extent[across] / mostCells, extent[last] / mostCells});
  const auto cells = [&](int axis) { return static_cast<std::uint64_t>(extent[axis] / cell) + 1; };
  const std::uint64_t rowsOfCells = cells(across), cellsInRow = cells(last);

  slabs.first.assign(static_cast<std::size_t>(count) + 1, 0);
  std::vector<Keyed> items(rows.size());
  const std::uint64_t cellsInSlab = rowsOfCells * cellsInRow;
  team.runParts(rows.size(), [&, last = last, across = across, along = along](std::size_t from, std::size_t to) {
    for (std::size_t g = from; g < to; ++g) {
      const Vec3 p = Vec3(rows[g].x, rows[g].y, rows[g].z) - box.min();
      const auto slab = std::min<std::uint64_t>(static_cast<std::uint64_t>(p[along] / thickness), static_cast<std::uint64_t>(count - 1));
      const auto u = static_cast<std::uint64_t>(p[across] / cell), v = static_cast<std::uint64_t>(p[last] / cell);
      items[g] = {(slab * rowsOfCells + u) * cellsInRow + v, static_cast<std::int32_t>(g)};
    }
  });
  std::uint64_t largest = 0;
  for (const Keyed& item : items) largest = std::max(largest, item.key);
  radixSort(items, largest);
  for (std::size_t g = 0; g < items.size(); ++g) order[g] = items[g].place;
  const auto isBefore = [](const Keyed& item, std::uint64_t key) { return item.key < key; };
  for (std::size_t s = 0; s < static_cast<std::size_t>(count); ++s)
    slabs.first[s] = static_cast<std::int32_t>(std::lower_bound(items.begin(), items.end(), s * cellsInSlab, isBefore) - items.begin());
  slabs.first.back() = static_cast<std::int32_t>(items.size());
  return slabs;
}

}  // namespace tsubu::sim
