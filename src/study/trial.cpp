#include "study/trial.h"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <memory>

#include <fmt/format.h>

#include "core/error.h"
#include "scene/pace.h"

namespace tsubu::study {

namespace {

// s: of this thread, whoever else uses the machine.
double cpuTime() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// So many grain-steps are run before `stop` is asked again: some milliseconds.
constexpr std::uint64_t portion = 100000;

bool plainWord(const std::string& text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isalnum(c) || std::string_view("_-./=,:+").find(static_cast<char>(c)) != std::string_view::npos;
  });
}

std::string quoted(const std::string& text) {
  if (plainWord(text)) return text;
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

}  // namespace

std::string commandOf(const Trial& trial) {
  std::string command = fmt::format("tsubu run {} --no-frames", quoted(trial.scene));
  for (const std::string& override : trial.overrides) command += fmt::format(" --set {}", quoted(override));
  return command;
}

std::optional<Outcome> run(const Trial& trial, const Stop& stop, const Watch& watch) {
  const scene::Scene scene = scene::read(trial.scene, trial.overrides);
  scene::Built built = scene::build(scene);
  const scene::FramePlan plan = built.plan;
  const std::uint64_t grains = std::max<std::uint64_t>(1, built.model.grains.size());
  Outcome outcome;
  outcome.timeStep = plan.timeStep;
  outcome.limit = plan.limit;
  // A run that fails may do so in the middle of a step: what is told of it is where and why, and what it has cost.
  std::unique_ptr<sim::Simulation> simulation;
  const double start = cpuTime();
  const auto began = std::chrono::steady_clock::now();
  try {
    simulation = std::make_unique<sim::Simulation>(std::move(built.model), 1);
    Observer observer(scene, observablesOf(scene));
    scene::Pace pace(plan);
    for (;;) {
      if (pace.rowDue()) observer.add(*simulation);
      if (pace.ended()) break;
      do {
        if (stop && stop()) return std::nullopt;
        if (watch && watch(simulation->time() / (static_cast<double>(plan.steps) * plan.timeStep), cpuTime() - start)) return std::nullopt;
        pace.advance(*simulation, portion / grains + 1);
      } while (pace.underWay());
    }
    outcome.values = observer.results();
    outcome.stateHash = fmt::format("{:016x}", simulation->stateHash());
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::simulation) throw;
    outcome.failure = error.what();
  }
  outcome.cost = cpuTime() - start;
  outcome.wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  if (simulation) {
    outcome.steps = simulation->steps();
    outcome.grainSteps = simulation->grainSteps();
    outcome.grains = simulation->grains();
  }
  return outcome;
}

}  // namespace tsubu::study
