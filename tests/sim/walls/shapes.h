#pragma once
// Meshes with known shapes, and what a linear spring would feel of them.

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "core/mesh.h"
#include "core/random.h"
#include "sim/walls/surface.h"

namespace tsubu::sim::test {

inline void addTriangle(TriangleMesh& mesh, const Vec3& a, const Vec3& b, const Vec3& c) {  // unwelded, as in an STL file
  const int first = static_cast<int>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {a, b, c});
  mesh.triangles.push_back({first, first + 1, first + 2});
}

inline void addQuad(TriangleMesh& mesh, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  addTriangle(mesh, a, b, c);
  addTriangle(mesh, a, c, d);
}

inline TriangleMesh makeBox(const Vec3& low, const Vec3& high) {
  TriangleMesh mesh;
  mesh.name = "box";
  const auto corner = [&](int k) { return Vec3(k & 1 ? high.x() : low.x(), k & 2 ? high.y() : low.y(), k & 4 ? high.z() : low.z()); };
  for (const auto& q : {std::array{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}})
    addQuad(mesh, corner(q[0]), corner(q[1]), corner(q[2]), corner(q[3]));
  return mesh;
}

/// The side of a truncated cone about z with n flat facets, from (radius low, z low) to (radius high, z high); corners on the circles.
inline TriangleMesh makeCone(int n, double radiusLow, double zLow, double radiusHigh, double zHigh) {
  TriangleMesh mesh;
  mesh.name = "cone";
  const auto at = [&](int k, double radius, double z) {
    const double phi = 2 * std::numbers::pi * (k % n) / n;
    return Vec3(radius * std::cos(phi), radius * std::sin(phi), z);
  };
  for (int k = 0; k < n; ++k)
    addQuad(mesh, at(k, radiusLow, zLow), at(k + 1, radiusLow, zLow), at(k + 1, radiusHigh, zHigh), at(k, radiusHigh, zHigh));
  return mesh;
}

/// The square [0, 1]² of the plane z = 0 cut into n triangles, badly: vertices inside the sides of others, and slivers, though none
/// narrower than `narrowest`.
inline TriangleMesh makeCutSquare(int n, std::uint64_t seed, double narrowest = 1e-5) {
  using Triangle = std::array<Vec3, 3>;
  const Vec3 a(0, 0, 0), b(1, 0, 0), c(1, 1, 0), d(0, 1, 0);
  const auto wide = [narrowest](const Triangle& t) {
    const double longest = std::max({(t[1] - t[0]).norm(), (t[2] - t[1]).norm(), (t[0] - t[2]).norm()});
    return (t[1] - t[0]).cross(t[2] - t[0]).norm() > longest * narrowest;
  };
  std::vector<Triangle> pieces{{a, b, c}, {a, c, d}};
  Random random(seed, 1);
  while (static_cast<int>(pieces.size()) < n) {
    const auto index = static_cast<std::size_t>(random.uniform() * static_cast<double>(pieces.size()));
    const Triangle whole = pieces[index];
    std::vector<Triangle> cut;
    if (random.uniform() < 0.6) {  // one side: a T-joint on its other side, and a sliver now and then
      const auto k = static_cast<std::size_t>(random.uniform() * 3);
      const double at = random.uniform() < 0.1 ? 1e-4 : random.uniform(0.05, 0.95);
      const Vec3 middle = whole[k] + at * (whole[(k + 1) % 3] - whole[k]);
      cut = {{whole[k], middle, whole[(k + 2) % 3]}, {middle, whole[(k + 1) % 3], whole[(k + 2) % 3]}};
    } else {  // from the middle, one piece turned the other way
      const double u = random.uniform(0.01, 0.98), v = random.uniform(0.01, 0.99 - u);
      const Vec3 middle = whole[0] + u * (whole[1] - whole[0]) + v * (whole[2] - whole[0]);
      cut = {{whole[0], whole[1], middle}, {whole[1], whole[2], middle}, {whole[0], middle, whole[2]}};
    }
    if (!std::all_of(cut.begin(), cut.end(), wide)) continue;
    pieces[index] = cut[0];
    pieces.insert(pieces.end(), cut.begin() + 1, cut.end());
  }
  TriangleMesh mesh;
  mesh.name = "square";
  for (const Triangle& t : pieces) addTriangle(mesh, t[0], t[1], t[2]);
  return mesh;
}

inline TriangleMesh transformed(TriangleMesh mesh, const Pose& pose) {
  for (Vec3& x : mesh.vertices) x = pose.toWorld(x);
  return mesh;
}

/// As a binary STL file would store it.
inline TriangleMesh rounded(TriangleMesh mesh) {
  for (Vec3& x : mesh.vertices) x = x.cast<float>().cast<double>();
  return mesh;
}

/// Asks for candidates and contacts in one go.
class Probe {
 public:
  explicit Probe(const Surface& surface) : surface_(surface) {}

  const WallContacts& contacts(const Vec3& centre, double radius) {
    surface_.candidates(centre, radius, candidates_);
    surface_.contacts(centre, radius, candidates_, contacts_);
    return contacts_;
  }
  const WallContacts& nearestPoints(const Vec3& centre, double radius) {
    surface_.candidates(centre, radius, candidates_);
    surface_.nearestPoints(centre, radius, candidates_, contacts_);
    return contacts_;
  }
  /// N, for springs of 1 N/m.
  Vec3 force(const Vec3& centre, double radius) {
    Vec3 force = Vec3::Zero();
    for (const WallContact& c : contacts(centre, radius)) force += c.weight * (radius - c.distance) * c.normal;
    return force;
  }
  /// J, for springs of 1 N/m.
  double energy(const Vec3& centre, double radius) {
    double energy = 0;
    for (const WallContact& c : contacts(centre, radius)) energy += 0.5 * c.weight * (radius - c.distance) * (radius - c.distance);
    return energy;
  }

 private:
  const Surface& surface_;
  std::vector<std::uint32_t> candidates_;
  WallContacts contacts_;
};

inline Vec3 randomIn(Random& random, const Vec3& low, const Vec3& high) {
  return {random.uniform(low.x(), high.x()), random.uniform(low.y(), high.y()), random.uniform(low.z(), high.z())};
}

inline Vec3 randomDirection(Random& random) {
  for (;;) {
    const Vec3 x = randomIn(random, Vec3::Constant(-1), Vec3::Constant(1));
    if (x.squaredNorm() < 1 && x.squaredNorm() > 1e-4) return x.normalized();
  }
}

}  // namespace tsubu::sim::test
