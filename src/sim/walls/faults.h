#pragma once
// What can be wrong with a mesh, and what was done about it.

#include <cstdint>
#include <string>
#include <vector>

namespace tsubu::sim {

enum class MeshFaultKind : std::uint8_t {
  badIndex,             ///< a triangle names a vertex that does not exist
  notFinite,            ///< a vertex is not a number or infinite
  empty,                ///< no triangle with an area is left
  degenerate,           ///< a triangle without area
  duplicate,            ///< a triangle that repeats another one
  tJoint,               ///< a vertex inside the edge of another triangle
  sliver,               ///< a triangle more than ten thousand times longer than wide
  nonManifold,          ///< three or more triangles meet in one edge
  inconsistentWinding,  ///< neighbours that run around their common edge in the same direction
  overlap,              ///< coplanar triangles that cover the same area
};

enum class MeshRemedy : std::uint8_t {
  harmless,  ///< the mesh is used as it is: the contact rule does not mind
  repaired,  ///< the mesh was changed without changing its shape
  refused,   ///< the mesh cannot be a wall
};

/// All the triangles of a mesh that suffer from one kind of fault.
struct MeshFault {
  MeshFaultKind kind;
  MeshRemedy remedy;
  std::vector<int> triangles;  ///< indices in the mesh as it was read, ascending, each once
  std::string sentence;        ///< names the mesh, the triangles and the remedy
};

}  // namespace tsubu::sim
