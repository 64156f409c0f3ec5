#include "sim/walls/flat_regions.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace tsubu::sim {

namespace {

constexpr std::uint32_t unassigned = std::numeric_limits<std::uint32_t>::max();

class Growth {
 public:
  Growth(const TriangleMesh& mesh, const MeshEdges& edges, double flat) : mesh_(mesh), edges_(edges), flat_(flat) {
    areas_.reserve(mesh.triangles.size());
    for (const auto& triangle : mesh.triangles) areas_.push_back(areaVector(mesh, triangle));
    result_.ofTriangle.assign(mesh.triangles.size(), unassigned);
  }

  FlatRegions run() {
    std::vector<int> order(mesh_.triangles.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return area(a).squaredNorm() > area(b).squaredNorm(); });
    for (const int seed : order) {
      if (regionOf(seed) != unassigned) continue;
      for (double tolerance = flat_; !grow(seed, tolerance); tolerance /= 4) undo();
      result_.planes.push_back(plane_);
      result_.centres.push_back(moment_ / weight_);
    }
    return std::move(result_);
  }

 private:
  const Vec3& area(int t) const { return areas_[static_cast<std::size_t>(t)]; }
  std::uint32_t& regionOf(int t) { return result_.ofTriangle[static_cast<std::size_t>(t)]; }
  const std::array<int, 3>& triangle(int t) const { return mesh_.triangles[static_cast<std::size_t>(t)]; }

  /// One region from its first triangle; false when the plane drifted away from triangles that were taken in early.
  bool grow(int seed, double tolerance) {
    region_ = static_cast<std::uint32_t>(result_.planes.size());
    members_.clear();
    normal_ = moment_ = Vec3::Zero();
    weight_ = 0;
    take(seed, Vec3::Zero());
    fit();
    double fittedWeight = weight_;
    std::vector<TriangleSide> waiting;  // sides of members whose other side was not flat enough for the plane so far
    std::size_t next = 0;
    for (;;) {
      for (; next < members_.size(); ++next) {
        for (int k = 0; k < 3; ++k)
          if (!cross({members_[next], k}, tolerance)) waiting.push_back({members_[next], k});
        if (weight_ > 1.2 * fittedWeight) {
          fit();
          fittedWeight = weight_;
        }
      }
      fit();
      fittedWeight = weight_;
      std::vector<TriangleSide> again;
      again.swap(waiting);
      for (const TriangleSide side : again)
        if (!cross(side, tolerance)) waiting.push_back(side);
      if (next == members_.size()) break;
    }
    return members_.size() == 1 || std::all_of(members_.begin(), members_.end(), [&](int t) { return isFlat(t, 2 * tolerance); });
  }

  void undo() {
    for (const int t : members_) regionOf(t) = unassigned;
  }

  /// `up`: the side of the plane from which the region is seen; zero for the first triangle.
  void take(int t, const Vec3& up) {
    regionOf(t) = region_;
    members_.push_back(t);
    const Vec3 turned = area(t).dot(up) < 0 ? Vec3(-area(t)) : area(t);
    const double a = area(t).norm();
    const auto& [i, j, k] = triangle(t);
    normal_ += turned;
    moment_ += a / 3 * (vertexOf(mesh_, i) + vertexOf(mesh_, j) + vertexOf(mesh_, k));
    weight_ += a;
  }

  void fit() {
    plane_.normal = normal_.normalized();
    plane_.offset = plane_.normal.dot(moment_ / weight_);
  }

  bool isFlat(int t, double tolerance) const {
    return std::all_of(triangle(t).begin(), triangle(t).end(),
                       [&](int v) { return std::abs(plane_.signedDistance(vertexOf(mesh_, v))) <= tolerance; });
  }

  /// Takes in the triangles beyond one side of a member; false when there is one that is not flat enough yet.
  bool cross(TriangleSide side, double tolerance) {
    const auto& edge = edges_.edges[edges_.ofTriangle[static_cast<std::size_t>(side.triangle)][static_cast<std::size_t>(side.side)]];
    bool done = true;
    for (std::uint32_t s = edge.begin; s < edge.end; ++s) {
      const TriangleSide other = edges_.sides[s];
      if (regionOf(other.triangle) != unassigned) continue;
      if (isFlat(other.triangle, tolerance))
        take(other.triangle, plane_.normal);
      else
        done = false;
    }
    return done;
  }

  const TriangleMesh& mesh_;
  const MeshEdges& edges_;
  double flat_;
  std::vector<Vec3> areas_;
  FlatRegions result_;

  std::uint32_t region_ = 0;
  std::vector<int> members_;
  Vec3 normal_, moment_;
  double weight_ = 0;
  Plane plane_;
};

}  // namespace

FlatRegions findFlatRegions(const TriangleMesh& mesh, const MeshEdges& edges, double flat) { return Growth(mesh, edges, flat).run(); }

}  // namespace tsubu::sim
