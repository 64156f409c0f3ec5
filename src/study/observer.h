#pragma once
// The numbers that a scene names in [observe], measured while it runs.

#include <memory>
#include <string>
#include <vector>

#include "scene/description.h"
#include "sim/simulation.h"

namespace tsubu::study {

/// One observable of one run.
struct Measured {
  std::string name;
  std::string unit;  ///< SI; empty for a number
  double value = 0;  ///< NaN when the run did not come to it
  double scale = 0;  ///< what a difference of two values is to be compared with; same unit
};

/// What a scene is measured by that names nothing: energy residual, largest overlap, height of the centre of mass, kinetic energy.
std::vector<scene::Observable> observablesOf(const scene::Scene& scene);

/// Measures `wanted` of a run. Costs what the observables need and no more; without any, nothing.
class Observer {
 public:
  Observer(const scene::Scene& scene, const std::vector<scene::Observable>& wanted);
  ~Observer();
  Observer(Observer&&) noexcept;

  /// Looks at the present instant: at the start, at every row of the ledger, at the end. Looking changes nothing.
  void add(sim::Simulation& simulation);
  /// In the order of the scene.
  std::vector<Measured> results() const;

  struct Gauge;

 private:
  std::vector<std::unique_ptr<Gauge>> gauges_;
};

}  // namespace tsubu::study
