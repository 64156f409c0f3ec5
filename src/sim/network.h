#pragma once
// The contacts of an instant as a network of springs and dashpots, and how long a step it bears (docs/physics.md, S2, S6–S8).

#include <cstdint>
#include <vector>

#include "core/snapshot.h"
#include "sim/diagnostics/instant.h"
#include "sim/model.h"

namespace tsubu::sim {

/// A contact, linearised: it sticks, and its stiffness is that of its present overlap.
struct Link {
  std::int32_t first, second;      ///< grains by their place; second is −1 for a wall
  Vec3 normal;                     ///< from the second to the first
  double firstLever, secondLever;  ///< m: from the centres to the contact point
  double inverseMass;              ///< 1/m*, 1/kg
  /// N/m and kg/s along and across the normal; N m/rad and N m s of rolling and twisting.
  struct Spring {
    double stiffness = 0, damping = 0;
  };
  Spring along, across, rolling, twisting;
};

struct ContactNetwork {
  std::vector<double> inverseMass;     ///< 1/kg, by grain
  std::vector<double> inverseInertia;  ///< 1/(kg m²); 0 where grains do not turn
  std::vector<Link> links;
};

/// `model`: as it was before the simulation; grains and contacts of the same instant, both in the order of ids.
ContactNetwork networkOf(const Model& model, const Snapshot& snapshot, const Instant& instant);

/// s, each infinite where it says nothing.
struct StabilityLimits {
  double note;        ///< Note 2.31: min(2√(m/k), 2m/η), each contact alone, m the lighter grain
  double duration;    ///< Article: π√(m/k)
  double undamped;    ///< Article: 2√(m/k)
  double single;      ///< S2: each contact alone, with m*, spring and dashpot together
  double gershgorin;  ///< S6: ω² ≤ max_i (2/m_i) Σ k_c, translation alone
  double sum;         ///< S7: ω² ≤ max_i Σ ω_c², rigorous with rotation
  double spectral;    ///< S8: the stiffest mode of the network
  double rayleigh;    ///< the field's habit; needs moduli
};
StabilityLimits limitsOf(const ContactNetwork& network, const Model& model, const Snapshot& snapshot);

/// What rules for a single contact would allow for the stiffest pair of the smallest grains, before any contact is known; s.
struct SingleContactRules {
  double note, duration, undamped;
};
SingleContactRules singleContactRules(const Model& model);

}  // namespace tsubu::sim
