#pragma once
// How fast bonded grains can swing, for the time step.

#include <string>

#include "sim/model.h"

namespace tsubu::sim {

/// S5: no mode of the bonded grains has a larger ω², nor its damper a larger 2ζω.
struct BondSwing {
  double stiffness = 0;  ///< 1/s²
  double damping = 0;    ///< 1/s
  std::string of;        ///< the name of the kind of bond that says most
};

/// Bonds that are there from the start are looked for; for those that are made later, the smallest grains count with as many neighbours
/// as have room.
/// `laterOnly`: the latter alone.
BondSwing swingOfBonds(const Model& model, bool laterOnly = false);

}  // namespace tsubu::sim
