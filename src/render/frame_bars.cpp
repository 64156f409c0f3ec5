#include "render/frame_bars.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "render/colour_map.h"

namespace tsubu::render {

namespace {

constexpr int mostSides = 24;

struct Rim {
  Vec3 first, second, normal;  // of one edge of the bar
};

std::array<Rim, mostSides> rimOf(const Vec3& first, const Vec3& second, double radius, int sides) {
  const Vec3 along = second - first;
  int least = 0;
  along.cwiseAbs().minCoeff(&least);
  const Vec3 across = along.cross(Vec3::Unit(least)).normalized(), other = along.normalized().cross(across);
  std::array<Rim, mostSides> rim;
  for (int k = 0; k < sides; ++k) {
    const double angle = 2 * std::numbers::pi * k / sides;
    const Vec3 n = std::cos(angle) * across + std::sin(angle) * other;
    rim[static_cast<std::size_t>(k)] = {first + radius * n, second + radius * n, n};
  }
  return rim;
}

}  // namespace

Bars::Bars(Frame& frame, const Style& style, bool capped, int side)
    : frame_(frame), pixel_(2 * frame.view.tanY / (style.picture.height * side)), capped_(capped), shadows_(style.light.shadows) {}

void Bars::add(const Vec3& first, const Vec3& second, double radius, int look) {
  const double length = (second - first).norm();
  if (!(length > 0) || !(radius > 0) || !std::isfinite(length)) return;
  const View& view = frame_.view;
  const double depth = -std::max(view.toView(first).z(), view.toView(second).z());
  const double samples = radius / (std::max(depth, frame_.nearPlane) * pixel_);
  const int sides = std::clamp(4 + 2 * static_cast<int>(std::sqrt(2 * samples)), 6, mostSides);
  const std::array<Rim, mostSides> rim = rimOf(first, second, radius, sides);
  const Vec3 sun = frame_.sun.rotation.row(2).transpose();
  for (int k = 0; k < sides; ++k) {
    const Rim &a = rim[static_cast<std::size_t>(k)], &b = rim[static_cast<std::size_t>((k + 1) % sides)];
    const Vec3 outwards = a.normal + b.normal, middle = 0.25 * (a.first + a.second + b.first + b.second);
    if (outwards.dot(middle - view.eye) < 0) {
      seen(a.first, a.second, b.second, a.normal, a.normal, b.normal, look);
      seen(a.first, b.second, b.first, a.normal, b.normal, b.normal, look);
    }
    // The far side throws the shadow: the near one must not shade itself.
    if (shadows_ && outwards.dot(sun) <= 0) {
      lit(a.first, a.second, b.second);
      lit(a.first, b.second, b.first);
    }
  }
  if (!capped_) return;
  const Vec3 along = (first - second) / length;
  for (int k = 1; k + 1 < sides; ++k) {
    const Rim &a = rim[0], &b = rim[static_cast<std::size_t>(k)], &c = rim[static_cast<std::size_t>(k) + 1];
    if (along.dot(first - view.eye) < 0) seen(a.first, b.first, c.first, along, along, along, look);
    if (along.dot(second - view.eye) > 0) seen(a.second, b.second, c.second, -along, -along, -along, look);
  }
}

void Bars::seen(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& na, const Vec3& nb, const Vec3& nc, int look) {
  corner(a, na, look);
  corner(b, nb, look);
  corner(c, nc, look);
  ++frame_.wallTriangles;
}

void Bars::corner(const Vec3& place, const Vec3& normal, int look) {
  const Vec3 p = frame_.view.toView(place), n = frame_.view.rotation * normal;
  append(frame_.walls, p.x(), p.y(), p.z(), look, n.x(), n.y(), n.z(), 0);
}

void Bars::lit(const Vec3& a, const Vec3& b, const Vec3& c) {
  for (const Vec3& place : {a, b, c}) {
    const Vec3 p = frame_.sun.toSun(place);
    append(frame_.sunWalls, p.x(), p.y(), p.z(), 1);
  }
  ++frame_.sunWallTriangles;
}

std::vector<WallLook> looksOfBars(ColourMap map) {
  std::vector<WallLook> looks(barLooks);
  for (int k = 0; k < barLooks; ++k) looks[static_cast<std::size_t>(k)].colour = mapped(map, k / (barLooks - 1.0));
  return looks;
}

int barLook(double value, const Range& range) {
  return static_cast<int>(std::lround(std::clamp((value - range.low) / (range.high - range.low), 0.0, 1.0) * (barLooks - 1)));
}

}  // namespace tsubu::render
