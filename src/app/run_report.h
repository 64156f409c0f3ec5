#pragma once
// run.json: what was run, with what, and how it went.

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scene/pace.h"
#include "sim/network.h"
#include "sim/simulation.h"
#include "study/observer.h"

namespace tsubu::app {

struct RunReport {
  std::string scene;  ///< path as given
  std::string title;
  int threads = 1;         ///< that there were
  double threadsUsed = 1;  ///< mean over the steps
  std::string isa;
  std::string setting;  ///< of a study that was asked for; empty: the scene's own
  std::vector<std::string> settingOverrides;
  std::string ended;    ///< "complete", "interrupted" or "failed"
  std::string failure;  ///< why, when it failed
  scene::FramePlan plan;
  sim::SingleContactRules singleContact{};  ///< what they would have allowed
  std::optional<scene::Pace> pace;          ///< how steps have followed the network, if they did
  double slowMotion = 1;
  double frameRate = 30;  ///< of the film, 1/s
  std::uint64_t steps = 0;
  double simulatedTime = 0, wallTime = 0, simulationTime = 0;  ///< s
  std::uint64_t grainSteps = 0;
  std::size_t grains = 0;
  sim::Counts counts;
  std::vector<std::string> counters;
  bool bonds = false;  ///< are there any in the scene?
  std::vector<sim::LostGrain> lostGrains;
  bool ledger = true;
  double energyResidual = 0;                 ///< at the end, as a fraction of the energy turned over
  double worstEnergyResidual = 0;            ///< the largest of any row of the ledger, over the turnover in the end
  std::vector<study::Measured> observables;  ///< what the scene names
  std::string stateHash;
  std::vector<std::pair<std::string, double>> profile;  ///< s of all threads together, by part; empty unless asked for
  std::size_t frames = 0;
  std::string renderer;
  std::vector<std::string> warnings;
};

/// Writes the report, complete or not at all. Throws Error(files).
void writeReport(const std::filesystem::path& path, const RunReport& report);

}  // namespace tsubu::app
