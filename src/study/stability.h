#pragma once
// The step at which a scene blows up, found by trying, against every rule that predicts it (docs/physics.md, S).

#include <optional>
#include <string>
#include <vector>

#include "scene/reader.h"
#include "sim/network.h"
#include "study/trial.h"

namespace tsubu::study {

struct StabilityRequest {
  std::string scene;
  scene::Overrides overrides;
  std::optional<double> at;  ///< s: the state that is tried; absent: the end of the scene
  int steps = 1000;          ///< of each try
};

struct Stability {
  double time = 0;  ///< s: of the state
  std::size_t grains = 0, contacts = 0;
  double measured = 0;    ///< s: stable below, unstable above, to half a per cent
  bool restless = false;  ///< copies of the state part at any step: judged by the energy that the scheme makes
  bool found = true;      ///< false: stable, or unstable, at every step that was tried
  sim::StabilityLimits predicted{};
  double automatic = 0;  ///< s: what the automatic step takes for the limit, before any contact is known (S3–S5)
  double safety = 0;     ///< the scene's own step over the measured limit
  std::string limitedBy;
  std::vector<std::string> notes;
};

/// \brief Runs the scene to `at`, then tries steps from the state that it has there: contacts as they are, grains at rest, walls still.
///
/// Two copies that differ by velocities of a hair's breadth per step take the same steps: apart they grow at most in proportion to their
/// number where the step is stable, and by a factor in every step where it is not. Throws Error(scene) when there is no contact; nothing
/// when `stop` said so.
std::optional<Stability> findStability(const StabilityRequest& request, const Stop& stop);

std::string tableOf(const Stability& stability);

}  // namespace tsubu::study
