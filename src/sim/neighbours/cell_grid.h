#pragma once
// The contact grid: which grains are near a point. Cell-linked lists as counting sorts; grains of very different size lie in grids of
// their own (edges doubling), so that a few boulders do not force large cells on the sand.

#include <cstdint>
#include <vector>

#include "core/vec.h"
#include "sim/grain_rows.h"

namespace tsubu::sim {

class CellGrid {
 public:
  /// \param reach  m: pairs are wanted whose surfaces are nearer than this
  void build(const std::vector<GrainRow>& rows, double reach);

  /// Appends all grains j with |x_j − x| < r + r_j + reach, except `self`, in no particular order. Grains in the level of `radius` and
  /// in coarser levels only, unless `all`: searching from the smaller partner of a pair is enough, and cheap.
  void near(const Vec3& x, double radius, std::int32_t self, bool all, std::vector<std::int32_t>& found) const;

  /// m: how far from a point a sphere of this radius may meet a listed partner.
  double farthest(double radius) const { return radius + largest_ + reach_; }

  /// Number of the level a radius belongs to.
  int level(double radius) const;

 private:
  struct Level {
    double edge = 0;                   // of a cell, m; at least the diameter of the grains in it plus the reach
    Vec3 origin = Vec3::Zero();
    std::int64_t nx = 0, ny = 0, nz = 0;
    std::vector<std::int32_t> start;   // first entry of each cell in `entries`
    std::vector<std::int32_t> entries;
  };
  void fill(Level& level, const std::vector<std::int32_t>& members) const;
  void search(const Level& level, const Vec3& x, double radius, std::int32_t self, std::vector<std::int32_t>& found) const;

  const std::vector<GrainRow>* rows_ = nullptr;
  double reach_ = 0;
  double largest_ = 0;  // radius
  double finest_ = 0;  // edge of level 0
  std::vector<Level> levels_;
};

}  // namespace tsubu::sim
