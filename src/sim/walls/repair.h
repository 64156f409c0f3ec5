#pragma once
// Welding, and finding and mending what is wrong with a mesh.

#include <vector>

#include "core/mesh.h"
#include "sim/walls/faults.h"

namespace tsubu::sim {

/// Vertices nearer than this fraction of the diagonal of the box around the mesh are one vertex. Single precision, in which STL
/// files are written, resolves 6e-8 of the coordinates.
inline constexpr double weldFraction = 1e-7;

/// Vertices may lie this fraction of the diagonal off the plane of their face or the line of their edge.
inline constexpr double flatFraction = 2.5e-7;

struct RepairedMesh {
  TriangleMesh mesh;              ///< every vertex used, every triangle with an area, no two alike
  std::vector<int> source;        ///< the triangle of the original mesh that each came from
  double weldTolerance = 0;       ///< m
  double flatTolerance = 0;       ///< m
  std::vector<MeshFault> faults;  ///< repaired and harmless ones
};

/// Throws Error (files) naming all the faults that cannot be repaired.
RepairedMesh repair(const TriangleMesh& mesh);

}  // namespace tsubu::sim
