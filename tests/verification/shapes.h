#pragma once
// Meshes for the tests of walls.

#include <cmath>
#include <numbers>

#include "core/mesh.h"
#include "sim/walls/surface.h"

namespace tsubu::sim::test {

/// The rectangle [x0, x1] × [y0, y1] at height z, cut into 2 nx ny triangles; `shake` (of a cell) moves inner vertices in the plane.
inline TriangleMesh rectangle(double x0, double x1, double y0, double y1, double z, int nx, int ny, double shake = 0) {
  TriangleMesh mesh;
  mesh.name = "rectangle";
  Random random(5, 5);
  for (int j = 0; j <= ny; ++j) {
    for (int i = 0; i <= nx; ++i) {
      const bool inner = i > 0 && j > 0 && i < nx && j < ny;
      const double dx = inner ? shake * random.uniform(-0.5, 0.5) : 0, dy = inner ? shake * random.uniform(-0.5, 0.5) : 0;
      mesh.vertices.emplace_back(x0 + (x1 - x0) * (i + dx) / nx, y0 + (y1 - y0) * (j + dy) / ny, z);
    }
  }
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) {
      const int a = j * (nx + 1) + i, b = a + 1, c = a + nx + 1, d = c + 1;
      mesh.triangles.push_back({a, b, d});
      mesh.triangles.push_back({a, d, c});
    }
  }
  return mesh;
}

/// A cube [−h, h]³, faces of two triangles each.
inline TriangleMesh cube(double h) {
  TriangleMesh mesh;
  mesh.name = "cube";
  for (int k = 0; k < 8; ++k) mesh.vertices.emplace_back((k & 1) ? h : -h, (k & 2) ? h : -h, (k & 4) ? h : -h);
  for (const auto& [a, b, c, d] : {std::array{0, 2, 3, 1}, std::array{4, 5, 7, 6}, std::array{0, 1, 5, 4}, std::array{2, 6, 7, 3},
                                   std::array{0, 4, 6, 2}, std::array{1, 3, 7, 5}}) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  }
  return mesh;
}

/// The side of a frustum about z, radius r0 at z0 and r1 at z1, of n facets; a facet's middle faces +x when n is even.
inline TriangleMesh frustum(double r0, double z0, double r1, double z1, int n) {
  TriangleMesh mesh;
  mesh.name = "frustum";
  for (int k = 0; k < n; ++k) {
    const double angle = 2 * std::numbers::pi * (k + 0.5) / n;
    mesh.vertices.emplace_back(r0 * std::cos(angle), r0 * std::sin(angle), z0);
    mesh.vertices.emplace_back(r1 * std::cos(angle), r1 * std::sin(angle), z1);
  }
  for (int k = 0; k < n; ++k) {
    const int a = 2 * k, b = 2 * ((k + 1) % n);
    mesh.triangles.push_back({a, b, b + 1});
    mesh.triangles.push_back({a, b + 1, a + 1});
  }
  return mesh;
}

}  // namespace tsubu::sim::test
