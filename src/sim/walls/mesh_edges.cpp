#include "sim/walls/mesh_edges.h"

#include <algorithm>
#include <tuple>

namespace tsubu::sim {

MeshEdges findMeshEdges(const std::vector<std::array<int, 3>>& triangles) {
  struct Entry {
    int a, b;
    TriangleSide side;
  };
  std::vector<Entry> entries;
  entries.reserve(3 * triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int from = triangles[t][static_cast<std::size_t>(k)], to = triangles[t][static_cast<std::size_t>((k + 1) % 3)];
      entries.push_back({std::min(from, to), std::max(from, to), {static_cast<int>(t), k}});
    }
  }
  std::sort(entries.begin(), entries.end(), [](const Entry& x, const Entry& y) {
    return std::tie(x.a, x.b, x.side.triangle, x.side.side) < std::tie(y.a, y.b, y.side.triangle, y.side.side);
  });

  MeshEdges result;
  result.ofTriangle.resize(triangles.size());
  result.sides.reserve(entries.size());
  for (const Entry& entry : entries) {
    if (result.edges.empty() || result.edges.back().a != entry.a || result.edges.back().b != entry.b) {
      const auto at = static_cast<std::uint32_t>(result.sides.size());
      result.edges.push_back({entry.a, entry.b, at, at});
    }
    result.sides.push_back(entry.side);
    ++result.edges.back().end;
    result.ofTriangle[static_cast<std::size_t>(entry.side.triangle)][static_cast<std::size_t>(entry.side.side)] =
        static_cast<std::uint32_t>(result.edges.size() - 1);
  }
  return result;
}

}  // namespace tsubu::sim
