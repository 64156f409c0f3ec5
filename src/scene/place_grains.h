#pragma once
// Sources of grains that are there from the beginning.

#include <vector>

#include "scene/description.h"
#include "sim/insertion/grain.h"

namespace tsubu::scene {

/// Appends the grains of a source to `grains`; an inlet has none. Throws Error(scene) when they do not fit, or the file is wrong.
void placeGrains(const Scene& scene, const GrainSource& source, std::vector<sim::Grain>& grains);

/// Names two sources with grains that overlap deeper than the watch allows. Throws Error(scene).
void refuseOverlaps(const Scene& scene, const std::vector<sim::Grain>& grains, const std::vector<std::size_t>& firstOfSource);

}  // namespace tsubu::scene
