#include "render/grain_view.h"

#include <algorithm>
#include <cmath>

#include "render/cull.h"

namespace tsubu::render {

namespace {

constexpr double largestNumber = 1e15;  // m: squares of what is drawn must fit into single precision

/// The slopes x/depth of the two planes through the eye and an axis of the picture that touch a sphere at (x, depth).
/// From (x − s·depth)² = r²·(1 + s²).
std::array<double, 2> tangentSlopes(double x, double depth, double r) {
  const double a = depth * depth - r * r, root = r * std::sqrt(std::max(0.0, x * x + a));
  return {(x * depth - root) / a, (x * depth + root) / a};
}

/// Cells of the culling raster: small against the grains, so that gaps between them count, and few.
double cullCell(std::vector<double> radii) {
  if (radii.empty()) return 4;
  const auto middle = radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 2);
  std::nth_element(radii.begin(), middle, radii.end());
  return std::clamp(*middle / 4, 1.0, 8.0);
}

}  // namespace

std::vector<std::uint32_t> drawableGrains(const Snapshot& snapshot) {
  std::vector<std::uint32_t> drawable;
  drawable.reserve(snapshot.grains());
  for (std::uint32_t k = 0; k < snapshot.grains(); ++k) {
    const bool placed = snapshot.position[k].allFinite() && snapshot.position[k].lpNorm<Eigen::Infinity>() < largestNumber;
    const bool sized = snapshot.radius[k] > 1 / largestNumber && snapshot.radius[k] < largestNumber;
    if (placed && sized) drawable.push_back(k);
  }
  return drawable;
}

std::vector<SeenGrain> seenGrains(const Snapshot& snapshot, const std::vector<std::uint32_t>& drawable, const View& view, double nearPlane,
                                  int width, int height) {
  std::vector<SeenGrain> candidates;
  std::vector<double> onScreen;
  for (const std::uint32_t k : drawable) {
    const double r = snapshot.radius[k];
    const Vec3 c = view.toView(snapshot.position[k]);
    const double depth = -c.z();
    if (depth + r <= nearPlane || c.squaredNorm() <= r * r) continue;
    std::array<double, 4> box{-1, -1, 1, 1};
    if (depth > r) {
      const auto x = tangentSlopes(c.x(), depth, r), y = tangentSlopes(c.y(), depth, r);
      box = {x[0] / view.tanX, y[0] / view.tanY, x[1] / view.tanX, y[1] / view.tanY};
      if (!(box[0] < 1 && box[2] > -1 && box[1] < 1 && box[3] > -1)) continue;
      onScreen.push_back(0.5 * height * r / (depth * view.tanY));
    }
    // A hair wider, against rounding.
    const auto f = [](double v) { return static_cast<float>(v); };
    candidates.push_back({k, c.cast<float>(), f(r), {f(box[0] - 1e-6), f(box[1] - 1e-6), f(box[2] + 1e-6), f(box[3] + 1e-6)}});
  }
  const double cell = cullCell(std::move(onScreen));
  const int columns = static_cast<int>(std::ceil(width / cell)), rows = static_cast<int>(std::ceil(height / cell));
  const double scaleX = 0.5 * width / cell, scaleY = 0.5 * height / cell;
  std::vector<Splat> splats;
  splats.reserve(candidates.size());
  for (const SeenGrain& g : candidates) {
    const double r = g.radius, depth = -static_cast<double>(g.centre.z());
    const auto f = [](double v) { return static_cast<float>(v); };
    Splat s{0, 0, 0, f(scaleX), f(scaleY), f(2 * (scaleX + scaleY)), f(std::max(0.0, depth - r)), f(std::max(0.0, depth))};
    if (depth > r) {
      // Covered: the disc through the centre, parallel to the picture. Touched: the ellipse, whose half-axes a and b obey
      // a² + b² = sum of the squared half-edges of its box, with b not less than the radius of that disc.
      const double halfX = (g.box[2] - g.box[0]) * 0.5 * scaleX, halfY = (g.box[3] - g.box[1]) * 0.5 * scaleY;
      const double inner = r * scaleY / (depth * view.tanY);
      s.x = f((1 + g.centre.x() / (depth * view.tanX)) * scaleX), s.y = f((1 - g.centre.y() / (depth * view.tanY)) * scaleY);
      s.inner = f(inner);
      s.outerX = f((1 + 0.5 * (g.box[0] + g.box[2])) * scaleX), s.outerY = f((1 - 0.5 * (g.box[1] + g.box[3])) * scaleY);
      s.outer = f(std::sqrt(std::max(halfX * halfX + halfY * halfY - inner * inner, halfX * halfX)) * 1.001 + 0.01);
    }
    splats.push_back(s);
  }
  std::vector<SeenGrain> seen;
  for (const std::uint32_t k : notHidden(splats, columns, rows)) seen.push_back(candidates[k]);
  return seen;
}

SunView sunOver(const Box& bounds, const Vec3& from) {
  const Vec3 back = from.normalized();
  const Vec3 right = (std::abs(back.z()) < 0.99 ? Vec3::UnitZ() : Vec3::UnitX()).cross(back).normalized();
  SunView sun;
  sun.rotation << right.transpose(), back.cross(right).transpose(), back.transpose();
  if (bounds.isEmpty()) return sun;
  Box box;
  for (int k = 0; k < 8; ++k) box.extend(sun.rotation * bounds.corner(static_cast<Box::CornerType>(k)));
  sun.centre = box.center();
  sun.half = (0.51 * box.sizes()).cwiseMax(1e-9 + 1e-6 * box.diagonal().norm());
  return sun;
}

std::vector<ShadowDisc> shadowDiscs(const Snapshot& snapshot, const std::vector<std::uint32_t>& drawable, const SunView& sun, int size) {
  std::vector<ShadowDisc> discs;
  std::vector<double> onMap;
  for (const std::uint32_t k : drawable) {
    const Vec3 p = sun.toSun(snapshot.position[k]);
    const double rx = snapshot.radius[k] / sun.half.x(), ry = snapshot.radius[k] / sun.half.y();
    if (std::abs(p.x()) > 1 + rx || std::abs(p.y()) > 1 + ry) continue;
    const auto f = [](double v) { return static_cast<float>(v); };
    discs.push_back({f(p.x()), f(p.y()), f(std::clamp(p.z(), 0.0, 1.0)), f(rx), f(ry)});
    onMap.push_back(0.5 * size * std::min(rx, ry));
  }
  const double cell = cullCell(std::move(onMap));
  const int cells = static_cast<int>(std::ceil(size / cell));
  const float scale = static_cast<float>(0.5 * size / cell);
  std::vector<Splat> splats;
  splats.reserve(discs.size());
  for (const ShadowDisc& d : discs) {
    const float x = (1 + d.x) * scale, y = (1 - d.y) * scale;
    splats.push_back({x, y, std::min(d.radiusX, d.radiusY) * scale, x, y, std::max(d.radiusX, d.radiusY) * scale, d.z, d.z});
  }
  std::vector<ShadowDisc> lit;
  for (const std::uint32_t k : notHidden(splats, cells, cells)) lit.push_back(discs[k]);
  return lit;
}

}  // namespace tsubu::render
