#pragma once
// Bonds of a scene as the simulation wants them.

#include <vector>

#include "scene/description.h"
#include "sim/bonds/bonding.h"

namespace tsubu::scene {

/// `firstOfSource`: index of the first grain of each source of the scene, and the number of grains at the end.
std::vector<sim::Bonding> buildBonds(const Scene& scene, const std::vector<std::size_t>& firstOfSource);

}  // namespace tsubu::scene
