#include "render/wall_model.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>

namespace tsubu::render {

namespace {

const double creaseCosine = std::cos(20 * std::numbers::pi / 180);
const double smoothCosine = std::cos(30 * std::numbers::pi / 180);

using Indices = std::array<int, 3>;

/// The mesh with one vertex per place, and only triangles that have an area.
struct Welded {
  std::vector<Vec3> vertices;
  std::vector<Indices> triangles;
};

Welded weld(const TriangleMesh& mesh) {
  Box box;
  for (const Vec3& v : mesh.vertices) {
    if (v.allFinite()) box.extend(v);
  }
  const double grain = box.isEmpty() ? 1 : std::max(box.diagonal().norm() * 1e-9, 1e-300);
  std::map<std::tuple<double, double, double>, int> places;
  Welded welded;
  std::vector<int> joined(mesh.vertices.size(), -1);
  for (std::size_t k = 0; k < mesh.vertices.size(); ++k) {
    const Vec3& v = mesh.vertices[k];
    if (!v.allFinite()) continue;
    const auto place = std::tuple(std::round(v.x() / grain), std::round(v.y() / grain), std::round(v.z() / grain));
    const auto [at, isNew] = places.try_emplace(place, static_cast<int>(welded.vertices.size()));
    if (isNew) welded.vertices.push_back(v);
    joined[k] = at->second;
  }
  for (const Indices& t : mesh.triangles) {
    Indices w;
    bool good = true;
    for (std::size_t c = 0; c < 3; ++c) {
      const bool exists = t[c] >= 0 && static_cast<std::size_t>(t[c]) < joined.size();
      w[c] = exists ? joined[static_cast<std::size_t>(t[c])] : -1;
      good = good && w[c] >= 0;
    }
    if (good && w[0] != w[1] && w[1] != w[2] && w[2] != w[0]) welded.triangles.push_back(w);
  }
  return welded;
}

std::vector<FeatureEdge> featureEdges(const Welded& mesh, const std::vector<WallModel::Triangle>& triangles) {
  struct Side {
    std::size_t triangle;
    bool forward;
  };
  std::map<std::pair<int, int>, std::vector<Side>> sides;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t c = 0; c < 3; ++c) {
      const int from = mesh.triangles[t][c], to = mesh.triangles[t][(c + 1) % 3];
      sides[std::minmax(from, to)].push_back({t, from < to});
    }
  }
  std::vector<FeatureEdge> edges;
  for (const auto& [ends, list] : sides) {
    bool feature = list.size() != 2;
    if (!feature) {
      // Neighbours that agree on which side is out run along their common edge in opposite directions.
      const double sign = list[0].forward == list[1].forward ? -1 : 1;
      feature = sign * triangles[list[0].triangle].normal.dot(triangles[list[1].triangle].normal) < creaseCosine;
    }
    if (feature) {
      edges.push_back({mesh.vertices[static_cast<std::size_t>(ends.first)], mesh.vertices[static_cast<std::size_t>(ends.second)]});
    }
  }
  return edges;
}

void smoothNormals(const Welded& mesh, std::vector<WallModel::Triangle>& triangles) {
  std::vector<std::vector<std::size_t>> around(mesh.vertices.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const int v : mesh.triangles[t]) around[static_cast<std::size_t>(v)].push_back(t);
  }
  const auto angleAt = [&](std::size_t t, int vertex) {
    const Indices& corners = mesh.triangles[t];
    const auto c = static_cast<std::size_t>(std::find(corners.begin(), corners.end(), vertex) - corners.begin());
    const auto& p = triangles[t].corners;
    const Vec3 a = (p[(c + 1) % 3] - p[c]).normalized(), b = (p[(c + 2) % 3] - p[c]).normalized();
    return std::acos(std::clamp(a.dot(b), -1.0, 1.0));
  };
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t c = 0; c < 3; ++c) {
      const int vertex = mesh.triangles[t][c];
      Vec3 sum = Vec3::Zero();
      for (const std::size_t other : around[static_cast<std::size_t>(vertex)]) {
        // A file may wind its triangles either way; what counts is how much the surface bends.
        const double cosine = triangles[t].normal.dot(triangles[other].normal);
        if (std::abs(cosine) > smoothCosine) sum += (cosine < 0 ? -1 : 1) * angleAt(other, vertex) * triangles[other].normal;
      }
      triangles[t].normals[c] = sum.norm() > 0 ? Vec3(sum.normalized()) : triangles[t].normal;
    }
  }
}

/// Ericson, Real-Time Collision Detection (2005), section 5.1.5.
Vec3 closestOnTriangle(const Vec3& p, const std::array<Vec3, 3>& corners) {
  const auto& [a, b, c] = corners;
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const Vec3 bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + ab * (d1 / (d1 - d3));
  const Vec3 cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + ac * (d2 / (d2 - d6));
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return b + (c - b) * ((d4 - d3) / (d4 - d3 + d5 - d6));
  const double scale = 1 / (va + vb + vc);
  return a + ab * (vb * scale) + ac * (vc * scale);
}

}  // namespace

WallModel::WallModel(const TriangleMesh& mesh) {
  Welded welded = weld(mesh);
  std::vector<Indices> withArea;
  for (const Indices& t : welded.triangles) {
    std::array<Vec3, 3> p;
    for (std::size_t c = 0; c < 3; ++c) p[c] = welded.vertices[static_cast<std::size_t>(t[c])];
    const Vec3 normal = (p[1] - p[0]).cross(p[2] - p[0]);
    if (!(normal.norm() > 0)) continue;
    withArea.push_back(t);
    triangles_.push_back({p, {p[0], p[0], p[0]}, normal.normalized()});
    for (const Vec3& corner : p) bounds_.extend(corner);
  }
  welded.triangles = std::move(withArea);
  smoothNormals(welded, triangles_);
  edges_ = featureEdges(welded, triangles_);
  order_.resize(triangles_.size());
  for (std::uint32_t t = 0; t < order_.size(); ++t) order_[t] = t;
  if (!order_.empty()) buildTree(0, static_cast<std::uint32_t>(order_.size()));
}

std::uint32_t WallModel::buildTree(std::uint32_t first, std::uint32_t count) {
  const auto self = static_cast<std::uint32_t>(tree_.size());
  Node node{Box(), first, count};
  for (std::uint32_t k = first; k < first + count; ++k) {
    for (const Vec3& corner : triangles_[order_[k]].corners) node.box.extend(corner);
  }
  tree_.push_back(node);
  if (count <= 4) return self;
  Eigen::Index axis;
  node.box.sizes().maxCoeff(&axis);
  const auto middle = [&](std::uint32_t t) {
    const auto& c = triangles_[t].corners;
    return c[0][axis] + c[1][axis] + c[2][axis];
  };
  std::sort(order_.begin() + first, order_.begin() + first + count,
            [&](std::uint32_t a, std::uint32_t b) { return middle(a) != middle(b) ? middle(a) < middle(b) : a < b; });
  buildTree(first, count / 2);
  const std::uint32_t second = buildTree(first + count / 2, count - count / 2);
  tree_[self].first = second;
  tree_[self].count = 0;
  return self;
}

void WallModel::closestPoints(const Vec3& point, double within, std::vector<Vec3>& found) const {
  if (tree_.empty()) return;
  std::array<std::uint32_t, 64> stack;  // the tree is balanced: far fewer levels than this
  std::size_t height = 0;
  stack[height++] = 0;
  while (height > 0) {
    const std::uint32_t at = stack[--height];
    const Node& node = tree_[at];
    if (node.box.squaredExteriorDistance(point) >= within * within) continue;
    if (node.count == 0) {
      stack[height++] = node.first;
      stack[height++] = at + 1;
      continue;
    }
    for (std::uint32_t k = node.first; k < node.first + node.count; ++k) {
      const Vec3 nearest = closestOnTriangle(point, triangles_[order_[k]].corners);
      if ((nearest - point).squaredNorm() < within * within) found.push_back(nearest);
    }
  }
}

}  // namespace tsubu::render
