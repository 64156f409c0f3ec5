#pragma once
// Coplanar triangles that cover the same area.

#include <utility>
#include <vector>

#include "core/mesh.h"

namespace tsubu::sim {

/// Pairs (i, j), i < j, ascending, of triangles whose vertices lie within `flat` (m) of one plane and which share more than a
/// common border: in no direction of the plane are they less than 4·flat deep in each other. Triangles more than a hundred times
/// longer than wide are left out of the search: thousands of them lie across each other's boxes, and little area is at stake.
std::vector<std::pair<int, int>> findOverlaps(const TriangleMesh& mesh, double flat);

}  // namespace tsubu::sim
