#pragma once
// Small scenes for pictures whose every pixel can be reasoned about.

#include "core/snapshot.h"
#include "render/renderer.h"

namespace tsubu::render {

inline void addGrain(Snapshot& snapshot, const Vec3& position, double radius, int material = 0,
                     const Quat& orientation = Quat::Identity()) {
  snapshot.id.push_back(static_cast<std::uint32_t>(snapshot.id.size()));
  snapshot.material.push_back(static_cast<std::uint16_t>(material));
  snapshot.radius.push_back(radius);
  snapshot.position.push_back(position);
  snapshot.velocity.push_back(Vec3::Zero());
  snapshot.angularVelocity.push_back(Vec3::Zero());
  snapshot.orientation.push_back(orientation);
  snapshot.load.push_back(0);
}

/// One sample a pixel, a plain background of one colour, only the light of the sky: a pixel tells which surface it shows.
inline Style plainStyle(int width = 160, int height = 120) {
  Style style;
  style.picture = {width, height, Quality::draft};
  style.background = {{0, 255, 0}, {0, 255, 0}};
  style.light.shadows = false;
  style.light.ambientOcclusion = false;
  style.overlay.time = false;
  style.overlay.legend = false;
  FixedCamera camera;
  camera.eye = {0, -10, 0};
  camera.fovY = 0.6;
  style.camera = camera;
  style.grains.materials = {{255, 0, 0}, {0, 0, 255}, {200, 200, 200}};
  return style;
}

inline TriangleMesh quadMesh(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  TriangleMesh mesh;
  mesh.vertices = {a, b, c, d};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

/// The cube [−half, half]³ as twelve triangles, outwards.
inline TriangleMesh cubeMesh(double half) {
  TriangleMesh mesh;
  for (int k = 0; k < 8; ++k) mesh.vertices.push_back(half * Vec3(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1));
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

inline bool isBackground(const std::uint8_t* pixel) { return pixel[0] == 0 && pixel[1] == 255 && pixel[2] == 0; }
inline bool isRed(const std::uint8_t* pixel) { return !isBackground(pixel) && pixel[0] > pixel[2]; }
inline bool isBlue(const std::uint8_t* pixel) { return !isBackground(pixel) && pixel[2] > pixel[0]; }
inline int brightness(const std::uint8_t* pixel) { return pixel[0] + pixel[1] + pixel[2]; }

}  // namespace tsubu::render
