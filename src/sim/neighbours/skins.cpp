#include "sim/neighbours/skins.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "core/vec.h"

namespace tsubu::sim {

namespace {

// Cells in which speeds are compared, in radii of the largest grain: a grain meets nobody from beyond the next one.
constexpr double cellEdge = 4;
constexpr double mostCellsPerGrain = 2, leastCells = 4096;

/// The largest squared speed in each cell of a box around the grains and in the cells next to it.
class SpeedMap {
 public:
  SpeedMap(const std::vector<GrainRow>& rows, ThreadTeam& team) {
    Box box;
    double largest = 0;
    for (const GrainRow& row : rows) {
      box.extend(Vec3(row.x, row.y, row.z));
      largest = std::max(largest, row.radius);
    }
    low_ = box.min();
    edge_ = cellEdge * largest;
    const Vec3 extent = box.sizes();
    const auto cells = [&](int axis) { return std::floor(extent[axis] / edge_) + 1; };
    const double most = std::max(leastCells, mostCellsPerGrain * static_cast<double>(rows.size()));
    while (cells(0) * cells(1) * cells(2) > most) edge_ *= 1.25;
    for (int axis = 0; axis < 3; ++axis) count_[static_cast<std::size_t>(axis)] = static_cast<std::size_t>(cells(axis));
    fastest2_.assign(count_[0] * count_[1] * count_[2], 0.0);
    cells_.resize(rows.size());
    team.runParts(rows.size(), [&](std::size_t first, std::size_t last) {
      for (std::size_t g = first; g < last; ++g) cells_[g] = static_cast<std::uint32_t>(cellOf(rows[g]));
    });
    for (std::size_t g = 0; g < rows.size(); ++g) {
      double& fastest2 = fastest2_[cells_[g]];
      fastest2 = std::max(fastest2, norm2(rows[g].velocity()));
    }
    spread(1, count_[0]);
    spread(count_[0], count_[1]);
    spread(count_[0] * count_[1], count_[2]);
  }

  /// Near a grain.
  double near(std::size_t grain) const { return std::sqrt(fastest2_[cells_[grain]]); }

 private:
  std::size_t cellOf(const GrainRow& row) const {
    const auto along = [&](double x, std::size_t axis) {
      return std::min(static_cast<std::size_t>(std::max(0.0, (x - low_[static_cast<int>(axis)]) / edge_)), count_[axis] - 1);
    };
    return (along(row.z, 2) * count_[1] + along(row.y, 1)) * count_[0] + along(row.x, 0);
  }

  // Lets each cell know of the two beside it along one axis.
  void spread(std::size_t stride, std::size_t count) {
    for (std::size_t start = 0; start < fastest2_.size(); ++start) {
      if (start / stride % count != 0) continue;
      double before = 0;
      for (std::size_t k = 0; k < count; ++k) {
        double& here = fastest2_[start + k * stride];
        const double after = k + 1 < count ? fastest2_[start + (k + 1) * stride] : 0, own = here;
        here = std::max({before, own, after});
        before = own;
      }
    }
  }

  Vec3 low_;
  double edge_ = 0;
  std::array<std::size_t, 3> count_{};
  std::vector<double> fastest2_;
  std::vector<std::uint32_t> cells_;  // of the grains
};

}  // namespace

namespace {

// Towards zero: the bounds are not to be exceeded.
float roundedDown(double positive) {
  const auto near = static_cast<float>(positive);
  return static_cast<double>(near) > positive ? std::nextafter(near, 0.0F) : near;
}

}  // namespace

std::vector<float> chooseSkins(const std::vector<GrainRow>& rows, const SkinRule& rule, ThreadTeam& team) {
  std::vector<float> skins(rows.size(), roundedDown(rule.least));
  if (rows.empty() || !(rule.most > rule.least)) return skins;
  const SpeedMap speeds(rows, team);
  team.runParts(rows.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t g = first; g < last; ++g) skins[g] = roundedDown(std::clamp(rule.time * speeds.near(g), rule.least, rule.most));
  });
  return skins;
}

}  // namespace tsubu::sim
