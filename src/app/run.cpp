#include "app/run.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <thread>

#include <fmt/format.h>

#include "app/chosen_setting.h"
#include "app/diagnostics_files.h"
#include "app/film.h"
#include "app/interrupt.h"
#include "app/ledger_file.h"
#include "app/messages.h"
#include "app/progress.h"
#include "app/run_report.h"
#include "app/version.h"
#include "core/error.h"
#include "core/hash.h"
#include "io/text_file.h"
#include "scene/pace.h"
#include "sim/kernel/kernels.h"
#include "study/observer.h"

namespace tsubu::app {

namespace {

namespace fs = std::filesystem;

/// A run under way: the simulation, and what it leaves behind.
class Run {
 public:
  explicit Run(const RunOptions& options);
  int go();

 private:
  void openFilm(scene::Built& built, const scene::Scene& scene);
  void loop();
  void show(bool last);
  void writeFrame();
  void report(const std::string& ended, const std::string& failure);
  void summarise() const;
  void noteProfile();

  const RunOptions& options_;
  ProgressLine progress_{stderr};
  fs::path folder_;
  RunReport report_;
  std::vector<std::string> sceneWarnings_;
  std::unique_ptr<sim::Simulation> simulation_;
  std::unique_ptr<scene::Pace> pace_;
  std::unique_ptr<LedgerFile> ledger_;
  std::unique_ptr<DiagnosticsFiles> diagnostics_;
  std::unique_ptr<study::Observer> observer_;
  std::unique_ptr<Film> film_;
};

Run::Run(const RunOptions& options) : options_(options) {
  std::vector<Diagnostic> odd;
  const std::optional<study::SavedPoint> chosen = chosenSetting(options);
  const scene::Scene scene = scene::read(options.scene, allOverrides(options, chosen), &odd);
  if (chosen) report_.setting = study::describe(*chosen), report_.settingOverrides = chosen->overrides;
  if (!options.isa.empty()) sim::useKernels(options.isa);
  for (const Diagnostic& warning : odd) warn(toString(warning));
  scene::Built built = scene::build(scene);
  for (const std::string& warning : built.warnings) warn(warning);

  folder_ = options.folder.empty() ? fs::path("out") / fs::path(options.scene).stem() : fs::path(options.folder);
  std::error_code failed;
  fs::create_directories(folder_, failed);
  if (failed) throw Error(ErrorKind::files, fmt::format("Cannot make the folder '{}': {}.", folder_.string(), failed.message()));

  // Of an earlier run: they would not belong to what is written now.
  fs::remove(folder_ / "run.json", failed);
  DiagnosticsFiles::remove(folder_);

  report_.scene = options.scene;
  report_.title = scene.title;
  report_.threads = options.threads > 0 ? options.threads : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  report_.isa = sim::kernels().isa;
  report_.plan = built.plan;
  report_.singleContact = sim::singleContactRules(built.model);
  report_.slowMotion = scene::slowMotion(scene.output);
  report_.frameRate = scene.output.fps;
  report_.ledger = scene.simulation.ledger;
  report_.warnings = built.warnings;
  for (const Diagnostic& warning : odd) report_.warnings.push_back(toString(warning));
  for (const sim::Counter& counter : built.model.counters) report_.counters.push_back(counter.name);
  if (options.frames) openFilm(built, scene);
  LedgerColumns columns{report_.counters, {}, built.model.heat};
  std::vector<std::string> walls;
  for (const sim::Wall& wall : built.model.walls) {
    walls.push_back(wall.name);
    if (wall.body) columns.movingWalls.push_back(wall.name);
  }
  columns.bonds = report_.bonds = !built.model.bonds.empty();
  ledger_ = std::make_unique<LedgerFile>(folder_ / "ledger.csv", columns);
  if (scene.diagnostics) diagnostics_ = std::make_unique<DiagnosticsFiles>(folder_, *scene.diagnostics, std::move(walls));
  if (!scene.observe.empty()) observer_ = std::make_unique<study::Observer>(scene, scene.observe);
  simulation_ = std::make_unique<sim::Simulation>(std::move(built.model), report_.threads);
  pace_ = std::make_unique<scene::Pace>(report_.plan);
  if (options.threads == 0) simulation_->chooseThreads();
  if (options.profile) simulation_->startProfile();
}

void Run::openFilm(scene::Built& built, const scene::Scene& scene) {
  Film::Parts parts{built.style, std::move(built.walls), built.bounds, folder_ / "frames", {}};
  parts.text["Software"] = fmt::format("tsubu {}", version);
  parts.text["Title"] = scene.title;
  parts.text["scene"] = options_.scene;
  parts.text["scene text"] = io::readTextFile(options_.scene, "scene file");
  // What the simulation leaves of the cores, less the thread that draws.
  render::setDrawingHelpers(std::max(0, static_cast<int>(std::thread::hardware_concurrency()) - report_.threads - 1));
  film_ = std::make_unique<Film>(std::move(parts));
}

int Run::go() {
  watchForInterrupt();
  try {
    loop();
    if (film_) film_->finish();
  } catch (const Error& error) {
    // Keep what there is: the frames that were handed in, the rows, and a report that says why there are no more.
    try {
      if (film_) film_->finish();
    } catch (const Error&) {
      // The film is what failed; `error` says so already.
    }
    report("failed", error.what());
    throw;
  }
  const bool complete = pace_->ended();
  report(complete ? "complete" : "interrupted", {});
  show(true);
  summarise();
  return complete ? 0 : 130;
}

void Run::loop() {
  sim::Simulation& sim = *simulation_;
  std::size_t warned = 0;
  for (;;) {
    const bool row = pace_->rowDue(), last = pace_->ended();
    if (row) ledger_->add(sim, report_.ledger);
    if (row && observer_) observer_->add(sim);
    if (diagnostics_ && ((row && !last && pace_->rows() % diagnostics_->every() == 0) || last)) diagnostics_->add(sim);
    if (pace_->frameDue()) writeFrame();
    for (; warned < sim.warnings().size(); ++warned) warn(sim.warnings()[warned]);
    if (last || interrupted()) return;
    show(false);
    const double before = progress_.secondsSinceStart();
    // In small portions, so that progress shows and Ctrl-C is heard between distant outputs too.
    do {
      pace_->advance(sim, 200);
      show(false);
    } while (pace_->underWay() && !interrupted());
    report_.simulationTime += progress_.secondsSinceStart() - before;
  }
}

void Run::writeFrame() {
  if (!film_) return;
  Snapshot snapshot;
  simulation_->fill(snapshot);
  film_->add(std::move(snapshot));
}

void Run::show(bool last) {
  progress_.show({simulation_->time(), static_cast<double>(report_.plan.steps) * report_.plan.timeStep, film_ ? film_->frames() : 0,
                  film_ ? static_cast<std::size_t>(report_.plan.frames) : 0, static_cast<double>(simulation_->grainSteps())},
                 last);
}

void Run::report(const std::string& ended, const std::string& failure) {
  sim::Simulation& sim = *simulation_;
  RunReport& r = report_;
  r.ended = ended;
  r.failure = failure;
  r.steps = sim.steps();
  r.simulatedTime = sim.time();
  r.wallTime = progress_.secondsSinceStart();
  r.grainSteps = sim.grainSteps();
  r.grains = sim.grains();
  r.counts = sim.counts();
  r.lostGrains = sim.lostGrains();
  r.warnings.insert(r.warnings.end(), sim.warnings().begin(), sim.warnings().end());
  r.worstEnergyResidual = ledger_->worstResidual();
  if (failure.empty()) {
    r.energyResidual = r.ledger ? sim.ledger().residualFraction() : 0;
    r.stateHash = fmt::format("{:016x}", sim.stateHash());
  }
  if (observer_) r.observables = observer_->results();
  r.threadsUsed = simulation_->threadsUsed();
  if (options_.profile) noteProfile();
  if (r.plan.live) r.pace = *pace_;
  r.frames = film_ ? film_->frames() : 0;
  r.renderer = film_ ? film_->renderer() : "";
  writeReport(folder_ / "run.json", r);
}

// What the parts of a step leave over: threads that wait for each other, and what is done once for all (ledger rows, snapshots).
void Run::noteProfile() {
  const sim::Profile::Seconds seconds = simulation_->profile();
  double left = report_.simulationTime * report_.threadsUsed;
  for (std::size_t part = 0; part < seconds.size(); ++part) {
    left -= seconds[part];
    report_.profile.emplace_back(sim::nameOf(static_cast<sim::ProfilePart>(part)), seconds[part]);
  }
  report_.profile.emplace_back("waiting, and the rest", std::max(0.0, left));
}

void Run::summarise() const {
  const RunReport& r = report_;
  std::string text = fmt::format("{} {}: {} grains, t = {:.4g} s, {} steps of {:.4g} s in {:.1f} s", r.scene, r.ended, r.grains,
                                 r.simulatedTime, r.steps, r.plan.timeStep, r.wallTime);
  if (r.ledger) text += fmt::format("; energy unaccounted for: {:.2g} %", 100 * r.energyResidual);
  if (r.counts.lost > 0) text += fmt::format("; {} grains lost", r.counts.lost);
  if (!r.setting.empty()) text += fmt::format("\nsetting of the study: {}", r.setting);
  if (!r.profile.empty()) {
    double all = 0;
    for (const auto& [part, seconds] : r.profile) all += seconds;
    fmt::print("{:<26}{:>8}{:>8}{:>22}\n", "time of all threads", "s", "%", "ns per grain-step");
    for (const auto& [part, seconds] : r.profile)
      fmt::print("  {:<24}{:>8.2f}{:>8.1f}{:>22.2f}\n", part, seconds, 100 * seconds / std::max(all, 1e-9),
                 1e9 * seconds / std::max<double>(1, static_cast<double>(r.grainSteps)));
  }
  fmt::print("{}\n{}: {} frames, ledger.csv, {}run.json\n", text, folder_.string(), r.frames,
             diagnostics_ ? diagnostics_->names() + ", " : "");
}

}  // namespace

int run(const RunOptions& options) { return Run(options).go(); }

}  // namespace tsubu::app
