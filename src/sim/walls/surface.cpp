#include "sim/walls/surface.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "sim/walls/repair.h"

namespace tsubu::sim {

namespace {

double squaredDistanceToEdge(const Edge& edge, const Vec3& point) {
  const Vec3 from = point - edge.start;
  return (from - std::clamp(from.dot(edge.direction), 0.0, edge.length) * edge.direction).squaredNorm();
}

double squaredDistanceToFace(const Face& face, const Vec3& point, double reach) {
  const double height = face.plane.signedDistance(point);
  if (height * height >= reach * reach) return height * height;
  const Vec2 foot = face.project(point);
  return face.outline.contains(foot) ? height * height : height * height + face.outline.squaredDistance(foot, reach);
}

Box boxOfTriangles(const Features& features, std::uint32_t face, const std::vector<std::vector<int>>& trianglesOf) {
  Box box;
  for (const int t : trianglesOf[face])
    for (const int v : features.mesh.triangles[static_cast<std::size_t>(t)])
      box.extend(features.mesh.vertices[static_cast<std::size_t>(v)]);
  return box;
}

}  // namespace

Surface::Surface(const TriangleMesh& mesh) : name_(mesh.name) {
  RepairedMesh repaired = repair(mesh);
  faults_ = std::move(repaired.faults);
  features_ = findFeatures(std::move(repaired.mesh), repaired.flatTolerance, 2 * repaired.weldTolerance);

  std::vector<std::vector<int>> trianglesOf(features_.faces.size());
  for (std::size_t t = 0; t < features_.faceOfTriangle.size(); ++t) trianglesOf[features_.faceOfTriangle[t]].push_back(static_cast<int>(t));
  std::vector<Box> boxes;
  boxes.reserve(featureCount());
  for (std::uint32_t f = 0; f < faceCount(); ++f) boxes.push_back(boxOfTriangles(features_, f, trianglesOf));
  for (const Edge& edge : features_.edges) {
    boxes.emplace_back(edge.start, edge.start);
    boxes.back().extend(Vec3(edge.start + edge.length * edge.direction));
  }
  for (const Corner& corner : features_.corners) boxes.emplace_back(corner.point, corner.point);
  for (const Box& box : boxes) bounds_.extend(box);
  bvh_ = Bvh(boxes);
}

Surface Surface::plane(std::string name, const Vec3& point, const Vec3& normal) {
  if (!(normal.norm() > 0) || !normal.allFinite() || !point.allFinite())
    throw Error(ErrorKind::scene, "The plane '" + name + "' needs a point and a normal of finite numbers, the normal not zero.");
  Surface surface;
  surface.name_ = std::move(name);
  Face face;
  face.plane.normal = normal.normalized();
  face.plane.offset = face.plane.normal.dot(point);
  face.origin = point;
  face.u = face.plane.normal.unitOrthogonal();
  face.v = face.plane.normal.cross(face.u);
  face.unbounded = true;
  surface.features_.faces.push_back(std::move(face));
  surface.features_.cornersBegin = {0, 0};
  const double infinity = std::numeric_limits<double>::infinity();
  surface.bounds_ = Box(Vec3::Constant(-infinity), Vec3::Constant(infinity));
  return surface;
}

std::optional<Plane> Surface::asPlane() const {
  if (faceCount() == 1 && features_.faces[0].unbounded) return features_.faces[0].plane;
  return std::nullopt;
}

bool Surface::neighbours(std::uint32_t a, std::uint32_t b) const {
  if (a == b) return true;
  const auto& begin = features_.cornersBegin;
  const std::uint32_t* corners = features_.cornersOf.data();
  if (begin[a + 1] - begin[a] > begin[b + 1] - begin[b]) std::swap(a, b);
  for (std::uint32_t i = begin[a]; i < begin[a + 1]; ++i)
    if (std::binary_search(corners + begin[b], corners + begin[b + 1], corners[i])) return true;
  return false;
}

void Surface::candidates(const Vec3& centre, double reach, std::vector<std::uint32_t>& found) const {
  found.clear();
  if (faceCount() == 1 && features_.faces[0].unbounded) {
    if (features_.faces[0].plane.signedDistance(centre) < reach) found.push_back(0);
    return;
  }
  const double squaredReach = reach * reach;
  bvh_.near(centre, reach, [&](std::uint32_t feature) {
    if (squaredDistanceTo(feature, centre, reach) < squaredReach) found.push_back(feature);
  });
  std::sort(found.begin(), found.end());
}

bool Surface::mayMeet(const Box& box) const {
  if (const auto plane = asPlane()) {
    const Vec3 corner = (plane->normal.array() > 0).select(box.min(), box.max());
    return plane->signedDistance(corner) < 0;
  }
  return bvh_.meetsAny(box);
}

double Surface::squaredDistanceTo(std::uint32_t feature, const Vec3& point, double reach) const {
  if (feature < faceCount()) return squaredDistanceToFace(features_.faces[feature], point, reach);
  if (feature < faceCount() + edgeCount()) return squaredDistanceToEdge(features_.edges[feature - faceCount()], point);
  return (features_.corners[feature - faceCount() - edgeCount()].point - point).squaredNorm();
}

double Surface::refusal(std::uint32_t feature, const Vec3& centre, double radius) const {
  // Each reason to refuse loses as much as the centre goes, at most: the best of them holds longest.
  double reason = 0;
  const auto because = [&](double margin) { reason = std::max(reason, margin); };
  const std::uint32_t faces = faceCount(), facesAndEdges = faces + edgeCount();
  if (feature < faces) {
    const Face& face = features_.faces[feature];
    const double height = face.plane.signedDistance(centre), most = 4 * radius;
    because((face.unbounded ? height : std::abs(height)) - radius);
    if (reason < 0.25 * radius && !face.unbounded && !face.outline.contains(face.project(centre)))
      because(std::min(most, std::sqrt(face.outline.squaredDistance(face.project(centre), most))));
  } else if (feature < facesAndEdges) {
    const Edge& edge = features_.edges[feature - faces];
    const Vec3 from = centre - edge.start;
    const double along = from.dot(edge.direction);
    because(std::max(-along, along - edge.length));
    because((from - along * edge.direction).norm() - radius);
    for (std::uint32_t s = edge.sidesBegin; s < edge.sidesEnd; ++s) because(from.dot(features_.sides[s].inward) - 2 * features_.slack);
  } else {
    const Corner& corner = features_.corners[feature - facesAndEdges];
    const Vec3 away = centre - corner.point;
    because(away.norm() - radius);
    for (std::uint32_t e = corner.edgesBegin; e < corner.edgesEnd; ++e) because(away.dot(features_.cornerEdges[e]) - 2 * features_.slack);
  }
  // A little less than what rounding could make of it.
  return (1 - 1e-9) * reason;
}

double Surface::stayOver(std::uint32_t face, const Vec3& centre, double farthest) const {
  const Face& of = features_.faces[face];
  const Vec2 foot = of.project(centre);
  if (of.unbounded || !of.outline.contains(foot)) return 0;
  return (1 - 1e-9) * std::min(farthest, std::sqrt(of.outline.squaredDistance(foot, farthest)));
}

double Surface::clearance(const Vec3& centre, double radius, std::span<const std::uint32_t> candidates) const {
  double least = std::numeric_limits<double>::infinity();
  for (const std::uint32_t feature : candidates) least = std::min(least, refusal(feature, centre, radius));
  return least;
}

void Surface::contacts(const Vec3& centre, double radius, std::span<const std::uint32_t> candidates, WallContacts& contacts) const {
  nearestPoints(centre, radius, candidates, contacts);
  shareLoad(contacts, radius);
}

void Surface::nearestPoints(const Vec3& centre, double radius, std::span<const std::uint32_t> candidates, WallContacts& contacts) const {
  contacts.clear();
  const std::uint32_t faces = faceCount(), facesAndEdges = faces + edgeCount();
  WallContact contact;
  for (const std::uint32_t marked : candidates) {
    const std::uint32_t feature = marked & ~surelyOver;
    bool touching;
    if (feature < faces)
      touching = closestOnFace(features_.faces[feature], centre, radius, marked != feature, contact);
    else if (feature < facesAndEdges)
      touching = closestOnEdge(features_.edges[feature - faces], centre, radius, contact);
    else
      touching = closestOnCorner(features_.corners[feature - facesAndEdges], centre, radius, contact);
    if (!touching) continue;
    contact.feature = feature;
    insert(contact, contacts);
  }
}

bool Surface::closestOnFace(const Face& face, const Vec3& centre, double radius, bool surely, WallContact& contact) const {
  const double height = face.plane.signedDistance(centre);
  if (height >= radius) return false;
  if (face.unbounded) {
    contact.normal = face.plane.normal;
    contact.distance = height;
  } else {
    if (height <= -radius || !(surely || face.outline.contains(face.project(centre)))) return false;
    contact.normal = height >= 0 ? face.plane.normal : Vec3(-face.plane.normal);
    contact.distance = std::abs(height);
  }
  contact.point = centre - height * face.plane.normal;
  return true;
}

// An edge is locally nearest when no face on it comes nearer as one leaves the edge. The slack lets edge and face both claim a
// centre exactly between them rather than neither; `insert` then keeps the face.
bool Surface::closestOnEdge(const Edge& edge, const Vec3& centre, double radius, WallContact& contact) const {
  const Vec3 from = centre - edge.start;
  const double along = from.dot(edge.direction);
  if (along < 0 || along > edge.length) return false;
  const Vec3 away = from - along * edge.direction;
  const double squared = away.squaredNorm();
  if (squared >= radius * radius) return false;
  for (std::uint32_t s = edge.sidesBegin; s < edge.sidesEnd; ++s)
    if (away.dot(features_.sides[s].inward) > features_.slack) return false;
  contact.distance = std::sqrt(squared);
  contact.normal = contact.distance > 1e-6 * features_.slack ? Vec3(away / contact.distance) : edge.normal;
  contact.point = edge.start + along * edge.direction;
  return true;
}

// A corner is locally nearest when none of its edges, and no face that leaves it at a straight or wider angle, comes nearer.
bool Surface::closestOnCorner(const Corner& corner, const Vec3& centre, double radius, WallContact& contact) const {
  const Vec3 away = centre - corner.point;
  const double squared = away.squaredNorm();
  if (squared >= radius * radius) return false;
  for (std::uint32_t e = corner.edgesBegin; e < corner.edgesEnd; ++e)
    if (away.dot(features_.cornerEdges[e]) > features_.slack) return false;
  for (std::uint32_t s = corner.sectorsBegin; s < corner.sectorsEnd; ++s) {
    const Sector& sector = features_.sectors[s];
    const Vec3 inPlane = away - away.dot(sector.normal) * sector.normal;
    const double length = inPlane.norm();
    if (length > features_.slack && inPlane.dot(sector.bisector) >= length * sector.cosHalfAngle) return false;
  }
  contact.distance = std::sqrt(squared);
  contact.normal = contact.distance > 1e-6 * features_.slack ? Vec3(away / contact.distance) : corner.normal;
  contact.point = corner.point;
  return true;
}

// Contacts at one point are one contact. When there are too many, the two that are most alike make room.
void Surface::insert(const WallContact& contact, WallContacts& contacts) const {
  const double same = 4 * features_.slack;
  for (const WallContact& other : contacts)
    if ((other.point - contact.point).squaredNorm() <= same * same) return;
  if (contacts.size() < WallContacts::capacity) {
    contacts.push(contact);
    return;
  }
  int weaker = -1;  // of the most alike pair so far; -1 is the new contact
  double alike = -1;
  const auto consider = [&](const WallContact& a, int indexA, const WallContact& b, int indexB) {
    const double cosine = a.normal.dot(b.normal);
    if (cosine <= alike) return;
    alike = cosine;
    weaker = b.distance >= a.distance ? indexB : indexA;
  };
  for (int i = 0; i < contacts.size(); ++i) {
    for (int j = i + 1; j < contacts.size(); ++j) consider(contacts[i], i, contacts[j], j);
    consider(contacts[i], i, contact, -1);
  }
  if (weaker < 0) return;
  contacts.erase(weaker);
  contacts.push(contact);
}

std::uint32_t Surface::crossedFace(const Vec3& from, const Vec3& to, std::span<const std::uint32_t> candidates) const {
  std::uint32_t crossed = none;
  double first = 2;
  for (const std::uint32_t feature : candidates) {
    if (feature >= faceCount()) break;
    const Face& face = features_.faces[feature];
    const double before = face.plane.signedDistance(from), after = face.plane.signedDistance(to);
    if ((before < 0) == (after < 0)) continue;
    const double t = before / (before - after);
    if (t < first && (face.unbounded || face.outline.contains(face.project(from + t * (to - from))))) {
      first = t;
      crossed = feature;
    }
  }
  return crossed;
}

double Surface::thinnest() const {
  double thinnest = std::numeric_limits<double>::infinity();
  if (asPlane()) return thinnest;
  struct Sample {
    double area = 0;
    Vec3 point = Vec3::Zero();
  };
  std::vector<Sample> samples(faceCount());
  for (std::size_t t = 0; t < features_.faceOfTriangle.size(); ++t) {
    const auto& [a, b, c] = features_.mesh.triangles[t];
    const auto& x = features_.mesh.vertices;
    const Vec3 p = x[static_cast<std::size_t>(a)], q = x[static_cast<std::size_t>(b)], r = x[static_cast<std::size_t>(c)];
    const double area = (q - p).cross(r - p).norm();
    Sample& sample = samples[features_.faceOfTriangle[t]];
    if (area > sample.area) sample = {area, (p + q + r) / 3};
  }
  const double longest = bounds_.diagonal().norm();
  for (std::uint32_t f = 0; f < faceCount(); ++f)
    thinnest = std::min(thinnest, thicknessAt(f, samples[f].point, std::min(longest, thinnest)));
  return thinnest;
}

double Surface::thicknessAt(std::uint32_t face, const Vec3& point, double longest) const {
  constexpr double parallel = 0.996;  // within five degrees
  const Vec3 normal = facePlane(face).normal;
  double thickness = std::numeric_limits<double>::infinity();
  bvh_.alongSegment(point - longest * normal, point + longest * normal, [&](std::uint32_t other) {
    if (other >= faceCount() || other == face) return;
    const Plane& plane = facePlane(other);
    const double cosine = plane.normal.dot(normal);
    if (std::abs(cosine) < parallel) return;
    const double t = -plane.signedDistance(point) / cosine;
    if (std::abs(t) > 4 * features_.slack && std::abs(t) < thickness &&
        features_.faces[other].outline.contains(features_.faces[other].project(point + t * normal)))
      thickness = std::abs(t);
  });
  return thickness;
}

}  // namespace tsubu::sim
