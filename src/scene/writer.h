#pragma once
// A Scene as a scene file again, with every default written out: what a run was made of.

#include <string>

#include "scene/description.h"

namespace tsubu::scene {

/// Reading the text under the name of a file in the same folder gives an equal scene.
std::string write(const Scene& scene);

}  // namespace tsubu::scene
