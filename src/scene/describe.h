#pragma once
// The format of a scene file: every key with its kind, bounds and sentence, in the order in which the reference explains them.

#include "scene/description.h"
#include "scene/form.h"

namespace tsubu::scene {

/// Walks the whole format, filling or showing `scene`.
void describe(Form& form, Scene& scene);

// Its parts, one file each.
void describeGrains(Form& form, Scene& scene);
void describeWalls(Form& form, Scene& scene);
void describeBonds(Form& form, Scene& scene);
void describeFields(Form& form, Scene& scene);
void describeDiagnostics(Form& form, Scene& scene);
void describeObserve(Form& form, Scene& scene);
void describePicture(Form& form, Scene& scene);

/// A box or a cylinder, in the keys `box` and `cylinder`.
void describeRegion(Form& form, sim::Region& region);
void describeBox(Form& form, sim::BoxRegion& box);

}  // namespace tsubu::scene
