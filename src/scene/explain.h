#pragma once
// The plan of a run in words, before it is run.

#include <string>

#include "scene/build.h"
#include "scene/description.h"

namespace tsubu::scene {

/// Some lines of text: what is modelled and what is not, with which laws; memory; time step and what sets it; frames; estimated cost.
std::string explain(const Scene& scene);
/// The same for a scene that has been built already.
std::string explain(const Scene& scene, const Built& built);

}  // namespace tsubu::scene
