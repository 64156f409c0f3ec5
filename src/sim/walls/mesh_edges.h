#pragma once
// Which triangles meet in which edge of a mesh.

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "core/mesh.h"

namespace tsubu::sim {

/// One side of one triangle. Side k runs from corner k to corner k + 1.
struct TriangleSide {
  int triangle = 0;
  int side = 0;
};

/// The undirected edges of a mesh in ascending order of (lower vertex, higher vertex).
struct MeshEdges {
  struct Edge {
    int a = 0, b = 0;                  ///< vertices, a < b
    std::uint32_t begin = 0, end = 0;  ///< in `sides`, ascending by triangle
    std::uint32_t count() const { return end - begin; }
  };
  std::vector<Edge> edges;
  std::vector<TriangleSide> sides;
  std::vector<std::array<std::uint32_t, 3>> ofTriangle;  ///< index into `edges` of each side of each triangle
};

MeshEdges findMeshEdges(const std::vector<std::array<int, 3>>& triangles);

inline const Vec3& vertexOf(const TriangleMesh& mesh, int vertex) { return mesh.vertices[static_cast<std::size_t>(vertex)]; }
inline const Vec3& vertexOf(const TriangleMesh& mesh, std::array<int, 3> triangle, int corner) {
  return vertexOf(mesh, triangle[static_cast<std::size_t>(corner % 3)]);
}
/// Half the cross product of two sides: normal to the triangle, as long as its area (m²).
inline Vec3 areaVector(const TriangleMesh& mesh, std::array<int, 3> t) {
  return 0.5 * (vertexOf(mesh, t[1]) - vertexOf(mesh, t[0])).cross(vertexOf(mesh, t[2]) - vertexOf(mesh, t[0]));
}
inline double longestSide(const TriangleMesh& mesh, std::array<int, 3> t) {
  double longest = 0;
  for (int k = 0; k < 3; ++k) longest = std::max(longest, (vertexOf(mesh, t, k + 1) - vertexOf(mesh, t, k)).norm());
  return longest;
}

}  // namespace tsubu::sim
