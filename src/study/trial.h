#pragma once
// A trial: a scene file with overrides, run once without pictures on one thread, and what came of it. Trials are kept by what they are
// made of, so that none is run twice.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "scene/reader.h"
#include "study/observer.h"

namespace tsubu::study {

/// What to run. The seed is an override like any other: `simulation.seed=2`.
struct Trial {
  std::string scene;  ///< path
  scene::Overrides overrides;

  bool operator==(const Trial&) const = default;
};

/// "tsubu run scene.toml --no-frames --set simulation.safety=0.5": how to repeat it by hand.
std::string commandOf(const Trial& trial);

/// What came of a trial.
struct Outcome {
  std::vector<Measured> values;    ///< in the order of the scene; empty when it failed
  double cost = 0;                 ///< CPU seconds of the simulation
  double wall = 0;                 ///< s: how long it took, whoever else used the machine
  double timeStep = 0, limit = 0;  ///< s: taken, and where the scene would be unstable
  std::uint64_t steps = 0, grainSteps = 0;
  std::uint64_t grains = 0;  ///< in the end
  std::string failure;       ///< why the run broke off; empty when it did not
  std::string stateHash;     ///< in the end

  bool complete() const { return failure.empty(); }
};

/// Asked from time to time: true means to break off.
using Stop = std::function<bool()>;

/// Told from time to time: the share of the steps that are done, and the CPU seconds so far. True means to break off.
using Watch = std::function<bool(double done, double cost)>;

/// \brief Runs it. Nothing when `stop` or `watch` said so.
/// A simulation that fails gives an outcome with a failure. Throws Error(scene) or Error(files) when the scene is wrong.
std::optional<Outcome> run(const Trial& trial, const Stop& stop = {}, const Watch& watch = {});

/// Fingerprint of everything that the outcome depends on: the effective scene but for its pictures, the bytes of the files that it reads,
/// the version of tsubu. Throws as scene::read.
std::string keyOf(const Trial& trial, const std::string& version);
/// The same of a scene of which no seed is meant: what a study is of.
std::string keyOfStudy(Trial trial, double end, const std::string& version);

/// A folder of outcomes.
class TrialStore {
 public:
  /// Makes the folder. Throws Error(files).
  TrialStore(std::filesystem::path folder, std::string version);

  /// Nothing when there is no such file, or one that cannot be read: then the trial is run again.
  std::optional<Outcome> find(const Trial& trial) const;
  /// Writes the file, complete or not at all. Throws Error(files).
  void keep(const Trial& trial, const Outcome& outcome) const;

 private:
  std::filesystem::path folder_;
  std::string version_;
};

}  // namespace tsubu::study
