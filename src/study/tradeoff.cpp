#include "study/tradeoff.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <mutex>
#include <set>
#include <thread>

#include <fmt/format.h>

#include "core/error.h"

namespace tsubu::study {

namespace {

// Of the budget, what goes into the reference and its refinement; steps that it may have, as shares of the limit.
constexpr double shareOfReference = 0.4;
constexpr double referenceSteps[] = {0.01, 0.02, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4, 0.45};
// A trial that takes longer than it should may overrun the budget by so much before it is broken off.
constexpr double grace = 1.1;
// The scene as it is, a reference of half its step, and its refinement.
constexpr double leastTrials = 4;

// Not the state: grains may be painted differently where they move alike.
bool sameValues(const Outcome& a, const Outcome& b) {
  const auto same = [](const Measured& x, const Measured& y) { return x.value == y.value || (std::isnan(x.value) && std::isnan(y.value)); };
  return a.grainSteps == b.grainSteps && std::equal(a.values.begin(), a.values.end(), b.values.begin(), b.values.end(), same);
}

struct Job {
  std::size_t point;
  int seed;
};

/// Runs jobs, several at a time, as long as the budget lasts.
class Runner {
 public:
  Runner(Study& study, const scene::Scene& scene, const Stop& stop, const std::function<void(const Progress&)>& tell,
         const Machine& machine)
      : study_(study),
        scene_(scene),
        request_(study.request),
        stop_(stop),
        tell_(tell),
        machine_(machine),
        store_(request_.folder / "trials", request_.version) {}

  Trial trialOf(const Point& point, int seed) const {
    Trial trial{request_.scene, request_.overrides};
    trial.overrides.insert(trial.overrides.end(), point.overrides.begin(), point.overrides.end());
    trial.overrides.push_back(fmt::format("simulation.seed={}", seed));
    return trial;
  }

  /// Runs the jobs in their order; those that the budget does not allow are left out. `must`: whatever it takes, but for an interruption.
  void run(const std::vector<Job>& jobs, bool must = false) {
    planned_ += jobs.size();
    std::atomic<std::size_t> next{0};
    const auto work = [&] {
      for (std::size_t k = next.fetch_add(1); k < jobs.size() && !broken() && !failed_; k = next.fetch_add(1)) {
        try {
          take(jobs[k], must);
        } catch (...) {
          const std::lock_guard lock(mutex_);
          if (!failure_) failure_ = std::current_exception();
          failed_ = true;
        }
      }
    };
    std::vector<std::thread> others;
    for (int t = 1; t < request_.threads; ++t) others.emplace_back(work);
    work();
    for (std::thread& other : others) other.join();
    if (failure_) std::rethrow_exception(failure_);
    if (broken()) study_.complete = false;
  }

  double used() const { return std::max(cost_ / request_.threads, machine_.seconds() - start_); }

 private:
  bool broken() const { return stop_ && stop_(); }

  // CPU seconds: from the other seeds of the setting, or from the scene as it is.
  double expected(const Point& point) const {
    for (const auto& [seed, outcome] : point.outcomes) return outcome.cost;
    if (study_.scene().outcomes.empty()) return 0;
    return study_.scene().outcomes.begin()->second.cost * costFactor(point.setting, scene_, study_.safety);
  }

  void take(const Job& job, bool must) {
    std::unique_lock lock(mutex_);
    Point& point = study_.points[job.point];
    if (!point.refused.empty() || point.outcomes.count(job.seed)) return;
    const Trial trial = trialOf(point, job.seed);
    const double cost = expected(point);
    const bool pilot = study_.scene().outcomes.empty();
    lock.unlock();
    try {
      std::optional<Outcome> outcome = store_.find(trial);
      const bool known = outcome.has_value();
      if (!known) {
        lock.lock();
        const double now = used() + underway_ / request_.threads;
        const bool allowed = must || now + cost / request_.threads <= request_.budget;
        if (allowed)
          underway_ += cost;
        else
          leaveOut(point);
        lock.unlock();
        if (!allowed) return;
        const Stop stop = [&] { return broken() || (!must && used() > grace * request_.budget); };
        outcome = machine_.run(trial, stop, pilot ? Watch([this](double done, double spent) { return tooLong(done, spent); }) : Watch());
        if (outcome) store_.keep(trial, *outcome);
        lock.lock();
        underway_ -= cost;
        if (!outcome && !broken()) leaveOut(point);
        lock.unlock();
        if (!outcome) return;
      }
      lock.lock();
      cost_ += outcome->cost;
      ++(known ? study_.known : study_.ran);
      point.outcomes.emplace(job.seed, std::move(*outcome));
      if (tell_) tell_({point.label, study_.known + study_.ran, planned_, used(), request_.budget});
    } catch (const Error& error) {
      // A setting that the scene cannot have is told, with the reason; one that the scene has as it is, is the user's mistake.
      if (error.kind() != ErrorKind::scene || job.point == 0) throw;
      if (!lock.owns_lock()) lock.lock();
      point.refused = error.diagnostics().front().message;
    }
  }

  // The first trial of all: when it has run for a while it is known what it will take, and a study is four of them at least.
  bool tooLong(double done, double cost) const {
    const double whole = cost / std::max(done, 1e-9);
    if (cost < 3 || leastTrials * whole / request_.threads <= request_.budget) return false;
    throw Error(ErrorKind::scene,
                fmt::format("One trial takes about {:.3g} s of CPU, and a study {:.0f} of them at least: more than the budget of {:.3g} s.",
                            whole, leastTrials, request_.budget),
                "give more --budget, a shorter --until, or fewer grains");
  }

  void leaveOut(const Point& point) {
    if (std::find(study_.leftOut.begin(), study_.leftOut.end(), point.label) == study_.leftOut.end()) study_.leftOut.push_back(point.label);
  }

  Study& study_;
  const scene::Scene& scene_;
  const Request& request_;
  const Stop& stop_;
  const std::function<void(const Progress&)>& tell_;
  const Machine& machine_;
  TrialStore store_;
  double start_ = machine_.seconds();
  std::mutex mutex_;
  double cost_ = 0, underway_ = 0;  // CPU seconds
  std::size_t planned_ = 0;
  std::exception_ptr failure_;
  std::atomic<bool> failed_{false};
};

/// The plan of a study, made while it is carried out: what is worth running depends on what has been seen.
class Planner {
 public:
  Planner(const Request& request, const Stop& stop, const std::function<void(const Progress&)>& tell, const Machine& machine)
      : stop_(stop), tell_(tell), machine_(machine), scene_(scene::read(request.scene, request.overrides)) {
    study_.request = request;
    study_.end = scene_.simulation.end;
    study_.key = keyOfStudy({request.scene, request.overrides}, study_.end, request.version);
    study_.seeds = request.seeds;
  }

  Study go() {
    Runner runner(study_, scene_, stop_, tell_, machine_);
    add("scene", 0, {}, "as it is");
    runner.run({{0, 1}}, true);
    if (study_.complete) lookAtPilot();
    if (study_.complete) findRandomness(runner);
    if (request().features) {
      if (study_.complete) runFeatures(runner);
    } else {
      if (study_.complete) chooseReference();
      if (study_.complete) runReference(runner);
      if (study_.complete) runAxes(runner);
      analyse(study_);
      if (study_.complete) runTogether(runner);
    }
    if (study_.complete && std::find(request().axes.begin(), request().axes.end(), "picture") != request().axes.end()) {
      const auto pictures = comparePictures({request().scene, request().overrides}, stop_);
      study_.complete = pictures.has_value();
      if (pictures) study_.pictures = *pictures;
    }
    analyse(study_);
    study_.used = runner.used();
    return std::move(study_);
  }

 private:
  const Request& request() const { return study_.request; }

  std::size_t add(const std::string& axis, double at, const Setting& setting, const std::string& label) {
    Point point;
    point.axis = axis, point.at = at, point.setting = setting, point.label = label;
    try {
      point.overrides = overridesOf(setting, scene_);
      scene::Overrides all = request().overrides;
      all.insert(all.end(), point.overrides.begin(), point.overrides.end());
      scene::read(request().scene, all);
    } catch (const Error& error) {
      point.refused = error.diagnostics().front().message;
    }
    study_.points.push_back(std::move(point));
    return study_.points.size() - 1;
  }

  std::vector<Job> jobsOf(std::size_t point) const {
    std::vector<Job> jobs;
    for (int seed = 1; seed <= study_.seeds; ++seed) jobs.push_back({point, seed});
    return jobs;
  }

  void lookAtPilot() {
    const Outcome& pilot = study_.scene().outcomes.begin()->second;
    if (!pilot.complete()) throw Error(ErrorKind::simulation, "The scene as it is does not run to its end: " + pilot.failure);
    study_.points[0].at = study_.safety = pilot.timeStep / pilot.limit;
  }

  // As fine as a share of the budget allows, but at least half the scene's own step.
  void chooseReference() {
    const Outcome& pilot = study_.scene().outcomes.begin()->second;
    const double perShare = pilot.cost * study_.safety;  // CPU seconds of a trial, times the share of the limit
    // On a busy machine a second of CPU takes longer than a second.
    const double busy = std::clamp(pilot.wall / pilot.cost, 1.0, 4.0);
    const double budget = shareOfReference * request().budget * request().threads / busy;
    const auto costs = [&](double share, int seeds) { return 1.5 * seeds * perShare / share; };
    double share = 0;
    while (share == 0) {
      for (const double candidate : referenceSteps)
        if (share == 0 && candidate <= 0.5 * study_.safety * 1.0001 && costs(candidate, study_.seeds) <= budget) share = candidate;
      if (share > 0 || study_.seeds == 1) break;
      --study_.seeds;
    }
    if (share == 0)
      throw Error(ErrorKind::scene,
                  fmt::format("The budget of {:.3g} s is too small: one trial takes {:.3g} s of CPU, and a reference at half its step with "
                              "its refinement {:.3g} s.",
                              request().budget, pilot.cost, costs(0.5 * study_.safety, 1)),
                  "give more --budget, or a shorter --until");
    if (study_.seeds == 1 && study_.random) study_.notes.push_back("With one seed the noise is not known: a difference may be chance.");
    if (study_.random && study_.seeds < request().seeds)
      study_.notes.push_back(fmt::format("The budget allows {} of {} seeds.", study_.seeds, request().seeds));
    Setting finest, half;
    finest.safety = share;
    half.safety = 2 * share;
    add("reference", share, finest, fmt::format("reference: step {:.3g}", share));
    add("refinement", 2 * share, half, fmt::format("step {:.3g}", 2 * share));
  }

  // Does another seed make another run? If not, one is enough.
  void findRandomness(Runner& runner) {
    if (study_.seeds == 1) return;
    runner.run({{0, 2}}, true);
    if (!study_.complete) return;
    const auto& seen = study_.scene().outcomes;
    if (!sameValues(seen.at(1), seen.at(2))) return;
    study_.random = false;
    study_.seeds = 1;
    study_.points[0].outcomes.erase(2);
    study_.notes.clear();
    study_.notes.push_back("Nothing in this scene is random: all seeds give the same run, and one is enough.");
  }

  void runReference(Runner& runner) {
    std::vector<Job> jobs = jobsOf(1);
    for (const std::size_t point : {std::size_t{2}, std::size_t{0}})
      for (const Job& job : jobsOf(point)) jobs.push_back(job);
    runner.run(jobs, true);
    if (study_.complete && !study_.reference().failure().empty())
      throw Error(ErrorKind::simulation, "The reference does not run to its end: " + study_.reference().failure());
  }

  void runAxes(Runner& runner) {
    std::vector<Axis> axes;
    for (const std::string& name : request().axes.empty() ? axisNames() : request().axes)
      if (name != "picture") axes.push_back(axisOf(name, scene_));
    std::size_t longest = 0;
    for (const Axis& axis : axes) longest = std::max(longest, axis.places.size());
    // The n-th place of every axis before the next of any; coarse ones first, since they are cheap and what people do.
    for (std::size_t n = 0; n < longest; ++n) {
      std::vector<Job> jobs;
      for (const Axis& axis : axes) {
        if (n >= axis.places.size()) continue;
        const Axis::Place& place = axis.places[axis.name == "step" ? axis.places.size() - 1 - n : n];
        if (axis.name == "step" && !(place.at > 2.01 * study_.reference().at && std::abs(place.at / study_.safety - 1) > 0.01)) continue;
        const std::size_t point = add(axis.name, place.at, place.setting, labelOf(place.setting));
        for (const Job& job : jobsOf(point)) jobs.push_back(job);
      }
      runner.run(jobs);
      if (!study_.complete) return;
    }
    checkSkins();
  }

  // How far neighbours are listed must change nothing but the cost.
  void checkSkins() {
    bool any = false, same = true;
    for (const Point& point : study_.points)
      for (const auto& [seed, outcome] : point.outcomes)
        if (const auto base = study_.scene().outcomes.find(seed); point.axis == "skin" && base != study_.scene().outcomes.end()) {
          any = true;
          same = same && outcome.stateHash == base->second.stateHash;
        }
    if (any)
      study_.notes.push_back(same ? "Skins gave the same bits, as they must: they are a matter of cost alone."
                                  : "Skins did not give the same bits: this is a fault of tsubu.");
  }

  void runFeatures(Runner& runner) {
    std::vector<Job> jobs = jobsOf(0);
    for (Feature feature : featuresOf(scene_)) {
      const std::string label = "without " + feature.name;
      // With the step of the scene: what is left might bear a longer one, and its error would be taken for that of the feature.
      feature.without.timeStep = study_.scene().outcomes.begin()->second.timeStep;
      const std::size_t point = feature.impossible.empty() ? add("features", 0, feature.without, label) : study_.points.size();
      if (!feature.impossible.empty()) {
        Point refused;
        refused.axis = "features", refused.label = label, refused.refused = feature.impossible;
        study_.points.push_back(refused);
      }
      for (const Job& job : jobsOf(point)) jobs.push_back(job);
    }
    runner.run(jobs);
  }

  // The second round: of each axis the cheapest place that made no difference, all together, and all but one.
  void runTogether(Runner& runner) {
    std::vector<const Point*> cheapest;
    for (const std::string& name : axisNames()) {
      const Point* best = nullptr;
      for (const Point& point : study_.points)
        if (point.axis == name && point.none() && point.cost < 0.97 * study_.scene().cost && (!best || point.cost < best->cost))
          best = &point;
      if (best) cheapest.push_back(best);
    }
    if (cheapest.size() < 2) return;
    const auto allBut = [&](std::size_t without) {
      Setting all;
      for (std::size_t k = 0; k < cheapest.size(); ++k)
        if (k != without) all = combined(all, cheapest[k]->setting);
      return all;
    };
    std::vector<Setting> settings{allBut(cheapest.size())};
    for (std::size_t k = 0; k < cheapest.size() && cheapest.size() > 2; ++k) settings.push_back(allBut(k));
    std::vector<Job> jobs;
    for (const Setting& setting : settings)
      for (const Job& job : jobsOf(add("together", 0, setting, labelOf(setting)))) jobs.push_back(job);
    runner.run(jobs);
  }

  const Stop& stop_;
  const std::function<void(const Progress&)>& tell_;
  const Machine& machine_;
  scene::Scene scene_;
  Study study_;
};

}  // namespace

double steadySeconds() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

Study tradeoff(const Request& request, const Stop& stop, const std::function<void(const Progress&)>& tell, const Machine& machine) {
  return Planner(request, stop, tell, machine).go();
}

}  // namespace tsubu::study
