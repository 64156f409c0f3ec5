#pragma once
// Speed against accuracy, measured: a scene is run over a plan of settings with several seeds, and the error of its observables is put
// against the cost.

#include <algorithm>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "study/pictures.h"
#include "study/setting.h"
#include "study/trial.h"

namespace tsubu::study {

struct Request {
  std::string scene;              ///< path
  scene::Overrides overrides;     ///< of the user: the scene as it is
  std::vector<std::string> axes;  ///< empty: all of them but "picture", which is of frames and not of the simulation
  bool features = false;          ///< switch features off instead of turning knobs
  double budget = 600;            ///< s of this machine: CPU time of all trials over the number of threads
  int seeds = 3;
  int threads = 1;      ///< trials at a time
  std::string version;  ///< of tsubu
  std::filesystem::path folder;
};

/// Of one observable at one setting, against the reference. All as shares of `Study::Scale`.
struct Deviation {
  double mean = 0;   ///< of the observable itself, in its unit
  double error = 0;  ///< |mean difference|; infinite where a run did not come to it and the reference did
  double noise = 0;  ///< 95 %: what the difference of two equal settings may be by the seeds alone
  /// What the last digits of a sum do: two loops that compute the same differ by so much.
  static constexpr double rounding = 1e-12;

  double floor = 0;  ///< noise, the reference's own error, or rounding, the largest of them: a smaller difference is none

  bool none() const { return error <= floor; }
  /// What the error is not above, for all that is known: what a promise can be made of.
  double bound() const { return std::max(error + noise, floor); }
};

/// A setting with its trials.
struct Point {
  std::string axis;  ///< "scene", "reference", "refinement", the name of an axis, "features", or "together"
  double at = 0;     ///< along the axis
  Setting setting;
  std::string label;
  scene::Overrides overrides;       ///< beside the user's, seed apart
  std::map<int, Outcome> outcomes;  ///< by seed, from 1
  std::string refused;              ///< why it was not run
  // Found by analyse():
  double cost = std::numeric_limits<double>::quiet_NaN();  ///< CPU seconds, mean over the seeds
  std::vector<Deviation> deviations;                       ///< by observable; empty when nothing could be compared
  bool pareto = false;

  bool ran() const { return !outcomes.empty(); }
  /// Why a trial failed; empty when none did.
  std::string failure() const;
  /// The largest bound of any observable.
  double bound() const;
  bool none() const;
};

struct ObservableInfo {
  std::string name, unit;
  double reference = 0;  ///< mean of the reference
  double spread = 0;     ///< standard deviation from seed to seed
  double bar = 0;        ///< the reference's error bar, as a share of the scale: from its refinement and its seeds
  double scale = 0;
  bool known = true;  ///< did the reference come to it?
};

struct Study {
  Request request;
  std::string key;            ///< of the scene as it is, seed apart
  double end = 0;             ///< s: of each trial
  int seeds = 1;              ///< of each setting
  bool random = true;         ///< do seeds make a difference?
  double safety = 0;          ///< of the scene as it is: Δt over the limit
  std::vector<Point> points;  ///< the scene first, then reference and refinement
  std::vector<ObservableInfo> observables;
  std::vector<PictureQuality> pictures;  ///< from the finest; empty unless the axis "picture" is named
  std::vector<std::string> leftOut;      ///< by the budget
  std::vector<std::string> notes;
  double used = 0;                 ///< s of the budget
  std::size_t ran = 0, known = 0;  ///< trials: run now, taken from the folder
  bool complete = true;            ///< false when interrupted

  const Point& scene() const { return points[0]; }
  /// A feature is switched off against the scene as it is, at its own step: what a finer one would say is not asked.
  const Point& reference() const { return points[request.features ? 0 : 1]; }
  const Point* refinement() const { return request.features || points.size() < 3 ? nullptr : &points[2]; }
};

/// Told after every trial: what it was, and how far the plan has come.
struct Progress {
  std::string label;
  std::size_t done, planned;
  double used, budget;
};

/// s: from some moment on, never back.
double steadySeconds();

/// What runs trials, and the clock that the budget goes by: this machine, unless a test has one on which everything takes the same time.
struct Machine {
  std::function<std::optional<Outcome>(const Trial&, const Stop&, const Watch&)> run = study::run;
  std::function<double()> seconds = steadySeconds;
};

/// \brief Runs what the budget allows, in the order of importance. Trials lie in `folder`/trials: what is there is not run again.
/// Throws Error(scene) when the scene or the request is wrong, or the budget too small for a reference.
Study tradeoff(const Request& request, const Stop& stop, const std::function<void(const Progress&)>& tell, const Machine& machine = {});

/// Costs, errors, noise, the front: from the trials that there are.
void analyse(Study& study);

}  // namespace tsubu::study
