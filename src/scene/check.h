#pragma once
// What one value of a scene says about another.

#include <functional>
#include <string>
#include <vector>

#include "core/error.h"
#include "scene/description.h"

namespace tsubu::scene {

/// Path of a value: {"walls", "hopper", "material"}.
using Path = std::vector<std::string>;

/// Where a complaint about the value at this path points to: the nearest part of the path that is written.
using PositionOf = std::function<SourcePosition(const Path& path)>;

struct Findings {
  std::vector<Diagnostic> errors;
  std::vector<Diagnostic> missingFiles;  ///< errors as well, but about files
  std::vector<Diagnostic> warnings;
};

/// Names that nothing bears and files that do not exist: can be told even of a scene that lacks values.
void checkNames(const Scene& scene, const PositionOf& positionOf, Findings& findings);
/// Properties that laws need or nobody reads; laws that do not go together.
void checkContact(const Scene& scene, const PositionOf& positionOf, Findings& findings);
/// Intervals that do not fit, regions too small for their grains, and the like.
void checkValues(const Scene& scene, const PositionOf& positionOf, Findings& findings);
/// The same for what is measured.
void checkDiagnostics(const Scene& scene, const PositionOf& positionOf, Findings& findings);
/// The same for what acts from afar.
void checkFields(const Scene& scene, const PositionOf& positionOf, Findings& findings);
/// Observables of things that are not there.
void checkObserve(const Scene& scene, const PositionOf& positionOf, Findings& findings);
/// Bonds of grains, materials and walls that are not there or cannot have them.
void checkBonds(const Scene& scene, const PositionOf& positionOf, Findings& findings);

}  // namespace tsubu::scene
