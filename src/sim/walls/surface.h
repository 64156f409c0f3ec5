#pragma once
// The geometry of a wall: planar faces, the edges where they meet or end, and the corners where edges meet. Coplanar neighbouring
// triangles are one face, so that a grain feels the shape of the wall and not its triangulation. Pure geometry in the frame of
// the wall: no material, no motion. All const methods may be called by many threads at once.

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/mesh.h"
#include "core/vec.h"
#include "sim/walls/bvh.h"
#include "sim/walls/contact.h"
#include "sim/walls/faults.h"
#include "sim/walls/features.h"
#include "sim/walls/plane.h"

namespace tsubu::sim {

class Surface {
 public:
  static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

  /// Welds, repairs and merges the triangles of `mesh` (m, frame of the wall). What was found is in faults().
  /// Throws Error (files) with every fault that cannot be repaired, each naming its triangles.
  explicit Surface(const TriangleMesh& mesh);

  /// An unbounded plane: one face without edges, solid behind. `normal` need not be a unit vector, but not zero.
  static Surface plane(std::string name, const Vec3& point, const Vec3& normal);

  const std::string& name() const { return name_; }
  const std::vector<MeshFault>& faults() const { return faults_; }

  /// Features are numbered faces first, then edges, then corners.
  std::uint32_t faceCount() const { return static_cast<std::uint32_t>(features_.faces.size()); }
  std::uint32_t edgeCount() const { return static_cast<std::uint32_t>(features_.edges.size()); }
  std::uint32_t cornerCount() const { return static_cast<std::uint32_t>(features_.corners.size()); }
  std::uint32_t featureCount() const { return faceCount() + edgeCount() + cornerCount(); }
  bool isFace(std::uint32_t feature) const { return feature < faceCount(); }
  /// The plane of a face.
  const Plane& facePlane(std::uint32_t face) const { return features_.faces[face].plane; }
  /// The plane itself when the wall is an unbounded plane, for a caller that has a faster way with those.
  std::optional<Plane> asPlane() const;

  /// Two features that touch (a face and its edge, two faces with a common corner, …): tangential memory passes between them
  /// when a grain rolls from one to the other. A feature is its own neighbour.
  bool neighbours(std::uint32_t a, std::uint32_t b) const;

  /// m; infinite for an unbounded plane.
  const Box& bounds() const { return bounds_; }

  /// Replaces `features` by those with a point nearer than `reach` to `centre` (m), in ascending order.
  void candidates(const Vec3& centre, double reach, std::vector<std::uint32_t>& features) const;

  /// May a point of the wall lie in the box (m)? No is certain.
  bool mayMeet(const Box& box) const;

  /// Where the distance from the centre to the wall is locally least and below `radius`, with all weights 1, in ascending order of
  /// feature. `candidates`: ascending but for the mark `surelyOver`, holding at least every feature nearer than `radius` that is not
  /// refused. No allocation.
  void nearestPoints(const Vec3& centre, double radius, std::span<const std::uint32_t> candidates, WallContacts& contacts) const;

  /// The contacts of a sphere: its nearest points with the load shared between them (shareLoad).
  void contacts(const Vec3& centre, double radius, std::span<const std::uint32_t> candidates, WallContacts& contacts) const;

  /// m: how far the centre of a sphere may go before the feature can be one of its contacts, as far as that is easily said; 0 when it may
  /// be one now. A feature is out of question where it is farther than `radius`, but also where others on it come nearer.
  double refusal(std::uint32_t feature, const Vec3& centre, double radius) const;

  /// m: how far the centre may go before its foot can leave the outline of a face; 0 when it is outside.
  double stayOver(std::uint32_t face, const Vec3& centre, double farthest) const;
  /// Marks a face among candidates whose outline the foot is known to be in.
  static constexpr std::uint32_t surelyOver = std::uint32_t{1} << 31;

  /// m: how far the centre of a sphere may go before it can touch one of the candidates; 0 when it may touch now.
  double clearance(const Vec3& centre, double radius, std::span<const std::uint32_t> candidates) const;

  /// The first face among the candidates that the straight way from one point to another (m) passes through, or `none`:
  /// a centre that did so between two steps has tunnelled.
  std::uint32_t crossedFace(const Vec3& from, const Vec3& to, std::span<const std::uint32_t> candidates) const;

  /// m: distance of the point from the plane of a face, positive on the side of its normal.
  double signedDistance(std::uint32_t face, const Vec3& point) const { return facePlane(face).signedDistance(point); }

  /// m: an estimate of the thinnest place between two parallel faces (sampled at the largest triangles of each face); infinite
  /// when there is none. A step must be much shorter than this.
  double thinnest() const;

  /// The welded and repaired triangles, and the face of each.
  const TriangleMesh& mesh() const { return features_.mesh; }
  const std::vector<std::uint32_t>& faceOfTriangle() const { return features_.faceOfTriangle; }

 private:
  Surface() = default;

  double squaredDistanceTo(std::uint32_t feature, const Vec3& point, double reach) const;
  bool closestOnFace(const Face& face, const Vec3& centre, double radius, bool surely, WallContact& contact) const;
  bool closestOnEdge(const Edge& edge, const Vec3& centre, double radius, WallContact& contact) const;
  bool closestOnCorner(const Corner& corner, const Vec3& centre, double radius, WallContact& contact) const;
  void insert(const WallContact& contact, WallContacts& contacts) const;
  double thicknessAt(std::uint32_t face, const Vec3& point, double longest) const;

  std::string name_;
  std::vector<MeshFault> faults_;
  Features features_;
  Bvh bvh_;
  Box bounds_;
};

}  // namespace tsubu::sim
