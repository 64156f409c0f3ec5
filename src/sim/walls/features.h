#pragma once
// From repaired triangles to planar faces, edges and corners.

#include <cstdint>
#include <vector>

#include "core/mesh.h"
#include "core/vec.h"
#include "sim/walls/outline.h"
#include "sim/walls/plane.h"

namespace tsubu::sim {

/// Coplanar triangles connected through common edges. `u`, `v` span the plane from `origin`; `outline` is in those coordinates.
/// An unbounded face has no outline and is solid behind.
struct Face {
  Plane plane;
  Vec3 origin = Vec3::Zero(), u = Vec3::UnitX(), v = Vec3::UnitY();
  Outline outline;
  bool unbounded = false;

  Vec2 project(const Vec3& point) const { return {u.dot(point - origin), v.dot(point - origin)}; }
};

/// A straight line along which faces meet or one ends.
struct Edge {
  Vec3 start = Vec3::Zero(), direction = Vec3::UnitX();  ///< m; unit
  double length = 0;                                     ///< m
  std::uint32_t sidesBegin = 0, sidesEnd = 0;            ///< in Features::sides
  std::uint32_t cornerA = 0, cornerB = 0;                ///< in Features::corners; A at `start`
  Vec3 normal = Vec3::UnitZ();                           ///< unit: for a centre that lies exactly on the edge
};

/// A face as seen from its edge: the unit vector in the face that leads away from the edge at a right angle.
struct EdgeSide {
  std::uint32_t face = 0;
  Vec3 inward = Vec3::UnitX();
};

/// A point where edges end.
struct Corner {
  Vec3 point = Vec3::Zero();
  std::uint32_t edgesBegin = 0, edgesEnd = 0;      ///< in Features::cornerEdges
  std::uint32_t sectorsBegin = 0, sectorsEnd = 0;  ///< in Features::sectors
  Vec3 normal = Vec3::UnitZ();                     ///< unit: for a centre that lies exactly on the corner
};

/// The directions in which one face leaves a corner at a straight or wider angle. Narrower ones need no memory: there the edges
/// on both sides say everything.
struct Sector {
  Vec3 normal = Vec3::UnitZ();    ///< unit, of the face
  Vec3 bisector = Vec3::UnitX();  ///< unit, in the face
  double cosHalfAngle = 0;
};

struct Features {
  std::vector<Face> faces;
  std::vector<Edge> edges;
  std::vector<Corner> corners;

  std::vector<EdgeSide> sides;
  std::vector<Vec3> cornerEdges;  ///< unit directions away from the corner
  std::vector<Sector> sectors;

  /// Corners of each feature, ascending: those of feature f are cornersOf[cornersBegin[f] … cornersBegin[f + 1]).
  std::vector<std::uint32_t> cornersBegin, cornersOf;

  TriangleMesh mesh;  ///< welded and repaired
  std::vector<std::uint32_t> faceOfTriangle;

  double slack = 0;  ///< m: how far apart two points of the wall may be and still count as one
};

/// `tolerance` (m): how far vertices may lie from the plane of their face, and from the line of their edge.
/// `slack` (m): Features::slack; two borders of one face that are nearer to each other are no gap.
Features findFeatures(TriangleMesh mesh, double tolerance, double slack);

}  // namespace tsubu::sim
