#include "sim/walls/overlaps.h"

#include <algorithm>
#include <array>

#include "sim/walls/bvh.h"
#include "sim/walls/mesh_edges.h"

namespace tsubu::sim {

namespace {

constexpr double mostSlender = 100;

using Triangle = std::array<Vec3, 3>;

Triangle corners(const TriangleMesh& mesh, std::size_t t) {
  return {vertexOf(mesh, mesh.triangles[t], 0), vertexOf(mesh, mesh.triangles[t], 1), vertexOf(mesh, mesh.triangles[t], 2)};
}

bool lies(const Triangle& triangle, const Vec3& point, const Vec3& normal, double flat) {
  return std::all_of(triangle.begin(), triangle.end(), [&](const Vec3& x) { return std::abs(normal.dot(x - point)) <= flat; });
}

/// How deep the triangles are in each other along one axis; negative when apart.
double depth(const Triangle& a, const Triangle& b, const Vec3& axis) {
  const auto [a0, a1] = std::minmax({axis.dot(a[0]), axis.dot(a[1]), axis.dot(a[2])});
  const auto [b0, b1] = std::minmax({axis.dot(b[0]), axis.dot(b[1]), axis.dot(b[2])});
  return std::min(a1, b1) - std::max(a0, b0);
}

/// Separating axes: two convex figures of a plane are apart along the normal of one of their sides, or not at all.
bool separated(const Triangle& a, const Triangle& b, const Vec3& normal, double enough) {
  for (const Triangle* t : {&a, &b}) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 axis = normal.cross((*t)[(k + 1) % 3] - (*t)[k]).normalized();
      if (depth(a, b, axis) <= enough) return true;
    }
  }
  return false;
}

}  // namespace

std::vector<std::pair<int, int>> findOverlaps(const TriangleMesh& mesh, double flat) {
  const std::size_t count = mesh.triangles.size();
  std::vector<std::size_t> compact;  // the triangles that are looked at
  std::vector<Box> boxes;
  std::vector<Vec3> normals;
  for (std::size_t t = 0; t < count; ++t) {
    const Vec3 area = areaVector(mesh, mesh.triangles[t]);
    const double longest = longestSide(mesh, mesh.triangles[t]);
    if (2 * area.norm() * mostSlender < longest * longest) continue;
    compact.push_back(t);
    normals.push_back(area.normalized());
    boxes.emplace_back();
    for (const Vec3& x : corners(mesh, t)) boxes.back().extend(x);
  }
  const Bvh tree(boxes);
  std::vector<std::pair<int, int>> pairs;
  for (std::size_t i = 0; i < compact.size(); ++i) {
    const Triangle a = corners(mesh, compact[i]);
    tree.overlapping(boxes[i], [&](std::uint32_t j) {
      if (j <= i || std::abs(normals[i].dot(normals[j])) < 0.5) return;
      const Triangle b = corners(mesh, compact[j]);
      const bool coplanar = lies(b, a[0], normals[i], flat) || lies(a, b[0], normals[j], flat);
      if (coplanar && !separated(a, b, normals[i], 4 * flat))
        pairs.emplace_back(static_cast<int>(compact[i]), static_cast<int>(compact[j]));
    });
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace tsubu::sim
