#pragma once
// Parts of space in which grains are placed, or from which they are taken.

#include <variant>

#include "core/random.h"
#include "core/vec.h"

namespace tsubu::sim {

/// An axis-aligned box; corners may be infinite where no grain is placed (a sink below everything, say).
struct BoxRegion {
  Vec3 min = Vec3::Zero();
  Vec3 max = Vec3::Zero();

  bool operator==(const BoxRegion& other) const { return min == other.min && max == other.max; }
};

/// A right circular cylinder with its axis from `base` to `top`, in any direction.
struct CylinderRegion {
  Vec3 base = Vec3::Zero();
  Vec3 top = Vec3::UnitZ();
  double radius = 0;

  bool operator==(const CylinderRegion& other) const { return base == other.base && top == other.top && radius == other.radius; }
};

/// A box or a cylinder, boundary included. All lengths in metres.
struct Region {
  std::variant<BoxRegion, CylinderRegion> shape;

  bool contains(const Vec3& point) const { return containsSphere(point, 0); }
  /// Is the whole sphere inside?
  bool containsSphere(const Vec3& centre, double radius) const;
  /// m³
  double volume() const;
  /// The smallest axis-aligned box around it.
  Box bounds() const;
  /// The radius of the largest sphere that fits, m.
  double inradius() const;
  /// \brief A point drawn uniformly from the places where a sphere of this radius fits entirely.
  /// The sphere must fit (radius ≤ inradius()) and the region be finite.
  Vec3 randomPlace(double radius, Random& random) const;

  bool operator==(const Region&) const = default;
};

}  // namespace tsubu::sim
