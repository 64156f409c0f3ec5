#pragma once
// A simulation at one instant, complete enough for every diagnostic: grains with mass and velocity, contacts with their forces.

#include <vector>

#include "sim/diagnostics/acting_contact.h"
#include "sim/periodic.h"

namespace tsubu::sim {

struct SeenGrain {
  Vec3 position, velocity;  ///< m, m/s: both of the instant
  Vec3 angularVelocity;     ///< rad/s
  double radius, mass;      ///< m, kg

  double inertia() const { return 0.4 * mass * radius * radius; }
};

struct Instant {
  double time = 0;  ///< s
  Periods periods;
  std::vector<SeenGrain> grains;        ///< in the order of their ids; within the domain where it is periodic
  std::vector<ActingContact> contacts;  ///< places are those in `grains`

  /// Where two grains (or grain and wall) touch: the branch is divided as the radii. Beside the first grain, if the domain is periodic.
  Vec3 contactPoint(const ActingContact& contact) const {
    const SeenGrain& a = grains[static_cast<std::size_t>(contact.first)];
    if (contact.withWall()) return a.position - contact.branch;
    return a.position - a.radius / (a.radius + grains[static_cast<std::size_t>(contact.second)].radius) * contact.branch;
  }
};

}  // namespace tsubu::sim
