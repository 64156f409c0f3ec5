#pragma once
// The contact grid: which grains are near a point. Cell-linked lists as counting sorts; grains of very different size lie in grids of
// their own (edges doubling), so that a few boulders do not force large cells on the sand.

#include <array>
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

  /// Writes to the beginning of `found` those of them with a number above `self`, in ascending order where grains of equal size lie in the
  /// order of slabs (slabs.h). Returns how many; `found` grows as needed.
  std::size_t partners(const Vec3& x, double radius, std::int32_t self, std::vector<std::int32_t>& found) const;

  /// m: how far from a point a sphere of this radius may meet a listed partner.
  double farthest(double radius) const { return radius + largest_ + reach_; }

 private:
  /// Number of the level a radius belongs to.
  int level(double radius) const;

  /// The grains of a level in the order of its cells, which follow each other along the shortest side of the box around them. In columns,
  /// with room behind the last as the loops want it (kernel/grain_kernels.h).
  struct Level {
    double largest = 0;           // radius of the grains in it, m
    std::array<int, 3> axes{};    // from the shortest side of the box to the longest
    Vec3 origin = Vec3::Zero();   // the corner of the box, along these
    Vec3 perEdge = Vec3::Zero();  // 1/m, of a cell
    std::array<std::int64_t, 3> cells{};
    std::vector<std::int32_t> start;      // first entry of each cell
    std::vector<double> x, y, z, radius;  // of the entries
    std::vector<std::int32_t> number;
    bool ascending = false;  // the numbers
  };
  void fill(Level& level, const std::vector<std::int32_t>& members, const std::vector<GrainRow>& rows, const std::vector<double>& radii);
  /// Calls visit(first, last) for runs of entries; the grains of the level near x are among them.
  template <class Visit>
  void visitRuns(const Level& level, const Vec3& x, double radius, Visit&& visit) const;
  /// Writes behind `count` grains that are found already those with a number above `after`. Returns how many there are now.
  std::size_t nearIn(const Level& level, const Vec3& x, double radius, std::int32_t after, std::vector<std::int32_t>& found,
                     std::size_t count) const;

  double reach_ = 0;
  double largest_ = 0;  // radius, skin included
  double finest_ = 0;   // largest radius of level 0
  std::vector<Level> levels_;
};

}  // namespace tsubu::sim
