#include "sim/walls/features.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "core/portable_math.h"
#include "sim/walls/flat_regions.h"
#include "sim/walls/mesh_edges.h"

namespace tsubu::sim {

namespace {

Vec3 normalizedOr(const Vec3& vector, const Vec3& otherwise) {
  const double length = vector.norm();
  return length > 1e-6 ? Vec3(vector / length) : otherwise;
}

/// A face at an edge of the mesh. Seen from the side to which its plane's normal points, all triangles run counterclockwise: those to
/// the left of the edge run forward along it (from its lower to its higher vertex), those to the right backward.
struct FaceAt {
  std::uint32_t face = 0;
  int forward = 0, backward = 0;  ///< triangles
  bool operator==(const FaceAt&) const = default;

  FaceAt reversed() const { return {face, backward, forward}; }
};

class Builder {
 public:
  Builder(TriangleMesh mesh, double tolerance, double slack) : tolerance_(tolerance) {
    result_.slack = slack;
    edges_ = findMeshEdges(mesh.triangles);
    FlatRegions regions = findFlatRegions(mesh, edges_, tolerance);
    result_.mesh = std::move(mesh);
    result_.faceOfTriangle = std::move(regions.ofTriangle);
    for (std::size_t f = 0; f < regions.planes.size(); ++f) {
      Face face;
      face.plane = regions.planes[f];
      face.origin = regions.centres[f];
      face.u = face.plane.normal.unitOrthogonal();
      face.v = face.plane.normal.cross(face.u);
      result_.faces.push_back(std::move(face));
    }
  }

  Features build() {
    findRealEdges();
    findChains();
    closeSlits();
    numberCorners();
    makeOutlines();
    makeEdges();
    makeCorners();
    listCorners();
    return std::move(result_);
  }

 private:
  /// A straight line of mesh edges from one vertex to another (the lower first), with the faces as seen in that direction.
  struct Line {
    int from = 0, to = 0;
    std::vector<FaceAt> faces;
  };

  const std::array<int, 3>& triangle(int t) const { return result_.mesh.triangles[static_cast<std::size_t>(t)]; }
  std::uint32_t faceOf(int t) const { return result_.faceOfTriangle[static_cast<std::size_t>(t)]; }
  const Vec3& at(int vertex) const { return vertexOf(result_.mesh, vertex); }

  bool runsForward(TriangleSide side, const MeshEdges::Edge& edge) const {
    const auto& t = triangle(side.triangle);
    const bool turned = areaVector(result_.mesh, t).dot(result_.faces[faceOf(side.triangle)].plane.normal) < 0;
    return (t[static_cast<std::size_t>(side.side)] == edge.a) != turned;
  }

  std::vector<FaceAt> facesAt(const MeshEdges::Edge& edge) const {
    std::vector<FaceAt> faces;
    for (std::uint32_t s = edge.begin; s < edge.end; ++s) {
      const std::uint32_t face = faceOf(edges_.sides[s].triangle);
      auto at = std::find_if(faces.begin(), faces.end(), [face](const FaceAt& known) { return known.face == face; });
      if (at == faces.end()) at = faces.insert(at, FaceAt{face});
      ++(runsForward(edges_.sides[s], edge) ? at->forward : at->backward);
    }
    std::sort(faces.begin(), faces.end(), [](const FaceAt& x, const FaceAt& y) { return x.face < y.face; });
    return faces;
  }

  /// An edge of the mesh is real unless it lies inside one face.
  void findRealEdges() {
    facesAt_.resize(edges_.edges.size());
    atVertex_.resize(result_.mesh.vertices.size());
    for (std::uint32_t e = 0; e < edges_.edges.size(); ++e) {
      const auto& edge = edges_.edges[e];
      std::vector<FaceAt> faces = facesAt(edge);
      if (faces.size() == 1 && faces[0].forward == faces[0].backward) continue;
      facesAt_[e] = std::move(faces);
      atVertex_[static_cast<std::size_t>(edge.a)].push_back(e);
      atVertex_[static_cast<std::size_t>(edge.b)].push_back(e);
    }
  }

  bool isReal(std::uint32_t e) const { return !facesAt_[e].empty(); }

  int otherEnd(std::uint32_t e, int vertex) const { return edges_.edges[e].a == vertex ? edges_.edges[e].b : edges_.edges[e].a; }

  /// Does a line of mesh edges go on through this vertex: two edges only, with the same faces on the same sides?
  bool passes(int vertex) const {
    const auto& here = atVertex_[static_cast<std::size_t>(vertex)];
    if (here.size() != 2 || facesAt_[here[0]].size() != facesAt_[here[1]].size()) return false;
    const bool against = (edges_.edges[here[0]].a == vertex) == (edges_.edges[here[1]].a == vertex);
    return std::equal(facesAt_[here[0]].begin(), facesAt_[here[0]].end(), facesAt_[here[1]].begin(),
                      [against](const FaceAt& x, const FaceAt& y) { return x == (against ? y.reversed() : y); });
  }

  /// Follows real edges through the vertices that they pass, and cuts each chain into straight lines.
  void findChains() {
    std::vector<char> visited(edges_.edges.size());
    const auto follow = [&](std::uint32_t e, int vertex) {
      std::vector<int> vertices{vertex};
      std::vector<std::uint32_t> chain;
      for (;;) {
        visited[e] = 1;
        chain.push_back(e);
        vertex = otherEnd(e, vertex);
        vertices.push_back(vertex);
        if (!passes(vertex)) break;
        const auto& here = atVertex_[static_cast<std::size_t>(vertex)];
        e = here[0] == e ? here[1] : here[0];
        if (visited[e]) break;
      }
      straighten(vertices, chain);
    };
    for (std::uint32_t e = 0; e < edges_.edges.size(); ++e) {
      if (!isReal(e) || visited[e]) continue;
      if (!passes(edges_.edges[e].a))
        follow(e, edges_.edges[e].a);
      else if (!passes(edges_.edges[e].b))
        follow(e, edges_.edges[e].b);
    }
    for (std::uint32_t e = 0; e < edges_.edges.size(); ++e)  // what is left are closed loops
      if (isReal(e) && !visited[e]) follow(e, edges_.edges[e].a);
  }

  /// The method of Ramer, Douglas and Peucker, without recursion.
  void straighten(std::vector<int> vertices, std::vector<std::uint32_t> chain) {
    if (vertices.front() == vertices.back()) startAtCorner(vertices, chain);
    std::vector<std::pair<std::size_t, std::size_t>> open{{0, chain.size()}};
    while (!open.empty()) {
      const auto [first, last] = open.back();
      open.pop_back();
      const Vec3 from = at(vertices[first]), along = at(vertices[last]) - from;
      std::size_t farthest = 0;
      double most = tolerance_ * tolerance_;
      for (std::size_t i = first + 1; i < last; ++i) {
        const Vec3 off = at(vertices[i]) - from;
        const double t = along.squaredNorm() > 0 ? std::clamp(off.dot(along) / along.squaredNorm(), 0.0, 1.0) : 0.0;
        const double squared = (off - t * along).squaredNorm();
        if (squared > most) {
          most = squared;
          farthest = i;
        }
      }
      if (farthest == 0) {
        addLine(vertices[first], vertices[last], chain[first]);
      } else {
        open.push_back({first, farthest});
        open.push_back({farthest, last});
      }
    }
  }

  /// Turns a closed chain so that it starts where it is farthest from some point: that is a true corner.
  void startAtCorner(std::vector<int>& vertices, std::vector<std::uint32_t>& chain) const {
    const Vec3 from = at(vertices.front());
    vertices.pop_back();
    const auto start = std::max_element(vertices.begin(), vertices.end(),
                                        [&](int a, int b) { return (at(a) - from).squaredNorm() < (at(b) - from).squaredNorm(); });
    std::rotate(chain.begin(), chain.begin() + (start - vertices.begin()), chain.end());
    std::rotate(vertices.begin(), start, vertices.end());
    vertices.push_back(vertices.front());
  }

  void addLine(int from, int to, std::uint32_t firstEdge) {
    std::vector<FaceAt> faces = facesAt_[firstEdge];
    if ((edges_.edges[firstEdge].a == from) != (from < to))
      for (FaceAt& face : faces) face = face.reversed();
    lines_.push_back({std::min(from, to), std::max(from, to), std::move(faces)});
  }

  /// Two borders of a slit that is narrower than the tolerance have become one line; it is none at all where one face closes over it.
  void closeSlits() {
    std::stable_sort(lines_.begin(), lines_.end(),
                     [](const Line& x, const Line& y) { return std::tie(x.from, x.to) < std::tie(y.from, y.to); });
    std::vector<Line> merged;
    for (Line& line : lines_) {
      if (merged.empty() || merged.back().from != line.from || merged.back().to != line.to) {
        merged.push_back(std::move(line));
        continue;
      }
      for (const FaceAt& face : line.faces) {
        auto& known = merged.back().faces;
        const auto at = std::find_if(known.begin(), known.end(), [&](const FaceAt& k) { return k.face == face.face; });
        if (at == known.end())
          known.push_back(face);
        else
          *at = {face.face, at->forward + face.forward, at->backward + face.backward};
      }
    }
    std::erase_if(merged, [](const Line& line) { return line.faces.size() == 1 && line.faces[0].forward == line.faces[0].backward; });
    lines_ = std::move(merged);
  }

  void numberCorners() {
    cornerOf_.assign(result_.mesh.vertices.size(), noCorner);
    for (const Line& line : lines_) cornerOf_[static_cast<std::size_t>(line.from)] = cornerOf_[static_cast<std::size_t>(line.to)] = 0;
    std::uint32_t count = 0;
    for (std::size_t v = 0; v < cornerOf_.size(); ++v) {
      if (cornerOf_[v] == noCorner) continue;
      cornerOf_[v] = count++;
      Corner corner;
      corner.point = result_.mesh.vertices[v];
      result_.corners.push_back(corner);
    }
  }

  /// Triangles on both sides of a line cancel: what is left is the way the outline runs there.
  void makeOutlines() {
    std::vector<std::vector<Outline::Segment>> segments(result_.faces.size());
    for (const Line& line : lines_) {
      for (const FaceAt& here : line.faces) {
        const Face& face = result_.faces[here.face];
        if (const int count = here.forward - here.backward; count != 0)
          segments[here.face].push_back({face.project(at(line.from)), face.project(at(line.to)), count});
      }
    }
    for (std::size_t f = 0; f < segments.size(); ++f) result_.faces[f].outline = Outline(segments[f]);
  }

  void makeEdges() {
    for (const Line& line : lines_) {
      Edge edge;
      edge.start = at(line.from);
      edge.length = (at(line.to) - at(line.from)).norm();
      edge.direction = (at(line.to) - at(line.from)) / edge.length;
      edge.cornerA = cornerOf_[static_cast<std::size_t>(line.from)];
      edge.cornerB = cornerOf_[static_cast<std::size_t>(line.to)];
      edge.sidesBegin = static_cast<std::uint32_t>(result_.sides.size());
      Vec3 inwards = Vec3::Zero();
      for (const FaceAt& here : line.faces) {
        const Vec3 left = result_.faces[here.face].plane.normal.cross(edge.direction).normalized();
        for (const auto& [triangles, inward] : {std::pair<int, Vec3>(here.forward, left), {here.backward, -left}}) {
          if (triangles == 0 && !isCovered(edge, result_.faces[here.face], inward)) continue;
          result_.sides.push_back({here.face, inward});
          inwards += inward;
        }
      }
      edge.sidesEnd = static_cast<std::uint32_t>(result_.sides.size());
      edge.normal = normalizedOr(-inwards, result_.faces[result_.sides[edge.sidesBegin].face].plane.normal);
      result_.edges.push_back(edge);
    }
  }

  bool covers(const Face& face, const Vec3& point) const { return face.outline.contains(face.project(point)); }

  /// Does the face go on beside its edge, though no triangle there has it for a side: another triangle overlaps, or the gap between
  /// them is too narrow to count?
  bool isCovered(const Edge& edge, const Face& face, const Vec3& inward) const {
    for (const double part : {0.05, 0.3, 0.5, 0.7, 0.95})
      if (!covers(face, edge.start + part * edge.length * edge.direction + result_.slack * inward)) return false;
    return true;
  }

  void makeCorners() {
    std::vector<std::vector<Vec3>> directions(result_.corners.size());
    for (const Edge& edge : result_.edges) {
      directions[edge.cornerA].push_back(edge.direction);
      directions[edge.cornerB].push_back(-edge.direction);
    }
    std::vector<std::vector<TriangleSide>> around(result_.corners.size());  // side k starts at the corner
    for (std::size_t t = 0; t < result_.mesh.triangles.size(); ++t)
      for (int k = 0; k < 3; ++k)
        if (const std::uint32_t c = cornerOf_[static_cast<std::size_t>(result_.mesh.triangles[t][static_cast<std::size_t>(k)])];
            c != noCorner)
          around[c].push_back({static_cast<int>(t), k});

    for (std::size_t c = 0; c < result_.corners.size(); ++c) {
      Corner& corner = result_.corners[c];
      corner.edgesBegin = static_cast<std::uint32_t>(result_.cornerEdges.size());
      Vec3 sum = Vec3::Zero();
      for (const Vec3& direction : directions[c]) {
        result_.cornerEdges.push_back(direction);
        sum += direction;
      }
      corner.edgesEnd = static_cast<std::uint32_t>(result_.cornerEdges.size());
      corner.normal = normalizedOr(-sum, result_.faces[faceOf(around[c][0].triangle)].plane.normal);
      corner.sectorsBegin = static_cast<std::uint32_t>(result_.sectors.size());
      findSectors(around[c]);
      findCoveringFaces(corner.point, around[c]);
      corner.sectorsEnd = static_cast<std::uint32_t>(result_.sectors.size());
    }
  }

  /// Triangles around one corner that hang together over edges inside a face make one sector.
  void findSectors(std::vector<TriangleSide> left) {
    while (!left.empty()) {
      std::vector<TriangleSide> sector{left.front()};
      left.erase(left.begin());
      for (std::size_t i = 0; i < sector.size(); ++i) {
        for (auto other = left.begin(); other != left.end();) {
          const bool joined = shareInnerEdge(sector[i], *other);
          if (joined) sector.push_back(*other);
          other = joined ? left.erase(other) : other + 1;
        }
      }
      keepIfWide(sector);
    }
  }

  bool shareInnerEdge(TriangleSide a, TriangleSide b) const {
    const auto& ofA = edges_.ofTriangle[static_cast<std::size_t>(a.triangle)];
    const auto& ofB = edges_.ofTriangle[static_cast<std::size_t>(b.triangle)];
    for (const int i : {a.side, (a.side + 2) % 3})
      for (const int j : {b.side, (b.side + 2) % 3})
        if (ofA[static_cast<std::size_t>(i)] == ofB[static_cast<std::size_t>(j)] && !isReal(ofA[static_cast<std::size_t>(i)])) return true;
    return false;
  }

  void keepIfWide(const std::vector<TriangleSide>& sector) {
    double angle = 0;
    Vec3 sum = Vec3::Zero();  // of the unit vectors of all directions in the sector: 2 sin(angle / 2) along the bisector
    for (const TriangleSide side : sector) {
      const Vec3& apex = vertexOf(result_.mesh, triangle(side.triangle), side.side);
      const Vec3 a = (vertexOf(result_.mesh, triangle(side.triangle), side.side + 1) - apex).normalized();
      const Vec3 b = (vertexOf(result_.mesh, triangle(side.triangle), side.side + 2) - apex).normalized();
      const double half = 0.5 * portable::atan2(a.cross(b).norm(), a.dot(b));
      angle += 2 * half;
      if (const Vec3 middle = a + b; middle.norm() > 0) sum += 2 * portable::sin(half) * middle.normalized();
    }
    constexpr double pi = std::numbers::pi;
    if (angle < 0.9 * pi) return;
    const Face& face = result_.faces[faceOf(sector[0].triangle)];
    const bool all = angle > 2 * pi - 1e-4;  // every direction: the face goes all around
    result_.sectors.push_back({face.plane.normal, normalizedOr(sum, face.u), all ? -2 : portable::cos(angle / 2) - 1e-9});
  }

  /// A corner in the midst of a face, of triangles that overlap or leave a gap too narrow to count.
  void findCoveringFaces(const Vec3& point, const std::vector<TriangleSide>& around) {
    std::vector<std::uint32_t> faces;
    for (const TriangleSide side : around) faces.push_back(faceOf(side.triangle));
    std::sort(faces.begin(), faces.end());
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    for (const std::uint32_t f : faces) {
      const Face& face = result_.faces[f];
      bool all = true;
      for (int k = 0; k < 8 && all; ++k) {
        const double phi = (2 * k + 1) * std::numbers::pi / 8;
        all = covers(face, point + 2 * result_.slack * (portable::cos(phi) * face.u + portable::sin(phi) * face.v));
      }
      if (all) result_.sectors.push_back({face.plane.normal, face.u, -2});
    }
  }

  void listCorners() {
    std::vector<std::vector<std::uint32_t>> ofFace(result_.faces.size());
    for (std::size_t t = 0; t < result_.mesh.triangles.size(); ++t)
      for (const int v : result_.mesh.triangles[t])
        if (const std::uint32_t c = cornerOf_[static_cast<std::size_t>(v)]; c != noCorner) ofFace[result_.faceOfTriangle[t]].push_back(c);
    auto& begin = result_.cornersBegin;
    auto& of = result_.cornersOf;
    begin.push_back(0);
    const auto close = [&] { begin.push_back(static_cast<std::uint32_t>(of.size())); };
    for (auto& corners : ofFace) {
      std::sort(corners.begin(), corners.end());
      of.insert(of.end(), corners.begin(), std::unique(corners.begin(), corners.end()));
      close();
    }
    for (const Edge& edge : result_.edges) {
      of.insert(of.end(), {std::min(edge.cornerA, edge.cornerB), std::max(edge.cornerA, edge.cornerB)});
      close();
    }
    for (std::uint32_t c = 0; c < result_.corners.size(); ++c) {
      of.push_back(c);
      close();
    }
  }

  static constexpr std::uint32_t noCorner = ~std::uint32_t{0};

  double tolerance_;
  MeshEdges edges_;
  std::vector<std::vector<FaceAt>> facesAt_;          ///< of each real mesh edge; empty for one inside a face
  std::vector<std::vector<std::uint32_t>> atVertex_;  ///< real mesh edges at each vertex
  std::vector<Line> lines_;
  std::vector<std::uint32_t> cornerOf_;  ///< of each vertex
  Features result_;
};

}  // namespace

Features findFeatures(TriangleMesh mesh, double tolerance, double slack) { return Builder(std::move(mesh), tolerance, slack).build(); }

}  // namespace tsubu::sim
