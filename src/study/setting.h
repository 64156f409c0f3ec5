#pragma once
// What a study turns: one knob at a time from what the scene says, told as overrides that a user can give by hand.

#include <optional>
#include <string>
#include <vector>

#include "scene/reader.h"

namespace tsubu::study {

/// Differences from the scene. Every member leaves things as they are by default.
struct Setting {
  std::optional<double> safety;    ///< the time step as a share of the stability limit
  std::optional<double> timeStep;  ///< s: instead
  std::optional<std::string> integrator;
  std::optional<std::string> normal, tangential, rolling, twisting;  ///< laws
  std::optional<bool> tension, rotation;
  std::optional<sim::Precision> precision;
  double softening = 1;        ///< factor on the stiffness of all contacts
  double coarsening = 1;       ///< factor on the radii, with f⁻³ times as many grains
  std::optional<double> skin;  ///< in smallest radii
  bool equalGrains = false;    ///< every source gets the radius that keeps its mass and number

  bool operator==(const Setting&) const = default;
};

/// \brief As overrides of the scene, in the words of its keys.
/// Throws Error(scene) when the scene has nothing that could be changed so, with the reason.
scene::Overrides overridesOf(const Setting& setting, const scene::Scene& scene);

/// "safety 0.3, normal_stiffness / 10": what it is in a table; empty for the scene as it is.
std::string labelOf(const Setting& setting);

/// What a turned knob does to the cost of a trial, roughly, for planning. `base`: the safety that the scene has.
double costFactor(const Setting& setting, const scene::Scene& scene, double base);

/// One knob.
struct Axis {
  std::string name;
  std::string unit;  ///< what `at` counts; empty where settings are words
  struct Place {
    double at;  ///< for plots: safety, factor, …, or the number of the word
    Setting setting;
  };
  std::vector<Place> places;  ///< from the finest to the coarsest
};

/// Axes that a study may name, in the order of their importance.
const std::vector<std::string>& axisNames();

/// The places of an axis in this scene that differ from the scene as it is, which are those worth trying. Throws Error(scene) for an
/// unknown name.
Axis axisOf(const std::string& name, const scene::Scene& scene);

/// What can be switched off, with the name of the feature; `--features`.
struct Feature {
  std::string name;
  Setting without;
  std::string impossible;  ///< why it cannot be switched off; empty when it can
};
std::vector<Feature> featuresOf(const scene::Scene& scene);

/// Both: what the second says on top of the first.
Setting combined(const Setting& first, const Setting& second);

}  // namespace tsubu::study
