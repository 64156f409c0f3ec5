#pragma once
// Triangles as they come from a file: what io reads, sim turns into faces, and render draws.

#include <array>
#include <string>
#include <vector>

#include "core/vec.h"

namespace tsubu {

struct TriangleMesh {
  std::string name;                           ///< for messages: the path, or the name of the wall
  std::vector<Vec3> vertices;                 ///< m, in the frame of the wall
  std::vector<std::array<int, 3>> triangles;  ///< indices into `vertices`; triangle t is "triangle t" in every message
};

}  // namespace tsubu
