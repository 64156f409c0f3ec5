#pragma once
// Who stands close to a grain and hides the sky from it.

#include <cstdint>
#include <span>
#include <vector>

#include "core/vec.h"

namespace tsubu::render {

/// A sphere that hides part of the sky from a grain, seen from the grain's centre.
struct Occluder {
  Vec3 offset;    ///< m, from centre to centre
  double radius;  ///< m
  std::uint32_t grain;
};

/// Grains sorted into cells, one grid for each factor of two in radius, so that a wide range of sizes costs little.
class NeighbourGrid {
 public:
  NeighbourGrid(std::span<const Vec3> centres, std::span<const double> radii);

  /// The spheres whose surface is nearer to the surface of a sphere (centre, radius) than their own radius, except number `self`.
  void near(const Vec3& centre, double radius, std::uint32_t self, std::vector<Occluder>& found) const;

 private:
  struct Cell {
    std::int32_t x, y, z;

    bool operator==(const Cell&) const = default;
  };
  struct Entry {
    Cell cell;
    std::uint32_t grain;
  };
  /// Grains with radii up to `largest`, in cells of 2·largest, sorted by the hash of the cell.
  struct Level {
    double largest = 0;
    std::vector<Entry> entries;
    std::vector<std::uint32_t> starts;  ///< first entry by hash, and the end
  };

  void compare(const Entry& entry, const Vec3& centre, double radius, std::uint32_t self, std::vector<Occluder>& found) const;
  static Cell cellOf(const Vec3& position, double size);
  static std::uint32_t hashOf(const Cell& cell, std::size_t buckets);
  void fill(Level& level, const std::vector<std::uint32_t>& members);

  std::span<const Vec3> centres_;
  std::span<const double> radii_;
  std::vector<Level> levels_;
};

}  // namespace tsubu::render
