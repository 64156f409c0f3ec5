#pragma once
// What a sphere feels of a wall: the places where the distance from its centre to the wall is locally least, and how they share
// the load. The reasons are in docs/decisions/0004-walls.md.

#include <algorithm>
#include <array>
#include <cstdint>

#include "core/vec.h"

namespace tsubu::sim {

/// One contact of a sphere with one feature of a wall, in the frame of the wall.
struct WallContact {
  Vec3 point;           ///< m: the nearest point of the feature
  Vec3 normal;          ///< unit, from the wall to the centre of the sphere; defined also when the centre lies on the wall
  double distance = 0;  ///< m: from the centre to `point`; the overlap is radius − distance. Negative only behind an unbounded plane
  double weight = 1;    ///< in (0, 1]: the share of the contact law's whole force (spring, dashpot, friction) that acts
  std::uint32_t feature = 0;
};

/// The contacts of one sphere, in ascending order of feature. A plain buffer of fixed size: filling it allocates nothing.
class WallContacts {
 public:
  static constexpr int capacity = 24;

  int size() const { return size_; }
  bool empty() const { return size_ == 0; }
  void clear() { size_ = 0; }
  void push(const WallContact& contact) { items_[static_cast<std::size_t>(size_++)] = contact; }
  void erase(int index) {
    std::copy(begin() + index + 1, end(), begin() + index);
    --size_;
  }
  WallContact& operator[](int index) { return items_[static_cast<std::size_t>(index)]; }
  const WallContact& operator[](int index) const { return items_[static_cast<std::size_t>(index)]; }
  WallContact* begin() { return items_.data(); }
  WallContact* end() { return items_.data() + size_; }
  const WallContact* begin() const { return items_.data(); }
  const WallContact* end() const { return items_.data() + size_; }

 private:
  std::array<WallContact, capacity> items_;
  int size_ = 0;
};

/// How much of one contact another with normal at the chord |n_i − n_j| = √2·x replaces: Wendland's (1 − x)⁴(4x + 1), which is 1
/// for equal normals and 0 from a right angle on. It is positive definite on the sphere of directions.
double contactKinship(const Vec3& normalA, const Vec3& normalB);

/// Sets the weights so that nearly parallel contacts count as one and contacts at right angles (or more) as separate ones, and
/// drops contacts that carry nothing. With overlaps δ and the kinship matrix G, the loads λ ≥ 0 maximise λ·δ − ½ λ·Gλ, and
/// weight = λ/δ. For linear springs Σ ½ k weight δ² is then the elastic energy whose gradient the force is.
/// `radius`: of the sphere; every contact must have distance < radius.
void shareLoad(WallContacts& contacts, double radius);

}  // namespace tsubu::sim
