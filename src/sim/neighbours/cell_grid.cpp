#include "sim/neighbours/cell_grid.h"

#include <algorithm>
#include <cmath>

namespace tsubu::sim {

namespace {
// More cells than this per grain are empty ones; larger cells are always correct.
constexpr double mostCellsPerGrain = 8;
constexpr double leastCells = 4096;

std::int64_t clampedCell(double coordinate, std::int64_t cells) {
  return static_cast<std::int64_t>(std::clamp(coordinate, 0.0, static_cast<double>(cells - 1)));
}
}  // namespace

int CellGrid::level(double radius) const {
  int level = 0;
  for (double edge = finest_; edge < 2 * radius + reach_; edge *= 2) ++level;
  return level;
}

void CellGrid::build(const std::vector<GrainRow>& rows, double reach, const std::vector<double>& skins) {
  rows_ = &rows;
  radius_.resize(rows.size());
  for (std::size_t g = 0; g < rows.size(); ++g) radius_[g] = rows[g].radius + (skins.empty() ? 0 : skins[g]);
  reach_ = reach;
  largest_ = 0;
  levels_.clear();
  if (rows.empty()) return;
  const double smallest = *std::min_element(radius_.begin(), radius_.end());
  largest_ = *std::max_element(radius_.begin(), radius_.end());
  // A spread below 1.5 is served best by one level.
  finest_ = 2 * (largest_ < 1.5 * smallest ? largest_ : smallest) + reach;
  std::vector<std::vector<std::int32_t>> members(static_cast<std::size_t>(level(largest_)) + 1);
  for (std::size_t g = 0; g < rows.size(); ++g)
    members[static_cast<std::size_t>(level(radius_[g]))].push_back(static_cast<std::int32_t>(g));
  levels_.resize(members.size());
  double edge = finest_;
  for (std::size_t l = 0; l < members.size(); ++l, edge *= 2) {
    levels_[l].edge = edge;
    fill(levels_[l], members[l]);
  }
}

void CellGrid::fill(Level& level, const std::vector<std::int32_t>& members) const {
  if (members.empty()) return;
  Box box;
  for (const std::int32_t g : members) {
    const GrainRow& row = (*rows_)[static_cast<std::size_t>(g)];
    box.extend(Vec3(row.x, row.y, row.z));
  }
  const Vec3 extent = box.sizes();
  const double most = std::max(leastCells, mostCellsPerGrain * static_cast<double>(members.size()));
  const auto cells = [&](int axis) { return std::floor(extent[axis] / level.edge) + 1; };
  while (cells(0) * cells(1) * cells(2) > most) level.edge *= 1.25;
  level.origin = box.min();
  level.nx = static_cast<std::int64_t>(cells(0));
  level.ny = static_cast<std::int64_t>(cells(1));
  level.nz = static_cast<std::int64_t>(cells(2));
  const auto cellOf = [&](std::int32_t g) {
    const GrainRow& row = (*rows_)[static_cast<std::size_t>(g)];
    const auto cx = clampedCell((row.x - level.origin.x()) / level.edge, level.nx);
    const auto cy = clampedCell((row.y - level.origin.y()) / level.edge, level.ny);
    const auto cz = clampedCell((row.z - level.origin.z()) / level.edge, level.nz);
    return static_cast<std::size_t>((cz * level.ny + cy) * level.nx + cx);
  };
  level.start.assign(static_cast<std::size_t>(level.nx * level.ny * level.nz) + 1, 0);
  for (const std::int32_t g : members) ++level.start[cellOf(g) + 1];
  for (std::size_t c = 1; c < level.start.size(); ++c) level.start[c] += level.start[c - 1];
  std::vector<std::int32_t> next(level.start.begin(), level.start.end() - 1);
  level.entries.resize(members.size());
  for (const std::int32_t g : members) level.entries[static_cast<std::size_t>(next[cellOf(g)]++)] = g;
}

template <class Visit>
void CellGrid::visitRuns(const Level& level, const Vec3& x, double radius, Visit&& visit) const {
  if (level.entries.empty()) return;
  // The centres of this level's grains within reach: a cube around x of this half edge.
  const double half = radius + 0.5 * level.edge + 0.5 * reach_;
  const Vec3 low = (x - level.origin - Vec3::Constant(half)) / level.edge, high = (x - level.origin + Vec3::Constant(half)) / level.edge;
  if (!(high.minCoeff() >= 0 && low.x() < static_cast<double>(level.nx) && low.y() < static_cast<double>(level.ny) &&
        low.z() < static_cast<double>(level.nz)))
    return;
  const auto x0 = clampedCell(low.x(), level.nx), x1 = clampedCell(high.x(), level.nx);
  const auto y0 = clampedCell(low.y(), level.ny), y1 = clampedCell(high.y(), level.ny);
  const auto z0 = clampedCell(low.z(), level.nz), z1 = clampedCell(high.z(), level.nz);
  for (auto cz = z0; cz <= z1; ++cz) {
    for (auto cy = y0; cy <= y1; ++cy) {
      const std::int64_t line = (cz * level.ny + cy) * level.nx;
      visit(level.start[static_cast<std::size_t>(line + x0)], level.start[static_cast<std::size_t>(line + x1 + 1)]);
    }
  }
}

void CellGrid::near(const Vec3& x, double radius, std::int32_t self, std::vector<std::int32_t>& found) const {
  for (const Level& level : levels_) {
    visitRuns(level, x, radius, [&](std::int32_t first, std::int32_t last) {
      for (std::int32_t e = first; e < last; ++e) {
        const std::int32_t j = level.entries[static_cast<std::size_t>(e)];
        if (j == self) continue;
        const GrainRow& other = (*rows_)[static_cast<std::size_t>(j)];
        const double cut = radius + radius_[static_cast<std::size_t>(j)] + reach_;
        const double dx = x.x() - other.x, dy = x.y() - other.y, dz = x.z() - other.z;
        if (dx * dx + dy * dy + dz * dz < cut * cut) found.push_back(j);
      }
    });
  }
}

std::size_t CellGrid::partners(const Vec3& x, double radius, std::int32_t self, std::vector<std::int32_t>& found, std::size_t count) const {
  const auto own = static_cast<std::size_t>(level(radius));
  for (std::size_t l = own; l < levels_.size(); ++l) {
    const Level& level = levels_[l];
    const std::int32_t beyond = l == own ? self : -1;
    visitRuns(level, x, radius, [&](std::int32_t first, std::int32_t last) {
      const auto length = static_cast<std::size_t>(last - first);
      if (found.size() < count + length) found.resize(2 * (count + length));
      // Without a branch: which numbers are higher cannot be foreseen.
      for (std::int32_t e = first; e < last; ++e) {
        const std::int32_t j = level.entries[static_cast<std::size_t>(e)];
        found[count] = j;
        count += j > beyond;
      }
    });
  }
  return count;
}

}  // namespace tsubu::sim
