#pragma once
// The only place where the words of a scene become types: the model of the simulation, the style of the film, and when what is written.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "render/renderer.h"
#include "scene/description.h"
#include "sim/model.h"

namespace tsubu::scene {

/// Steps of the simulation and what is written after them. Frame k and row k show the state after k × stepsPer… steps, from k = 0 on.
struct FramePlan {
  double timeStep = 0;    ///< s: both intervals are whole numbers of it
  std::string limitedBy;  ///< what set it
  double limit = 0;       ///< s: the stability limit
  double interval = 0;    ///< s of simulated time from frame to frame
  double ledgerInterval = 0;
  std::uint64_t stepsPerFrame = 0;
  std::uint64_t stepsPerLedgerRow = 0;
  std::uint64_t steps = 0;   ///< of the whole run
  std::uint64_t frames = 0;  ///< of the whole run, the first and the last included
  /// Steps follow the live network (S9); then `timeStep` is the one to begin with, and `steps` what it would make of the run.
  struct Live {
    double safety;   ///< share of its limit that is taken
    double longest;  ///< s: what a step never exceeds, for contacts yet to come
    std::string longestBy;
  };
  std::optional<Live> live;
};

/// Everything a run needs. Walls in the order of the model, hidden ones included.
struct Built {
  sim::Model model;
  FramePlan plan;
  render::Style style;
  std::vector<render::VisibleWall> walls;
  Box bounds;  ///< the part of the world that matters, for the renderer
  std::vector<std::string> warnings;
  std::vector<std::string> notes;  ///< what is unusual but harmless: `tsubu check` says it
};

/// \brief Places the grains, loads the meshes, chooses the time step.
/// Throws Error(scene) when grains do not fit or a table of grains is wrong, Error(files) when a mesh cannot be used.
Built build(const Scene& scene);

/// The plan for a model, whose `timeStep` it does not read. `speed` (m/s) is the largest expected: no grain shall go farther in a
/// step than half of what the watch allows. Adds to `warnings` when a given step is above the stability limit.
FramePlan planFrames(const Scene& scene, const sim::Model& model, double speed, std::vector<std::string>& warnings);

}  // namespace tsubu::scene
