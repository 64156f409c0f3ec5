#pragma once
// The contacts and bonds of an instant as a network of springs and dashpots, and how long a step it bears (docs/physics.md, S2, S6–S9).

#include <cstdint>
#include <string>
#include <vector>

#include "core/snapshot.h"
#include "sim/diagnostics/instant.h"
#include "sim/model.h"

namespace tsubu::sim {

/// A contact, linearised: it sticks, and its stiffness is that of its present overlap. Or a bond.
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
  bool bond = false;  ///< its springs go by the way of the grains, and are not carried on by half a step (B3)
};

struct ContactNetwork {
  std::vector<double> inverseMass;     ///< 1/kg, by grain
  std::vector<double> inverseInertia;  ///< 1/(kg m²); 0 where grains do not turn
  std::vector<Link> links;
  double slowing = 0;  ///< 1/s: what drag and damping add to 2ζω of any grain
};

struct PairConstants;
/// The contacts of an instant; `material` of its grains.
ContactNetwork networkOf(const Model& model, std::size_t law, const PairConstants& constants, bool turns, const Instant& instant,
                         const std::vector<std::uint16_t>& material);

/// Where the search for the stiffest mode begins: at the last one found.
struct StiffestMode {
  std::vector<Eigen::Matrix<double, 6, 1>> shape;  ///< translation and rotation of each grain, scaled by the roots of mass and inertia
};

struct StepLimit {
  double step;  ///< s; infinite where nothing swings
  std::string by;
};

/// \brief S9: the longest step of the network by power iteration, for use while it runs: springs across are counted twice in velocity
/// Verlet (their limit is √2/ω and not 2/ω), which is safe where S8 is exact, and cheap.
StepLimit longestStep(const ContactNetwork& network, Integrator integrator, StiffestMode& mode);

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
