#include "scene/explain.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/costs.h"
#include "sim/laws/catalogue.h"
#include "sim/network.h"
#include "sim/simulation.h"

namespace tsubu::scene {

namespace {

// Rough, and meant to be: what a frame costs one core of a present machine at 1280 × 720.
constexpr double secondsPerFrame = 0.15;
constexpr double listedPairsPerGrain = 4;  // of a settled bed of equal grains, with the skin
constexpr double contactsPerGrain = 2.2;

std::string list(const std::vector<std::string>& items) {
  std::string text;
  for (const std::string& item : items) text += (text.empty() ? "" : ", ") + item;
  return text.empty() ? "nothing" : text;
}

std::string duration(double seconds) {
  if (seconds < 100) return fmt::format("{:.0f} s", std::max(1.0, seconds));
  if (seconds < 6000) return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.1f} h", seconds / 3600);
}

// Grains that inlets will have brought by the end of the run, if there is room.
double expectedFromStreams(const sim::Model& model, double end) {
  double total = 0;
  for (const sim::Stream& stream : model.streams) {
    const double time = std::max(0.0, std::min(end, stream.end) - stream.start);
    const double mass = model.materials[stream.material].values[sim::Property::density] * 4.18879 * stream.radii.meanCube();
    const double number = time * (stream.grainsPerSecond > 0 ? stream.grainsPerSecond : stream.kilogramsPerSecond / mass);
    total += std::min(number, static_cast<double>(stream.count));
  }
  return total;
}

// By how much the rules of the literature for one contact would have missed.
std::string singleContactLine(const sim::Model& model, double limit) {
  const sim::SingleContactRules rules = sim::singleContactRules(model);
  if (!std::isfinite(rules.undamped)) return {};
  return fmt::format(
      "one contact    rules for a single contact would allow {:.2g} (Note), {:.2g} (2√(m/k)), {:.2g} (π√(m/k)) times that limit\n",
      rules.note / limit, rules.undamped / limit, rules.duration / limit);
}

std::string lawLines(const Scene& scene) {
  std::string text;
  for (const sim::LawFamily& family : sim::lawFamilies()) {
    const std::string& chosen = sim::chosenIn(scene.contact, family.key);
    for (const sim::LawInfo& law : family.laws) {
      if (law.name == chosen) text += fmt::format("  {:<13}{}: {}\n", fmt::format("{}", family.key), law.name, law.sentence);
    }
  }
  return text;
}

// What bench/step has measured for each feature of the scene, and the sum in ns per grain-step.
std::string costLines(const sim::Model& model, double& sum) {
  const MeasuredCosts& costs = measuredCosts();
  std::string text = fmt::format("each costs     ns per grain-step and bytes, as measured in a bed of spheres by one thread of {} ({})\n",
                                 costs.machine, costs.isa);
  sum = 0;
  for (const std::string& feature : featuresOf(model)) {
    const FeatureCost* const cost = costs.of(feature);
    if (!cost) {
      text += fmt::format("  {:<32}not measured\n", feature);
      continue;
    }
    sum += cost->added;
    text += fmt::format("  {:<32}{:>+8.1f} ns", feature, cost->added);
    if (cost->bytesPerGrain != 0) text += fmt::format("  {:+} bytes per grain", cost->bytesPerGrain);
    if (cost->bytesPerContact != 0) text += fmt::format("  {:+} bytes per contact", cost->bytesPerContact);
    text += "\n";
  }
  return text;
}

}  // namespace

std::string explain(const Scene& scene) { return explain(scene, build(scene)); }

std::string explain(const Scene& scene, const Built& built) {
  const sim::Plan plan = sim::Simulation::plan(built.model);
  const FramePlan& frames = built.plan;
  const double streamed = expectedFromStreams(built.model, scene.simulation.end);
  const double start = static_cast<double>(built.model.grains.size()), grains = start + streamed;
  // Streams fill up evenly: half of what they bring takes part in the average step.
  const double grainSteps = (start + streamed / 2) * static_cast<double>(frames.steps);
  const double memory = grains * (static_cast<double>(plan.bytesPerGrain) + contactsPerGrain * static_cast<double>(plan.bytesPerContact) +
                                  listedPairsPerGrain * static_cast<double>(plan.bytesPerListedPair));
  double nanoseconds = 0;
  const std::string costs = costLines(built.model, nanoseconds);
  const double computing = 1e-9 * grainSteps * nanoseconds, drawing = static_cast<double>(frames.frames) * secondsPerFrame;

  std::string text;
  if (!scene.title.empty()) text += scene.title + "\n\n";
  text += fmt::format("modelled       {}\nnot modelled   {}\n", list(plan.modelled), list(plan.notModelled));
  text += "laws\n" + lawLines(scene);
  text += fmt::format("each step      {}\n", list(plan.passes));
  text += fmt::format("grains         {} at the start{}\n", built.model.grains.size(),
                      streamed > 0 ? fmt::format(", about {:.0f} from inlets", streamed) : std::string());
  text += fmt::format("memory         {} bytes per grain, {} per contact, {} per listed pair: about {:.3g} MB\n", plan.bytesPerGrain,
                      plan.bytesPerContact, plan.bytesPerListedPair, memory / 1e6);
  text += fmt::format("time step      {:.6g} s, set by {} (stability limit {:.4g} s)\n", frames.timeStep, frames.limitedBy, frames.limit);
  if (frames.live)
    text += fmt::format("               and follows the stiffest mode of the live network: {} of its limit, {:.4g} s at most ({})\n",
                        frames.live->safety, frames.live->longest, frames.live->longestBy);
  text += singleContactLine(built.model, frames.limit);
  text += fmt::format("steps          {}{} for {:g} s\n", frames.live ? "by the first of them " : "", frames.steps,
                      static_cast<double>(frames.steps) * frames.timeStep);
  text += fmt::format("frames         {} of {} x {} pixels, one every {:g} s ({} steps), slow motion {:g}\n", frames.frames,
                      scene.picture.width, scene.picture.height, frames.interval, frames.stepsPerFrame, slowMotion(scene.output));
  text += costs;
  text += fmt::format("cost           roughly {} for {:.3g} million grain-steps on one core, and {} for the frames\n", duration(computing),
                      grainSteps / 1e6, duration(drawing));
  for (const std::string& warning : built.warnings) text += fmt::format("warning        {}\n", warning);
  return text;
}

}  // namespace tsubu::scene
