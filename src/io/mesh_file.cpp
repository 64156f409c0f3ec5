#include "io/mesh_file.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>
#include <assimp/Importer.hpp>

#include "core/error.h"
#include "io/mesh_complete.h"

namespace tsubu::io {

namespace {

/// `message` goes on after "The mesh file 'x' ".
[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& message, const std::string& hint = {}) {
  throw Error(ErrorKind::files, fmt::format("The mesh file '{}' {}", path.string(), message), hint);
}

std::string extensionOf(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

void checkFormat(const std::filesystem::path& path) {
  for (const char* known : {".stl", ".obj", ".ply", ".gltf", ".glb"})
    if (extensionOf(path) == known) return;
  refuse(path, "is of an unknown format.", "Known are .stl, .obj, .ply, .gltf and .glb.");
}

std::string readBytes(const std::filesystem::path& path) {
  if (std::filesystem::is_directory(path)) refuse(path, "is a directory.");
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) refuse(path, fmt::format("cannot be opened: {}.", std::strerror(errno)));
  std::ostringstream bytes;
  bytes << file.rdbuf();
  return bytes.str();
}

void checkComplete(const std::filesystem::path& path, const std::string& bytes) {
  if (extensionOf(path) == ".stl" && !isCompleteStl(bytes)) refuse(path, "breaks off before its end.");
  if (extensionOf(path) == ".ply" && bytes.starts_with("ply") && !isCompletePly(bytes))
    refuse(path, "breaks off before its end, or its header is not understood.");
}

/// How many triangles the polygons of a scene make.
std::size_t countTriangles(const aiScene& scene) {
  std::size_t count = 0;
  for (unsigned m = 0; m < scene.mNumMeshes; ++m)
    for (unsigned f = 0; f < scene.mMeshes[m]->mNumFaces; ++f)
      if (const unsigned corners = scene.mMeshes[m]->mFaces[f].mNumIndices; corners > 2) count += corners - 2;
  return count;
}

Eigen::Affine3d toEigen(const aiMatrix4x4& m) {
  Eigen::Affine3d result;
  result.matrix() << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, m.d1, m.d2, m.d3, m.d4;
  return result;
}

/// Appends the meshes of a node and of the nodes below it.
void flatten(const aiScene& scene, const aiNode& node, const Eigen::Affine3d& parent, TriangleMesh& result) {
  const Eigen::Affine3d placement = parent * toEigen(node.mTransformation);
  for (unsigned m = 0; m < node.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[node.mMeshes[m]];
    const int first = static_cast<int>(result.vertices.size());
    const int count = static_cast<int>(mesh.mNumVertices);
    for (unsigned v = 0; v < mesh.mNumVertices; ++v)
      result.vertices.push_back(placement * Vec3(mesh.mVertices[v].x, mesh.mVertices[v].y, mesh.mVertices[v].z));
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      if (face.mNumIndices != 3) continue;  // a loose point or line
      std::array<int, 3> triangle;
      for (unsigned k = 0; k < 3; ++k) {
        const int index = static_cast<int>(face.mIndices[k]);
        triangle[k] = index < 0 || index >= count ? -1 : first + index;
      }
      result.triangles.push_back(triangle);
    }
  }
  for (unsigned c = 0; c < node.mNumChildren; ++c) flatten(scene, *node.mChildren[c], placement, result);
}

void checkTriangles(const std::filesystem::path& path, const TriangleMesh& mesh) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const int v : mesh.triangles[t]) {
      if (v < 0) refuse(path, fmt::format("names a vertex that does not exist, in triangle {}.", t));
      if (!mesh.vertices[static_cast<std::size_t>(v)].allFinite())
        refuse(path, fmt::format("has a vertex that is not a finite number, in triangle {}.", t));
    }
  }
}

}  // namespace

TriangleMesh readMesh(const std::filesystem::path& path) {
  checkFormat(path);
  checkComplete(path, readBytes(path));
  // Nothing is joined, sorted or left out on the way: sim welds and repairs, and names what it does.
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(path.string(), 0);
  if (!scene || !scene->mRootNode) refuse(path, fmt::format("cannot be read. Its reader says: {}", importer.GetErrorString()));
  const std::size_t expected = countTriangles(*scene);
  if (expected == 0) refuse(path, "holds no triangles.");
  scene = importer.ApplyPostProcessing(aiProcess_Triangulate);
  if (!scene || countTriangles(*scene) != expected)
    refuse(path, "holds a polygon that cannot be cut into triangles.", "Write the file with triangles only.");

  TriangleMesh result;
  result.name = path.string();
  flatten(*scene, *scene->mRootNode, Eigen::Affine3d::Identity(), result);
  if (result.triangles.empty()) refuse(path, "holds no triangles in any of its nodes.");
  checkTriangles(path, result);
  return result;
}

}  // namespace tsubu::io
