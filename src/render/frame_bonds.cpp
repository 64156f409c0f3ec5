// Bonds of a frame: round bars of triangles with the normals of a cylinder, among the opaque walls. So they are found, lit, shaded and
// darkened as walls are, without a pass of their own.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "render/colour_map.h"
#include "render/frame.h"

namespace tsubu::render {

namespace {

constexpr int mostSides = 24;

/// A bar in the frame of the world.
struct Bar {
  Vec3 first, second, across, other;  // ends; two unit vectors across
  double radius;
  int look;
};

struct Rim {
  Vec3 first, second, normal;  // of one edge of the bar
};

std::array<Rim, mostSides> rimOf(const Bar& bar, int sides) {
  std::array<Rim, mostSides> rim;
  for (int k = 0; k < sides; ++k) {
    const double angle = 2 * std::numbers::pi * k / sides;
    const Vec3 n = std::cos(angle) * bar.across + std::sin(angle) * bar.other;
    rim[static_cast<std::size_t>(k)] = {bar.first + bar.radius * n, bar.second + bar.radius * n, n};
  }
  return rim;
}

class Bars {
 public:
  Bars(Frame& frame, double pixel, bool capped, bool shadows) : frame_(frame), pixel_(pixel), capped_(capped), shadows_(shadows) {}

  void add(const Bar& bar) {
    const View& view = frame_.view;
    const double depth = -std::max(view.toView(bar.first).z(), view.toView(bar.second).z());
    const double samples = bar.radius / (std::max(depth, frame_.nearPlane) * pixel_);
    const int sides = std::clamp(4 + 2 * static_cast<int>(std::sqrt(2 * samples)), 6, mostSides);
    const std::array<Rim, mostSides> rim = rimOf(bar, sides);
    const Vec3 sun = frame_.sun.rotation.row(2).transpose();
    for (int k = 0; k < sides; ++k) {
      const Rim &a = rim[static_cast<std::size_t>(k)], &b = rim[static_cast<std::size_t>((k + 1) % sides)];
      const Vec3 outwards = a.normal + b.normal, middle = 0.25 * (a.first + a.second + b.first + b.second);
      if (outwards.dot(middle - view.eye) < 0) {
        seen(a.first, a.second, b.second, a.normal, a.normal, b.normal, bar.look);
        seen(a.first, b.second, b.first, a.normal, b.normal, b.normal, bar.look);
      }
      // The far side throws the shadow: the near one must not shade itself.
      if (shadows_ && outwards.dot(sun) <= 0) {
        lit(a.first, a.second, b.second);
        lit(a.first, b.second, b.first);
      }
    }
    if (!capped_) return;
    const Vec3 along = (bar.first - bar.second).normalized();
    for (int k = 1; k + 1 < sides; ++k) {
      const Rim &a = rim[0], &b = rim[static_cast<std::size_t>(k)], &c = rim[static_cast<std::size_t>(k) + 1];
      if (along.dot(bar.first - view.eye) < 0) seen(a.first, b.first, c.first, along, along, along, bar.look);
      if (along.dot(bar.second - view.eye) > 0) seen(a.second, b.second, c.second, -along, -along, -along, bar.look);
    }
  }

 private:
  void seen(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& na, const Vec3& nb, const Vec3& nc, int look) {
    corner(a, na, look);
    corner(b, nb, look);
    corner(c, nc, look);
    ++frame_.wallTriangles;
  }
  void corner(const Vec3& place, const Vec3& normal, int look) {
    const Vec3 p = frame_.view.toView(place), n = frame_.view.rotation * normal;
    append(frame_.walls, p.x(), p.y(), p.z(), look, n.x(), n.y(), n.z(), 0);
  }
  void lit(const Vec3& a, const Vec3& b, const Vec3& c) {
    for (const Vec3& place : {a, b, c}) {
      const Vec3 p = frame_.sun.toSun(place);
      append(frame_.sunWalls, p.x(), p.y(), p.z(), 1);
    }
    ++frame_.sunWallTriangles;
  }

  Frame& frame_;
  double pixel_;
  bool capped_, shadows_;
};

}  // namespace

void addBonds(Frame& frame, const std::vector<SeenBond>& bonds, const Style& style, int firstLook, int side) {
  const Range range = style.bonds.range.value_or(Range{0, 1});
  Bars bars(frame, 2 * frame.view.tanY / (style.picture.height * side), !style.grains.shown, style.light.shadows);
  for (const SeenBond& bond : bonds) {
    const Vec3 along = bond.second - bond.first;
    double radius = style.bonds.scale * bond.radius;
    const double load = (bond.load - range.low) / (range.high - range.low);
    int look = firstLook + static_cast<int>(std::lround(std::clamp(load, 0.0, 1.0) * (bondLooks - 1)));
    if (bond.sinceBroken >= 0) {
      look = firstLook + bondLooks;
      radius *= 1 - std::min(1.0, bond.sinceBroken / std::max(style.bonds.brokenFor, 1e-300));
    }
    if (!(along.norm() > 0) || !(radius > 0) || !along.allFinite()) continue;
    int least = 0;
    along.cwiseAbs().minCoeff(&least);
    const Vec3 across = along.cross(Vec3::Unit(least)).normalized();
    bars.add({bond.first, bond.second, across, along.normalized().cross(across), radius, look});
  }
  if (!frame.legend && std::any_of(bonds.begin(), bonds.end(), [](const SeenBond& bond) { return bond.load > 0; })) {
    frame.legend = Legend{"stress / strength", "", style.bonds.map, range, 1, true};
  }
}

std::vector<WallLook> looksOfBonds(const Bonds& style) {
  std::vector<WallLook> looks(bondLooks + 1);
  for (int k = 0; k < bondLooks; ++k) looks[static_cast<std::size_t>(k)].colour = mapped(style.map, k / (bondLooks - 1.0));
  looks.back().colour = style.broken;
  return looks;
}

}  // namespace tsubu::render
