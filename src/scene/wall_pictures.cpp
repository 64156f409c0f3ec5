#include "scene/wall_pictures.h"

#include "io/mesh_file.h"
#include "scene/pairs.h"

namespace tsubu::scene {

namespace {

using Polygon = std::vector<Vec3>;

Polygon square(const Vec3& centre, const Vec3& normal, double size) {
  int smallest = 0;
  normal.cwiseAbs().minCoeff(&smallest);
  const Vec3 u = normal.cross(Vec3::Unit(smallest)).normalized() * (size / 2), v = normal.cross(u);
  return {centre - u - v, centre + u - v, centre + u + v, centre - u + v};
}

// The part of a convex polygon where normal·x ≥ offset (Sutherland and Hodgman).
Polygon cut(const Polygon& polygon, const Vec3& normal, double offset) {
  Polygon kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double da = normal.dot(a) - offset, db = normal.dot(b) - offset;
    if (da >= 0) kept.push_back(a);
    if ((da >= 0) != (db >= 0)) kept.push_back(a + (b - a) * (da / (da - db)));
  }
  return kept;
}

TriangleMesh fan(const std::string& name, const Polygon& polygon) {
  TriangleMesh mesh;
  mesh.name = name;
  mesh.vertices = polygon;
  for (int i = 2; i < static_cast<int>(polygon.size()); ++i) mesh.triangles.push_back({0, i - 1, i});
  return mesh;
}

bool moves(const Wall& wall) { return wall.body || !wall.motions.empty(); }

Polygon cutByOtherPlanes(const Scene& scene, const Wall& wall, Polygon polygon) {
  if (moves(wall)) return polygon;
  for (const Wall& other : scene.walls) {
    const auto* plane = std::get_if<PlaneShape>(&other.shape);
    if (!plane || &other == &wall || moves(other)) continue;
    const Vec3 normal = plane->normal.normalized();
    polygon = cut(polygon, normal, normal.dot(plane->point));
  }
  return polygon;
}

// Does the plane carry the grains, nearly level?
bool carries(const Scene& scene, const PlaneShape& plane) {
  const Vec3& g = scene.simulation.gravity;
  return g.norm() > 0 && -g.dot(plane.normal) > 0.99 * g.norm() * plane.normal.norm();
}

}  // namespace

TriangleMesh placedMesh(const Scene& scene, const Wall& wall, const MeshShape& shape) {
  TriangleMesh mesh = io::readMesh(resolved(scene, shape.file));
  mesh.name = wall.name;
  const Quat turn(Eigen::AngleAxisd(shape.rotationAngle, shape.rotationAxis.normalized()));
  const bool turned = shape.rotationAngle != 0;
  for (Vec3& vertex : mesh.vertices) {
    vertex *= shape.scale;
    if (turned) vertex = turn * vertex;
    vertex += shape.position;
  }
  return mesh;
}

TriangleMesh drawnPlane(const Scene& scene, const Wall& wall, const PlaneShape& shape, const Box& bounds) {
  const Vec3 normal = shape.normal.normalized();
  if (shape.size) return fan(wall.name, square(shape.point, normal, *shape.size));
  const double size = bounds.diagonal().norm();
  const double distance = normal.dot(bounds.center() - shape.point);
  const Vec3 foot = bounds.center() - distance * normal;
  if (lookOf(scene, wall).ground) return fan(wall.name, square(foot, normal, 60 * size));
  Polygon polygon = cutByOtherPlanes(scene, wall, square(foot, normal, 60 * size));
  for (int k = 0; k < 3; ++k) {
    // Nothing is seen of the part of a plane that lies outside the bounds, but a plane that lies outside altogether is not to vanish.
    const double slack = 0.02 * size + std::abs(normal[k] * distance);
    polygon = cut(polygon, Vec3::Unit(k), bounds.min()[k] - slack);
    polygon = cut(polygon, -Vec3::Unit(k), -bounds.max()[k] - slack);
  }
  return fan(wall.name, polygon);
}

render::WallLook lookOf(const Scene& scene, const Wall& wall) {
  const auto* plane = std::get_if<PlaneShape>(&wall.shape);
  Look look = wall.look;
  if (look == Look::automatic) look = !plane ? Look::opaque : carries(scene, *plane) ? Look::ground : Look::translucent;

  render::WallLook result;
  switch (look) {
    case Look::automatic:
    case Look::opaque:
      result.style = render::WallStyle::opaque;
      break;
    case Look::translucent:
      result.style = render::WallStyle::translucent;
      break;
    case Look::wire:
      result.style = render::WallStyle::wire;
      break;
    case Look::ground:
      result.ground = true;
      break;
    case Look::hidden:
      result.style = render::WallStyle::hidden;
      break;
  }
  const std::size_t material = materialIndex(scene, wall.material);
  if (wall.colour)
    result.colour = *wall.colour;
  else if (material != noMaterial && scene.materials[material].colour && !grainMaterials(scene).contains(material)) {
    result.colour = *scene.materials[material].colour;
  }
  if (wall.opacity) result.opacity = *wall.opacity;
  return result;
}

}  // namespace tsubu::scene
