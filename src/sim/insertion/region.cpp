#include "sim/insertion/region.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tsubu::sim {

namespace {

struct Frame {
  Vec3 axis, across, other;  // orthonormal
  double height;
};

Frame frameOf(const CylinderRegion& cylinder) {
  Frame f;
  const Vec3 along = cylinder.top - cylinder.base;
  f.height = along.norm();
  f.axis = f.height > 0 ? Vec3(along / f.height) : Vec3(Vec3::UnitZ());
  int smallest = 0;
  f.axis.cwiseAbs().minCoeff(&smallest);
  f.across = f.axis.cross(Vec3::Unit(smallest)).normalized();
  f.other = f.axis.cross(f.across);
  return f;
}

bool holds(const BoxRegion& box, const Vec3& centre, double radius) {
  return ((centre - box.min).array() >= radius).all() && ((box.max - centre).array() >= radius).all();
}

bool holds(const CylinderRegion& cylinder, const Vec3& centre, double radius) {
  const Vec3 along = cylinder.top - cylinder.base;
  const double height = along.norm();
  const Vec3 from = centre - cylinder.base;
  const double h = from.dot(along) / height;
  if (!(h >= radius && h <= height - radius)) return false;
  const double room = cylinder.radius - radius;
  return room >= 0 && (from - along * (h / height)).squaredNorm() <= room * room;
}

Vec3 place(const BoxRegion& box, double radius, Random& random) {
  Vec3 p;
  for (int k = 0; k < 3; ++k) p[k] = random.uniform(box.min[k] + radius, box.max[k] - radius);
  return p;
}

Vec3 place(const CylinderRegion& cylinder, double radius, Random& random) {
  const Frame f = frameOf(cylinder);
  double x, y;
  do {  // a disc by rejection: no trigonometry, the same bits everywhere
    x = random.uniform(-1, 1);
    y = random.uniform(-1, 1);
  } while (x * x + y * y > 1);
  const double room = cylinder.radius - radius, h = random.uniform(radius, f.height - radius);
  return cylinder.base + h * f.axis + (room * x) * f.across + (room * y) * f.other;
}

}  // namespace

bool Region::containsSphere(const Vec3& centre, double radius) const {
  return std::visit([&](const auto& s) { return holds(s, centre, radius); }, shape);
}

double Region::volume() const {
  if (const auto* box = std::get_if<BoxRegion>(&shape)) return (box->max - box->min).prod();
  const auto& cylinder = std::get<CylinderRegion>(shape);
  return std::numbers::pi * cylinder.radius * cylinder.radius * (cylinder.top - cylinder.base).norm();
}

Box Region::bounds() const {
  if (const auto* box = std::get_if<BoxRegion>(&shape)) return Box(box->min, box->max);
  const auto& cylinder = std::get<CylinderRegion>(shape);
  const Vec3 axis = frameOf(cylinder).axis;
  const Vec3 reach = cylinder.radius * (1 - axis.array().square()).max(0).sqrt().matrix();
  return Box(cylinder.base.cwiseMin(cylinder.top) - reach, cylinder.base.cwiseMax(cylinder.top) + reach);
}

double Region::inradius() const {
  if (const auto* box = std::get_if<BoxRegion>(&shape)) return (box->max - box->min).minCoeff() / 2;
  const auto& cylinder = std::get<CylinderRegion>(shape);
  return std::min(cylinder.radius, (cylinder.top - cylinder.base).norm() / 2);
}

Vec3 Region::randomPlace(double radius, Random& random) const {
  return std::visit([&](const auto& s) { return place(s, radius, random); }, shape);
}

}  // namespace tsubu::sim
