#pragma once
// Triangles out of mesh files: STL (text and binary), OBJ, PLY, glTF and GLB.

#include <filesystem>

#include "core/mesh.h"

namespace tsubu::io {

/// All the triangles of a file, in the order of the file, with the placements of its nodes applied and polygons cut into triangles.
/// Lengths are those of the file (m unless the caller scales them); materials, normals and loose points and lines are ignored.
/// The mesh is named after the path. Safe to call from several threads at once; the locale does not matter.
/// Throws Error (files), naming the file, when it cannot be read, is of an unknown format, holds no triangles or a polygon that cannot
/// be cut, or when a triangle has a vertex that is not a finite number or does not exist.
TriangleMesh readMesh(const std::filesystem::path& path);

}  // namespace tsubu::io
