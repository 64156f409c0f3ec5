#pragma once
// What a wall's mesh needs to be drawn: smooth normals where it is curved, lines where it is creased, and what is near to a point.

#include <array>
#include <cstdint>
#include <vector>

#include "core/mesh.h"
#include "core/vec.h"

namespace tsubu::render {

/// A border of the mesh or a crease of more than 20 degrees, in the frame of the wall.
struct FeatureEdge {
  Vec3 a, b;
};

class WallModel {
 public:
  /// Vertices at the same place are joined (STL files repeat them); triangles without area or with indices or coordinates that make no
  /// sense are left out.
  explicit WallModel(const TriangleMesh& mesh);

  struct Triangle {
    std::array<Vec3, 3> corners;
    std::array<Vec3, 3> normals;  ///< of unit length, averaged over neighbours that differ by less than 30 degrees
    Vec3 normal;                  ///< of the face, by the right-hand rule
  };

  const std::vector<Triangle>& triangles() const { return triangles_; }
  const std::vector<FeatureEdge>& edges() const { return edges_; }
  const Box& bounds() const { return bounds_; }

  /// The nearest point of each triangle that is closer than `within` to `point`, appended.
  void closestPoints(const Vec3& point, double within, std::vector<Vec3>& found) const;

 private:
  struct Node {
    Box box;
    std::uint32_t first, count;  ///< triangles of a leaf, or count 0 and the second child (the first follows)
  };

  std::uint32_t buildTree(std::uint32_t first, std::uint32_t count);

  std::vector<Triangle> triangles_;
  std::vector<FeatureEdge> edges_;
  std::vector<Node> tree_;
  std::vector<std::uint32_t> order_;  ///< of triangles in the leaves
  Box bounds_;
};

}  // namespace tsubu::render
