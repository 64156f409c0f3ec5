#include "sim/walls/repair.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>
#include <unordered_map>

#include <fmt/format.h>

#include "core/error.h"
#include "core/hash.h"
#include "sim/walls/bvh.h"
#include "sim/walls/mesh_edges.h"
#include "sim/walls/overlaps.h"

namespace tsubu::sim {

namespace {

/// A triangle whose height is this fraction of its longest side is a sliver.
constexpr double sliverFraction = 1e-4;

/// T-joints are looked for again after each repair, at most so often. One round does for all but wilfully bad meshes.
constexpr int mostPasses = 10;

/// "triangle 7", "triangles 3, 5 and 8", "100 triangles, first 3, 5, 8 …".
std::string nameTriangles(const std::vector<int>& triangles) {
  constexpr std::size_t most = 8;
  if (triangles.size() == 1) return fmt::format("triangle {}", triangles[0]);
  const std::size_t shown = std::min(most, triangles.size());
  std::string text = triangles.size() > most ? fmt::format("{} triangles, first ", triangles.size()) : "triangles ";
  for (std::size_t i = 0; i < shown; ++i) {
    const char* before = i == 0 ? "" : (i + 1 == triangles.size() ? " and " : ", ");
    text += fmt::format("{}{}", before, triangles[i]);
  }
  return triangles.size() > most ? text + " …" : text;
}

/// Gathers the triangles of each kind of fault and puts them into sentences.
class FaultList {
 public:
  explicit FaultList(std::string mesh) : mesh_(std::move(mesh)) {}

  void add(MeshFaultKind kind, int triangle) { triangles_[kind].push_back(triangle); }

  bool refuses() const { return triangles_.contains(MeshFaultKind::badIndex) || triangles_.contains(MeshFaultKind::notFinite); }

  std::vector<MeshFault> list() const {
    std::vector<MeshFault> faults;
    for (auto [kind, triangles] : triangles_) {
      std::sort(triangles.begin(), triangles.end());
      triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
      const auto [remedy, what] = describe(kind);
      faults.push_back(
          {kind, remedy, triangles, fmt::format("The mesh '{}': {}.", mesh_, fmt::format(fmt::runtime(what), nameTriangles(triangles)))});
    }
    return faults;
  }

  [[noreturn]] void refuse() const {
    std::vector<Diagnostic> diagnostics;
    for (const MeshFault& fault : list()) {
      if (fault.remedy != MeshRemedy::refused) continue;
      Diagnostic& diagnostic = diagnostics.emplace_back();
      diagnostic.message = fault.sentence;
      diagnostic.hint = "Mend the mesh in the program that wrote it.";
    }
    throw Error(ErrorKind::files, std::move(diagnostics));
  }

 private:
  static std::pair<MeshRemedy, const char*> describe(MeshFaultKind kind) {
    switch (kind) {
      case MeshFaultKind::badIndex:
        return {MeshRemedy::refused, "a vertex that does not exist is named by {}"};
      case MeshFaultKind::notFinite:
        return {MeshRemedy::refused, "a vertex is not a finite number in {}"};
      case MeshFaultKind::empty:
        return {MeshRemedy::refused, "no triangle has an area"};
      case MeshFaultKind::degenerate:
        return {MeshRemedy::repaired, "without area, left out: {}"};
      case MeshFaultKind::duplicate:
        return {MeshRemedy::repaired, "repeated from an earlier triangle, left out: {}"};
      case MeshFaultKind::tJoint:
        return {MeshRemedy::repaired, "a vertex of another triangle lies inside an edge, which was split: {}"};
      case MeshFaultKind::sliver:
        return {MeshRemedy::harmless, "more than ten thousand times longer than wide, kept: {}"};
      case MeshFaultKind::nonManifold:
        return {MeshRemedy::harmless, "three or more triangles meet in one edge, kept: {}"};
      case MeshFaultKind::inconsistentWinding:
        return {MeshRemedy::harmless, "turned the other way than a neighbour, which two-sided walls do not mind: {}"};
      case MeshFaultKind::overlap:
        return {MeshRemedy::harmless, "covering the same area of one plane, counted once: {}"};
    }
    return {MeshRemedy::refused, ""};
  }

  std::string mesh_;
  std::map<MeshFaultKind, std::vector<int>> triangles_;
};

/// Faults that leave nothing to build on: vertices that do not exist or are not finite.
void checkNumbers(const TriangleMesh& mesh, FaultList& faults) {
  const int vertices = static_cast<int>(mesh.vertices.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const int v : mesh.triangles[t]) {
      if (v < 0 || v >= vertices)
        faults.add(MeshFaultKind::badIndex, static_cast<int>(t));
      else if (!vertexOf(mesh, v).allFinite())
        faults.add(MeshFaultKind::notFinite, static_cast<int>(t));
    }
  }
  if (faults.refuses()) faults.refuse();
}

/// A hash of space: the cells hold the vertices that others may be welded to, in ascending order.
class Welder {
 public:
  Welder(const Box& box, double tolerance) : lower_(box.min()), tolerance_(tolerance), cell_(16 * tolerance) {}

  /// The first vertex before this one that lies within the tolerance, or this one itself.
  int weld(const std::vector<Vec3>& vertices, int vertex) {
    const Vec3& x = vertices[static_cast<std::size_t>(vertex)];
    const auto low = cellOf(x - Vec3::Constant(tolerance_)), high = cellOf(x + Vec3::Constant(tolerance_));
    int found = vertex;
    for (std::int64_t i = low[0]; i <= high[0]; ++i)
      for (std::int64_t j = low[1]; j <= high[1]; ++j)
        for (std::int64_t k = low[2]; k <= high[2]; ++k) found = std::min(found, firstNear(vertices, x, {i, j, k}, vertex));
    if (found == vertex) cells_[key(cellOf(x))].push_back(vertex);
    return found;
  }

 private:
  using Cell = std::array<std::int64_t, 3>;

  Cell cellOf(const Vec3& x) const {
    const Vec3 c = (x - lower_) / cell_;
    return {static_cast<std::int64_t>(std::floor(c.x())), static_cast<std::int64_t>(std::floor(c.y())),
            static_cast<std::int64_t>(std::floor(c.z()))};
  }
  static std::uint64_t key(const Cell& c) {  // at most 1/(16 · 1e-7) cells a side: 20 bits, and a little room below zero
    return static_cast<std::uint64_t>(c[0] + 1) << 42 | static_cast<std::uint64_t>(c[1] + 1) << 21 | static_cast<std::uint64_t>(c[2] + 1);
  }
  int firstNear(const std::vector<Vec3>& vertices, const Vec3& x, const Cell& cell, int best) const {
    const auto at = cells_.find(key(cell));
    if (at == cells_.end()) return best;
    for (const int other : at->second)
      if (other < best && (vertices[static_cast<std::size_t>(other)] - x).squaredNorm() <= tolerance_ * tolerance_) best = other;
    return best;
  }

  Vec3 lower_;
  double tolerance_, cell_;
  std::unordered_map<std::uint64_t, std::vector<int>> cells_;
};

double height(const TriangleMesh& mesh, std::array<int, 3> t) {
  const double longest = longestSide(mesh, t);
  return longest > 0 ? 2 * areaVector(mesh, t).norm() / longest : 0;
}

/// Keeps the triangles for which keep(t) holds.
template <class Keep>
void filter(RepairedMesh& repaired, Keep&& keep) {
  std::size_t kept = 0;
  for (std::size_t t = 0; t < repaired.mesh.triangles.size(); ++t) {
    if (!keep(t)) continue;
    repaired.mesh.triangles[kept] = repaired.mesh.triangles[t];
    repaired.source[kept++] = repaired.source[t];
  }
  repaired.mesh.triangles.resize(kept);
  repaired.source.resize(kept);
}

void weld(RepairedMesh& repaired, const Box& box) {
  Welder welder(box, repaired.weldTolerance);
  std::vector<int> to(repaired.mesh.vertices.size(), -1);
  for (auto& triangle : repaired.mesh.triangles) {
    for (int& v : triangle) {
      int& target = to[static_cast<std::size_t>(v)];
      if (target < 0) target = welder.weld(repaired.mesh.vertices, v);
      v = target;
    }
  }
}

void dropDegenerate(RepairedMesh& repaired, FaultList* faults) {
  filter(repaired, [&](std::size_t t) {
    const bool fine = height(repaired.mesh, repaired.mesh.triangles[t]) > repaired.weldTolerance;
    if (!fine && faults) faults->add(MeshFaultKind::degenerate, repaired.source[t]);
    return fine;
  });
}

void dropDuplicates(RepairedMesh& repaired, FaultList& faults) {
  std::vector<std::array<int, 3>> keys = repaired.mesh.triangles;
  for (auto& key : keys) std::sort(key.begin(), key.end());
  std::vector<std::size_t> order(keys.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return keys[a] != keys[b] ? keys[a] < keys[b] : a < b; });
  std::vector<char> repeated(keys.size());
  for (std::size_t i = 1; i < order.size(); ++i)
    if (keys[order[i]] == keys[order[i - 1]]) repeated[order[i]] = 1;
  filter(repaired, [&](std::size_t t) {
    if (repeated[t]) faults.add(MeshFaultKind::duplicate, repaired.source[t]);
    return !repeated[t];
  });
}

/// A vertex that lies inside a side of a triangle, at the fraction `at` of it.
struct Joint {
  TriangleSide side;
  double at;
  int vertex;
};

/// Only an edge with one triangle can hide a T-joint, and only the end of another such edge can be one.
std::vector<Joint> findJoints(const RepairedMesh& repaired) {
  const TriangleMesh& mesh = repaired.mesh;
  const MeshEdges edges = findMeshEdges(mesh.triangles);
  std::vector<const MeshEdges::Edge*> open;
  std::vector<Box> boxes;
  std::vector<int> ends;
  for (const auto& edge : edges.edges) {
    if (edge.count() != 1) continue;
    open.push_back(&edge);
    boxes.emplace_back(vertexOf(mesh, edge.a), vertexOf(mesh, edge.a));
    boxes.back().extend(vertexOf(mesh, edge.b));
    ends.insert(ends.end(), {edge.a, edge.b});
  }
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());

  std::vector<Joint> joints;
  const Bvh tree(boxes);
  for (const int vertex : ends) {
    const Vec3& x = vertexOf(mesh, vertex);
    tree.near(x, repaired.flatTolerance, [&](std::uint32_t index) {
      const auto& edge = *open[index];
      if (vertex == edge.a || vertex == edge.b) return;
      const TriangleSide side = edges.sides[edge.begin];
      const auto& triangle = mesh.triangles[static_cast<std::size_t>(side.triangle)];
      const Vec3& from = vertexOf(mesh, triangle, side.side);
      const Vec3 along = vertexOf(mesh, triangle, side.side + 1) - from;
      const double length = along.norm(), t = (x - from).dot(along) / (length * length);
      if (t > 0 && t < 1 && (x - from - t * along).norm() <= repaired.flatTolerance) joints.push_back({side, t, vertex});
    });
  }
  std::sort(joints.begin(), joints.end(), [](const Joint& a, const Joint& b) {
    return std::tie(a.side.triangle, a.side.side, a.at, a.vertex) < std::tie(b.side.triangle, b.side.side, b.at, b.vertex);
  });
  return joints;
}

/// Replaces the piece that has the side (a, b) by a fan from its third corner over the vertices on that side.
void splitSide(std::vector<std::array<int, 3>>& pieces, int a, int b, const std::vector<int>& between) {
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (pieces[p][k] != a || pieces[p][(k + 1) % 3] != b) continue;
      const int apex = pieces[p][(k + 2) % 3];
      int from = a;
      std::vector<std::array<int, 3>> fan;
      for (const int v : between) {
        fan.push_back({from, v, apex});
        from = v;
      }
      pieces[p] = {from, b, apex};
      pieces.insert(pieces.end(), fan.begin(), fan.end());
      return;
    }
  }
}

/// Splits every triangle that has a vertex inside one of its sides. False when there is none.
bool splitJoints(RepairedMesh& repaired, FaultList& faults) {
  const std::vector<Joint> joints = findJoints(repaired);
  auto& triangles = repaired.mesh.triangles;
  for (std::size_t begin = 0, end; begin < joints.size(); begin = end) {
    const int index = joints[begin].side.triangle;
    const std::array<int, 3> whole = triangles[static_cast<std::size_t>(index)];
    const int source = repaired.source[static_cast<std::size_t>(index)];
    faults.add(MeshFaultKind::tJoint, source);
    std::array<std::vector<int>, 3> between;
    for (end = begin; end < joints.size() && joints[end].side.triangle == index; ++end)
      between[static_cast<std::size_t>(joints[end].side.side)].push_back(joints[end].vertex);
    std::vector<std::array<int, 3>> pieces{whole};
    for (std::size_t k = 0; k < 3; ++k)
      if (!between[k].empty()) splitSide(pieces, whole[k], whole[(k + 1) % 3], between[k]);
    triangles[static_cast<std::size_t>(index)] = pieces[0];
    triangles.insert(triangles.end(), pieces.begin() + 1, pieces.end());
    repaired.source.insert(repaired.source.end(), pieces.size() - 1, source);
  }
  return !joints.empty();
}

/// What is remarkable about the mesh but needs no mending.
void noteHarmless(const RepairedMesh& repaired, FaultList& faults) {
  const TriangleMesh& mesh = repaired.mesh;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (height(mesh, mesh.triangles[t]) < sliverFraction * longestSide(mesh, mesh.triangles[t]))
      faults.add(MeshFaultKind::sliver, repaired.source[t]);
  const MeshEdges edges = findMeshEdges(mesh.triangles);
  for (const auto& edge : edges.edges) {
    const auto source = [&](std::uint32_t s) { return repaired.source[static_cast<std::size_t>(edges.sides[s].triangle)]; };
    const auto forward = [&](std::uint32_t s) {
      return mesh.triangles[static_cast<std::size_t>(edges.sides[s].triangle)][static_cast<std::size_t>(edges.sides[s].side)] == edge.a;
    };
    if (edge.count() > 2)
      for (std::uint32_t s = edge.begin; s < edge.end; ++s) faults.add(MeshFaultKind::nonManifold, source(s));
    else if (edge.count() == 2 && forward(edge.begin) == forward(edge.begin + 1))
      faults.add(MeshFaultKind::inconsistentWinding, source(edge.begin + 1));
  }
}

/// Renumbers the vertices that are used, in ascending order.
void dropUnusedVertices(TriangleMesh& mesh) {
  std::vector<int> to(mesh.vertices.size(), -1);
  for (const auto& triangle : mesh.triangles)
    for (const int v : triangle) to[static_cast<std::size_t>(v)] = 0;
  std::vector<Vec3> used;
  for (std::size_t v = 0; v < to.size(); ++v) {
    if (to[v] < 0) continue;
    to[v] = static_cast<int>(used.size());
    used.push_back(mesh.vertices[v]);
  }
  mesh.vertices = std::move(used);
  for (auto& triangle : mesh.triangles)
    for (int& v : triangle) v = to[static_cast<std::size_t>(v)];
}

}  // namespace

RepairedMesh repair(const TriangleMesh& mesh) {
  FaultList faults(mesh.name);
  checkNumbers(mesh, faults);
  Box box;
  double farthest = 0;
  for (const auto& triangle : mesh.triangles) {
    for (const int v : triangle) {
      box.extend(vertexOf(mesh, v));
      farthest = std::max(farthest, vertexOf(mesh, v).cwiseAbs().maxCoeff());
    }
  }
  RepairedMesh repaired;
  repaired.mesh = mesh;
  repaired.source.resize(mesh.triangles.size());
  std::iota(repaired.source.begin(), repaired.source.end(), 0);
  // A mesh far from its origin is as coarse as the coordinates of its file, however small it is.
  const double scale = mesh.triangles.empty() ? 0 : std::max(box.diagonal().norm(), farthest);
  repaired.weldTolerance = weldFraction * scale;
  repaired.flatTolerance = flatFraction * scale;

  if (scale > 0) {
    weld(repaired, box);
    dropDegenerate(repaired, &faults);
    dropDuplicates(repaired, faults);
    // Splinters without area that a split leaves behind may bare the next joint.
    for (int pass = 0; pass < mostPasses && splitJoints(repaired, faults); ++pass) {
      dropDegenerate(repaired, nullptr);
      dropDuplicates(repaired, faults);
    }
  }
  if (scale == 0 || repaired.mesh.triangles.empty()) {
    faults.add(MeshFaultKind::empty, 0);
    faults.refuse();
  }
  noteHarmless(repaired, faults);
  dropUnusedVertices(repaired.mesh);
  for (const auto& pair : findOverlaps(repaired.mesh, repaired.flatTolerance))
    faults.add(MeshFaultKind::overlap, repaired.source[static_cast<std::size_t>(pair.second)]);
  repaired.faults = faults.list();
  return repaired;
}

}  // namespace tsubu::sim
