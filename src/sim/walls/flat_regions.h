#pragma once
// Which triangles of a mesh lie in one plane and hang together.

#include <cstdint>
#include <vector>

#include "core/mesh.h"
#include "sim/walls/mesh_edges.h"
#include "sim/walls/plane.h"

namespace tsubu::sim {

struct FlatRegions {
  std::vector<std::uint32_t> ofTriangle;
  std::vector<Plane> planes;  ///< one per region
  std::vector<Vec3> centres;  ///< m: centre of area of each, in its plane
};

/// Regions grow from the largest triangles over common edges, on to triangles whose vertices all lie within `flat` (m) of the plane
/// of the region; the plane follows the region by weights of area, so that neither slivers nor
/// rounded coordinates turn it. In the end every vertex lies within 2·flat of its plane. A tessellated cylinder is not flat:
/// n facets of radius R rise (2π/n)²·R above each other, far more than `flat` (2.5e-7 of the size) up to n of ten thousand.
FlatRegions findFlatRegions(const TriangleMesh& mesh, const MeshEdges& edges, double flat);

}  // namespace tsubu::sim
