#include "sim/neighbours/cell_grid.h"

#include <algorithm>
#include <cmath>

namespace tsubu::sim {

namespace {
// More cells than this per grain are empty ones; larger cells are always correct.
constexpr double mostCellsPerGrain = 8;
constexpr double leastCells = 4096;
// Largest radius of the finest level over the smallest there is.
constexpr double levelSpread = 1.25;

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
  entry_.resize(rows.size());
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
  const Vec3 extent = box.sizes();
  const double most = std::max(leastCells, mostCellsPerGrain * static_cast<double>(members.size()));
  level.edge = 2 * level.largest + reach_;
  const auto cells = [&](int axis) { return std::floor(extent[axis] / level.edge) + 1; };
  while (cells(0) * cells(1) * cells(2) > most) level.edge *= 1.25;
  level.origin = box.min();
  level.nx = static_cast<std::int64_t>(cells(0));
  level.ny = static_cast<std::int64_t>(cells(1));
  level.nz = static_cast<std::int64_t>(cells(2));
  const double perEdge = 1 / level.edge;
  std::vector<std::int32_t> cell(members.size());
  level.start.assign(static_cast<std::size_t>(level.nx * level.ny * level.nz) + 1, 0);
  for (std::size_t m = 0; m < members.size(); ++m) {
    const GrainRow& row = rows[static_cast<std::size_t>(members[m])];
    const auto cx = clampedCell((row.x - level.origin.x()) * perEdge, level.nx);
    const auto cy = clampedCell((row.y - level.origin.y()) * perEdge, level.ny);
    const auto cz = clampedCell((row.z - level.origin.z()) * perEdge, level.nz);
    cell[m] = static_cast<std::int32_t>((cz * level.ny + cy) * level.nx + cx);
    ++level.start[static_cast<std::size_t>(cell[m]) + 1];
  }
  for (std::size_t c = 1; c < level.start.size(); ++c) level.start[c] += level.start[c - 1];
  std::vector<std::int32_t> next(level.start.begin(), level.start.end() - 1);
  level.balls.resize(members.size());
  level.numbers.resize(members.size());
  for (std::size_t m = 0; m < members.size(); ++m) {
    const auto e = static_cast<std::size_t>(next[static_cast<std::size_t>(cell[m])]++), g = static_cast<std::size_t>(members[m]);
    level.balls[e] = {rows[g].x, rows[g].y, rows[g].z, radii[g]};
    level.numbers[e] = members[m];
    entry_[g] = static_cast<std::int32_t>(e);
  }
}

template <class Visit>
void CellGrid::visitRuns(const Level& level, const Vec3& x, double radius, std::int32_t start, Visit&& visit) const {
  if (level.numbers.empty()) return;
  // The centres of this level's grains within reach: a cube around x of this half edge; a little more, for what rounding does to cells.
  const double half = (radius + level.largest + reach_) * (1 + 1e-9), perEdge = 1 / level.edge;
  const Vec3 low = (x - level.origin - Vec3::Constant(half)) * perEdge, high = (x - level.origin + Vec3::Constant(half)) * perEdge;
  if (!(high.minCoeff() >= 0 && low.x() < static_cast<double>(level.nx) && low.y() < static_cast<double>(level.ny) &&
        low.z() < static_cast<double>(level.nz)))
    return;
  const auto x0 = clampedCell(low.x(), level.nx), x1 = clampedCell(high.x(), level.nx);
  const auto y0 = clampedCell(low.y(), level.ny), y1 = clampedCell(high.y(), level.ny);
  const auto z0 = clampedCell(low.z(), level.nz), z1 = clampedCell(high.z(), level.nz);
  for (auto cz = z0; cz <= z1; ++cz) {
    for (auto cy = y0; cy <= y1; ++cy) {
      const std::int64_t line = (cz * level.ny + cy) * level.nx;
      const std::int32_t last = level.start[static_cast<std::size_t>(line + x1 + 1)];
      if (last > start) visit(std::max(start, level.start[static_cast<std::size_t>(line + x0)]), last);
    }
  }
}

// Without a branch: which are near cannot be foreseen.
std::size_t CellGrid::nearIn(const Level& level, const Vec3& x, double radius, std::int32_t start, std::int32_t self, std::vector<std::int32_t>& found,
                             std::size_t count) const {
  const double x0 = x.x(), x1 = x.y(), x2 = x.z(), own = radius + reach_;
  visitRuns(level, x, radius, start, [&](std::int32_t first, std::int32_t last) {
    const auto length = static_cast<std::size_t>(last - first);
    if (found.size() < count + length) found.resize(2 * (count + length));
    const Ball* const balls = level.balls.data();
    const std::int32_t* const numbers = level.numbers.data();
    std::int32_t* const to = found.data();
    for (std::int32_t e = first; e < last; ++e) {
      const Ball& ball = balls[e];
      const double dx = x0 - ball.x, dy = x1 - ball.y, dz = x2 - ball.z, cut = own + ball.radius;
      to[count] = numbers[e];
      count += static_cast<std::size_t>(dx * dx + dy * dy + dz * dz < cut * cut) & static_cast<std::size_t>(numbers[e] != self);
    }
  });
  return count;
}

void CellGrid::near(const Vec3& x, double radius, std::int32_t self, std::vector<std::int32_t>& found) const {
  std::size_t count = found.size();
  for (const Level& level : levels_) count = nearIn(level, x, radius, 0, self, found, count);
  found.resize(count);
}

std::size_t CellGrid::partners(const Vec3& x, double radius, std::int32_t self, std::vector<std::int32_t>& found) const {
  const auto own = static_cast<std::size_t>(level(radius));
  std::size_t count = nearIn(levels_[own], x, radius, entry_[static_cast<std::size_t>(self)] + 1, self, found, 0);
  for (std::size_t l = own + 1; l < levels_.size(); ++l) count = nearIn(levels_[l], x, radius, 0, self, found, count);
  return count;
}

}  // namespace tsubu::sim
