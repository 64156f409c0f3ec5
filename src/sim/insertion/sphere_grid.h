#pragma once
// Which spheres are near a place, for spheres of very different sizes: one grid for each factor of two in radius, so that a large
// sphere does not force the small ones into large cells.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/vec.h"

namespace tsubu::sim {

class SphereGrid {
 public:
  /// For about `count` spheres with centres in `bounds` and radii up to `largest` (m). Centres outside go into the cells at the border,
  /// where they are found as long as those who look for them are outside no farther.
  SphereGrid(const Box& bounds, double largest, std::size_t count);

  /// Spheres are known by the numbers 0, 1, …, each inserted at most once.
  void insert(std::uint32_t sphere, const Vec3& centre, double radius);

  /// Calls visit(sphere) for each sphere whose centre may be nearer to `centre` than (its radius + `radius`) × `stretch`.
  template <class Visit>
  void visitNear(const Vec3& centre, double radius, double stretch, Visit&& visit) const {
    for (const Level& level : levels_) {
      if (level.head.empty()) continue;
      const double reach = (radius + level.largest) * stretch;
      const auto low = level.cellOf(centre - Vec3::Constant(reach)), high = level.cellOf(centre + Vec3::Constant(reach));
      for (int z = low[2]; z <= high[2]; ++z) {
        for (int y = low[1]; y <= high[1]; ++y) {
          for (int x = low[0]; x <= high[0]; ++x) {
            for (std::uint32_t s = level.head[level.index({x, y, z})]; s != none; s = next_[s]) visit(s);
          }
        }
      }
    }
  }

  /// The cell of the coarsest grid that a place belongs to: neighbours in space are mostly neighbours in this order.
  std::size_t coarseCell(const Vec3& centre) const;

 private:
  static constexpr std::uint32_t none = 0xFFFFFFFF;

  struct Level {
    double largest = 0;  // radius
    Vec3 origin;
    double inverseEdge = 0;
    std::array<int, 3> cells{};
    std::vector<std::uint32_t> head;

    std::array<int, 3> cellOf(const Vec3& p) const {
      std::array<int, 3> cell;
      for (std::size_t k = 0; k < 3; ++k) {
        const double q = (p[static_cast<int>(k)] - origin[static_cast<int>(k)]) * inverseEdge;
        cell[k] = static_cast<int>(std::clamp(q, 0.0, cells[k] - 1.0));
      }
      return cell;
    }
    std::size_t index(const std::array<int, 3>& c) const {
      return (static_cast<std::size_t>(c[2]) * static_cast<std::size_t>(cells[1]) + static_cast<std::size_t>(c[1])) *
                 static_cast<std::size_t>(cells[0]) +
             static_cast<std::size_t>(c[0]);
    }
  };

  std::size_t levelOf(double radius) const;
  Level makeLevel(double largest) const;

  Box bounds_;
  double largest_;
  std::size_t count_;
  std::vector<Level> levels_;
  std::vector<std::uint32_t> next_;
};

}  // namespace tsubu::sim
