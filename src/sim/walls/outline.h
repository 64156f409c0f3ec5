#pragma once
// The region of a plane inside closed outlines: is a point in it, and how far is it from the outline?

#include <cstdint>
#include <vector>

#include "core/vec.h"

namespace tsubu::sim {

using Vec2 = Eigen::Vector2d;

/// The sum of the outlines of figures that all run the same way around, as a bag of directed segments: a point is inside when they
/// wind around it, so that figures may overlap. Segments are sorted into strips of equal height, and a point looks only at those at
/// its own height.
class Outline {
 public:
  struct Segment {
    Vec2 a, b;
    int count = 1;  ///< how often it is there; negative when it runs from b to a
  };

  Outline() = default;
  explicit Outline(const std::vector<Segment>& segments);

  bool contains(const Vec2& point) const;
  /// Squared distance to the nearest segment, or something larger than reach² when that is farther than `reach`.
  double squaredDistance(const Vec2& point, double reach) const;

 private:
  std::uint32_t strip(double y) const;

  double low_ = 0, high_ = -1, perHeight_ = 0;  ///< strips from low_ to high_, perHeight_ of them per metre
  std::vector<std::uint32_t> begin_;            ///< of each strip in segments_, and the end
  std::vector<Segment> segments_;               ///< repeated in every strip that they touch
};

}  // namespace tsubu::sim
