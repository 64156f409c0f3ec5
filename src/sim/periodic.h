#pragma once
// A domain that repeats itself (docs/physics.md, W5): what leaves through one face comes in through the opposite one.

#include <array>
#include <cmath>

#include "core/vec.h"

namespace tsubu::sim {

struct Model;

/// The directions in which space is periodic, and the lengths after which it repeats. Without any, every function does nothing.
class Periods {
 public:
  Periods() = default;
  /// `domain` must be finite along the axes named.
  Periods(const Box& domain, const std::array<bool, 3>& along) {
    for (int axis = 0; axis < 3; ++axis) {
      if (!along[static_cast<std::size_t>(axis)]) continue;
      any_ = true;
      low_[axis] = domain.min()[axis];
      length_[axis] = domain.sizes()[axis];
    }
  }

  bool any() const { return any_; }
  bool along(int axis) const { return length_[axis] > 0; }
  /// m; 0 where space does not repeat.
  double length(int axis) const { return length_[axis]; }
  /// m: where the domain begins along an axis that is periodic.
  double low(int axis) const { return low_[axis]; }

  /// What brings a place into the domain when it is added to it, m.
  Vec3 shiftInto(const Vec3& x) const { return whole((x - low_), 0); }
  /// The place within the domain that is the same as x.
  Vec3 wrapped(const Vec3& x) const { return any_ ? Vec3(x + shiftInto(x)) : x; }
  /// The shortest of all differences between the images of two places: x_i − x_j from i to the image of j that is nearest.
  Vec3 nearest(const Vec3& difference) const { return any_ ? Vec3(difference + whole(difference, 0.5)) : difference; }

  /// Numbers of shifts by whole periods: 0 is none, −n the opposite of n; |n| ≤ 13.
  Vec3 shift(int number) const {
    const int n = number + 13;
    return {(n / 9 - 1) * length_.x(), (n / 3 % 3 - 1) * length_.y(), (n % 3 - 1) * length_.z()};
  }
  /// Calls visit(number) for the shifts but 0 that take x, a place in the domain, to within `reach` of the domain: where others may
  /// meet its image.
  template <class Visit>
  void forImages(const Vec3& x, double reach, Visit&& visit) const {
    std::array<int, 3> lowest{}, highest{};
    for (int axis = 0; axis < 3; ++axis) {
      if (!along(axis)) continue;
      const auto k = static_cast<std::size_t>(axis);
      highest[k] = x[axis] - low_[axis] < reach ? 1 : 0;
      lowest[k] = low_[axis] + length_[axis] - x[axis] < reach ? -1 : 0;
    }
    for (int a = lowest[0]; a <= highest[0]; ++a)
      for (int b = lowest[1]; b <= highest[1]; ++b)
        for (int c = lowest[2]; c <= highest[2]; ++c)
          if (a != 0 || b != 0 || c != 0) visit(9 * a + 3 * b + c);
  }

 private:
  /// −L times how many whole periods there are in x, counted from `rounding` of a period.
  Vec3 whole(const Vec3& x, double rounding) const {
    Vec3 shift = Vec3::Zero();
    for (int axis = 0; axis < 3; ++axis)
      if (along(axis)) shift[axis] = -length_[axis] * std::floor(x[axis] / length_[axis] + rounding);
    return shift;
  }

  Vec3 low_ = Vec3::Zero(), length_ = Vec3::Zero();
  bool any_ = false;
};

/// A periodic domain is at least this many times as long as the radius of the largest grain, so that a grain meets no other twice and
/// neighbour lists have room for their skin.
inline constexpr double leastPeriod = 4.4;

/// Throws Error(scene) when the domain has no end, or is too short for the grains, where it is periodic.
void checkPeriods(const Model& model);

}  // namespace tsubu::sim
