#pragma once
// Who touches whom, and with which properties.

#include <set>
#include <string>
#include <vector>

#include "scene/description.h"

namespace tsubu::scene {

/// Index of a material by name; of the empty name when there is only one. `noMaterial` when there is none.
inline constexpr std::size_t noMaterial = static_cast<std::size_t>(-1);
std::size_t materialIndex(const Scene& scene, const std::string& name);

/// Materials that grains can have, and those of walls.
std::set<std::size_t> grainMaterials(const Scene& scene);
std::set<std::size_t> wallMaterials(const Scene& scene);

/// Pairs (a ≤ b) that can touch: grains with grains and grains with walls.
std::vector<std::pair<std::size_t, std::size_t>> touchingPairs(const Scene& scene);

/// What the scene says about two materials that meet: the special values over those for all. A special value displaces its alternative
/// (restitution here, a damping rate for all) as well.
Properties pairProperties(const Scene& scene, std::size_t a, std::size_t b);

}  // namespace tsubu::scene
