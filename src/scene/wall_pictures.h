#pragma once
// Walls as they are drawn.

#include <vector>

#include "core/mesh.h"
#include "core/vec.h"
#include "render/style.h"
#include "scene/description.h"

namespace tsubu::scene {

/// The mesh of a wall in metres, where it stands at time 0. Throws Error(files) when it cannot be read.
TriangleMesh placedMesh(const Scene& scene, const Wall& wall, const MeshShape& shape);

/// \brief The visible part of an endless plane.
/// A square of the given size around its point; without a size, what `bounds` (m, of all there is to see) leaves of it, cut off where
/// other resting planes end the space of the grains. A ground reaches far beyond.
TriangleMesh drawnPlane(const Scene& scene, const Wall& wall, const PlaneShape& shape, const Box& bounds);

/// The look, with "auto" decided.
render::WallLook lookOf(const Scene& scene, const Wall& wall);

}  // namespace tsubu::scene
