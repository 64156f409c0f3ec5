#include "sim/neighbours/cell_grid.h"

#include <algorithm>
#include <cmath>

#include "sim/kernel/grain_kernels.h"
#include "sim/kernel/kernels.h"
#include "sim/neighbours/slabs.h"

namespace tsubu::sim {

namespace {
// More cells than this per grain are empty ones; larger cells are always correct.
constexpr double mostCellsPerGrain = 8;
constexpr double leastCells = 4096;
// Largest radius of the finest level over the smallest there is.
constexpr double levelSpread = 1.25;
// What the loops may read behind the last entry.
constexpr std::size_t roomBehind = 7;

std::int64_t clampedCell(double coordinate, std::int64_t cells) {
  return static_cast<std::int64_t>(std::clamp(coordinate, 0.0, static_cast<double>(cells - 1)));
}
}  // namespace

int CellGrid::level(double radius) const {
  int level = 0;
  for (double largest = finest_; largest < radius; largest *= 2) ++level;
  return level;
}

void CellGrid::build(const std::vector<GrainRow>& rows, double reach, const std::vector<float>& skins) {
  reach_ = reach;
  largest_ = 0;
  levels_.clear();
  if (rows.empty()) return;
  std::vector<double> radii(rows.size());
  for (std::size_t g = 0; g < rows.size(); ++g) radii[g] = rows[g].radius + (skins.empty() ? 0 : skins[g]);
  const double smallest = *std::min_element(radii.begin(), radii.end());
  largest_ = *std::max_element(radii.begin(), radii.end());
  finest_ = std::max(levelSpread * smallest, 1e-4 * largest_);
  std::vector<std::vector<std::int32_t>> members(static_cast<std::size_t>(level(largest_)) + 1);
  for (std::size_t g = 0; g < rows.size(); ++g) members[static_cast<std::size_t>(level(radii[g]))].push_back(static_cast<std::int32_t>(g));
  levels_.resize(members.size());
  for (std::size_t l = 0; l < members.size(); ++l) fill(levels_[l], members[l], rows, radii);
}

void CellGrid::fill(Level& level, const std::vector<std::int32_t>& members, const std::vector<GrainRow>& rows,
                    const std::vector<double>& radii) {
  if (members.empty()) return;
  Box box;
  for (const std::int32_t g : members) {
    const GrainRow& row = rows[static_cast<std::size_t>(g)];
    box.extend(Vec3(row.x, row.y, row.z));
    level.largest = std::max(level.largest, radii[static_cast<std::size_t>(g)]);
  }
  level.axes = axesByExtent(box.sizes());
  const auto along = [&](const Vec3& v) { return Vec3(v[level.axes[0]], v[level.axes[1]], v[level.axes[2]]); };
  const Vec3 extent = along(box.sizes());
  const double most = std::max(leastCells, mostCellsPerGrain * static_cast<double>(members.size()));
  double edge = 2 * level.largest + reach_;
  const auto cells = [&](int axis) { return std::floor(extent[axis] / edge) + 1; };
  while (cells(0) * cells(1) * cells(2) > most) edge *= 1.25;
  level.origin = along(box.min());
  // Along the longest side cells are as thick as slabs: those of equal grains lie in the same order.
  const double layers = std::max(1.0, std::floor(extent[2] / (edge * (1 + 1e-9))));
  level.cells = {static_cast<std::int64_t>(cells(0)), static_cast<std::int64_t>(cells(1)), static_cast<std::int64_t>(layers)};
  level.perEdge = Vec3(edge, edge, std::max(extent[2] / layers, edge)).cwiseInverse();
  std::vector<std::int32_t> cell(members.size());
  level.start.assign(static_cast<std::size_t>(level.cells[0] * level.cells[1] * level.cells[2]) + 1, 0);
  for (std::size_t m = 0; m < members.size(); ++m) {
    const GrainRow& row = rows[static_cast<std::size_t>(members[m])];
    const Vec3 at = (along(Vec3(row.x, row.y, row.z)) - level.origin).cwiseProduct(level.perEdge);
    const auto u = clampedCell(at[0], level.cells[0]), v = clampedCell(at[1], level.cells[1]), w = clampedCell(at[2], level.cells[2]);
    cell[m] = static_cast<std::int32_t>((w * level.cells[1] + v) * level.cells[0] + u);
    ++level.start[static_cast<std::size_t>(cell[m]) + 1];
  }
  for (std::size_t c = 1; c < level.start.size(); ++c) level.start[c] += level.start[c - 1];
  std::vector<std::int32_t> next(level.start.begin(), level.start.end() - 1);
  for (auto* column : {&level.x, &level.y, &level.z, &level.radius}) column->resize(members.size() + roomBehind);
  level.number.resize(members.size() + roomBehind);
  for (std::size_t m = 0; m < members.size(); ++m) {
    const auto e = static_cast<std::size_t>(next[static_cast<std::size_t>(cell[m])]++), g = static_cast<std::size_t>(members[m]);
    level.x[e] = rows[g].x, level.y[e] = rows[g].y, level.z[e] = rows[g].z, level.radius[e] = radii[g];
    level.number[e] = members[m];
  }
  level.ascending = std::is_sorted(level.number.begin(), level.number.begin() + static_cast<std::ptrdiff_t>(members.size()));
}

template <class Visit>
void CellGrid::visitRuns(const Level& level, const Vec3& x, double radius, Visit&& visit) const {
  if (level.number.empty()) return;
  // The centres of this level's grains within reach: a cube around x of this half edge; a little more, for what rounding does to cells.
  const double half = (radius + level.largest + reach_) * (1 + 1e-9);
  std::array<std::int64_t, 3> low{}, high{};
  for (std::size_t k = 0; k < 3; ++k) {
    const int axis = static_cast<int>(k);
    const double middle = x[level.axes[k]] - level.origin[axis];
    const double from = (middle - half) * level.perEdge[axis], to = (middle + half) * level.perEdge[axis];
    if (!(to >= 0 && from < static_cast<double>(level.cells[k]))) return;
    low[k] = clampedCell(from, level.cells[k]), high[k] = clampedCell(to, level.cells[k]);
  }
  for (auto w = low[2]; w <= high[2]; ++w) {
    for (auto v = low[1]; v <= high[1]; ++v) {
      const std::int64_t line = (w * level.cells[1] + v) * level.cells[0];
      const std::int32_t first = level.start[static_cast<std::size_t>(line + low[0])],
                         last = level.start[static_cast<std::size_t>(line + high[0] + 1)];
      if (last > first) visit(first, last);
    }
  }
}

std::size_t CellGrid::nearIn(const Level& level, const Vec3& x, double radius, std::int32_t after, std::vector<std::int32_t>& found,
                             std::size_t count) const {
  const BallColumns balls{level.x.data(), level.y.data(), level.z.data(), level.radius.data(), level.number.data()};
  const double ball[4] = {x.x(), x.y(), x.z(), radius + reach_};
  constexpr int mostRuns = 32;
  BallRun runs[mostRuns];
  int waiting = 0;
  std::size_t grains = 0;
  const auto look = [&] {
    if (found.size() < count + grains + roomBehind) found.resize(2 * (count + grains) + roomBehind);
    count += static_cast<std::size_t>(kernels().grains->nearBalls(balls, runs, waiting, ball, after, found.data() + count));
    waiting = 0, grains = 0;
  };
  visitRuns(level, x, radius, [&](std::int32_t first, std::int32_t last) {
    if (level.ascending && level.number[static_cast<std::size_t>(last - 1)] <= after) return;
    if (waiting == mostRuns) look();
    runs[waiting++] = {first, last};
    grains += static_cast<std::size_t>(last - first);
  });
  if (waiting > 0) look();
  return count;
}

void CellGrid::near(const Vec3& x, double radius, std::int32_t self, std::vector<std::int32_t>& found) const {
  const std::size_t before = found.size();
  std::size_t count = before;
  for (const Level& level : levels_) count = nearIn(level, x, radius, -1, found, count);
  found.resize(count);
  found.erase(std::remove(found.begin() + static_cast<std::ptrdiff_t>(before), found.end(), self), found.end());
}

std::size_t CellGrid::partners(const Vec3& x, double radius, std::int32_t self, std::vector<std::int32_t>& found) const {
  std::size_t count = 0;
  for (const Level& level : levels_) count = nearIn(level, x, radius, self, found, count);
  return count;
}

}  // namespace tsubu::sim
