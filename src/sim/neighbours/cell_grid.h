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
  /// \param skins  m: by which the radius of each grain counts as larger; empty: nothing
  void build(const std::vector<GrainRow>& rows, double reach, const std::vector<float>& skins = {});

  /// Appends all grains j with |x_j − x| < r + r_j + s_j + reach, except `self`, in no particular order. Positions are those of `build`.
  void near(const Vec3& x, double radius, std::int32_t self, std::vector<std::int32_t>& found) const;

  /// Writes to the beginning of `found` those of them that make a pair with grain `self` (at x, where it lay in `build`, `radius` with its skin) not
  /// yet seen from the other side: in the level of its radius those behind it in the order of the cells, in coarser levels all, in finer ones
  /// none. Returns how many; `found` grows as needed.
  std::size_t partners(const Vec3& x, double radius, std::int32_t self, std::vector<std::int32_t>& found) const;

  /// m: how far from a point a sphere of this radius may meet a listed partner.
  double farthest(double radius) const { return radius + largest_ + reach_; }

 private:
  /// Number of the level a radius belongs to.
  int level(double radius) const;

  struct Ball {
    double x, y, z, radius;
  };
  struct Level {
    double largest = 0;                // radius of the grains in it, m
    double edge = 0;                   // of a cell, m
    Vec3 origin = Vec3::Zero();
    std::int64_t nx = 0, ny = 0, nz = 0;
    std::vector<std::int32_t> start;   // first entry of each cell
    std::vector<Ball> balls;           // the entries, and their numbers
    std::vector<std::int32_t> numbers;
  };
  void fill(Level& level, const std::vector<std::int32_t>& members, const std::vector<GrainRow>& rows, const std::vector<double>& radii);
  /// Calls visit(first, last) for runs of entries from `start` on; the grains of the level near x are among them.
  template <class Visit>
  void visitRuns(const Level& level, const Vec3& x, double radius, std::int32_t start, Visit&& visit) const;
  /// Appends to `count` grains that are found already those from entry `start` on, except `self`.
  std::size_t nearIn(const Level& level, const Vec3& x, double radius, std::int32_t start, std::int32_t self, std::vector<std::int32_t>& found,
                     std::size_t count) const;

  double reach_ = 0;
  double largest_ = 0;  // radius, skin included
  double finest_ = 0;   // largest radius of level 0
  std::vector<Level> levels_;
  std::vector<std::int32_t> entry_;  // of each grain, in its level
};

}  // namespace tsubu::sim
