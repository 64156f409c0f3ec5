// What a model will do and what it costs, without running it.

#include <algorithm>

#include <fmt/format.h>

#include "sim/fields/gravity.h"
#include "sim/laws/catalogue.h"
#include "sim/pair_constants.h"
#include "sim/pass.h"
#include "sim/simulation.h"
#include "sim/state.h"

namespace tsubu::sim {

Plan Simulation::plan(const Model& model) {
  const std::size_t law = lawIndex(model.contact);
  const LawTraits& traits = lawFunctions(law).traits;
  const Scheme scheme = schemeOf(model.integrator);
  const bool kept = model.integrator == Integrator::velocityVerlet, previous = model.integrator == Integrator::centralDifferences;
  Plan plan;
  const auto item = [&](bool modelled, std::string what) { (modelled ? plan.modelled : plan.notModelled).push_back(std::move(what)); };
  item(true, fmt::format("normal contact: {}{}", model.contact.normal, model.contact.tension ? ", with tension" : ""));
  item(traits.turns, traits.turns ? fmt::format("friction: {}", model.contact.tangential) : "friction");
  const bool rolls = model.contact.rolling != "none", twists = model.contact.twisting != "none";
  item(rolls, rolls ? fmt::format("rolling resistance: {}", model.contact.rolling) : "rolling resistance");
  item(twists, twists ? fmt::format("twisting resistance: {}", model.contact.twisting) : "twisting resistance");
  item(grainsTurn(model), traits.turns && !model.contact.rotation ? "rotation (held)" : "rotation");
  item(keepsOrientation(model), "orientation");
  item(!model.bonds.empty(), "bonds");
  item(strongestGravity(model.gravity, model.fields.gravity) > 0, model.fields.gravity.empty() ? "gravity" : "gravity that changes");
  item(model.fields.drag.has_value(), "drag");
  item(model.magnets.has_value(), "magnets");
  item(model.heat, "heat conduction");
  item(model.fields.damping.has_value(), "global damping");
  item(!model.walls.empty(), "walls");
  const auto moves = [](const Wall& wall) { return wall.body.has_value(); };
  item(std::any_of(model.walls.begin(), model.walls.end(), moves), "walls that move under load");
  item(!model.streams.empty(), "inlets");
  item(!model.sinks.empty(), "sinks");
  item(!model.counters.empty(), "counters");
  const bool periodic = std::find(model.periodic.begin(), model.periodic.end(), true) != model.periodic.end();
  item(periodic, "periodic domain");
  item(model.continuous, "continuous collisions");
  const bool mixed = model.precision == Precision::mixed;
  if (mixed) item(true, "contacts between grains in single precision");
  item(model.ledger, "energy ledger");
  item(model.contactForces, "diagnostics");

  if (!model.streams.empty()) plan.passes.push_back("arrivals");
  if (!model.sinks.empty()) plan.passes.push_back("sinks");
  plan.passes.push_back("neighbour lists (when grains have moved)");
  plan.passes.push_back(periodic ? "pair contacts, also across the periodic boundary" : "pair contacts");
  if (!model.walls.empty()) plan.passes.push_back("wall contacts");
  for (const auto& pass : makePasses(model)) plan.passes.push_back(pass->name());
  plan.passes.push_back(fmt::format("integrate: {}", scheme.name));

  plan.bytesPerGrain = sizeof(GrainRow) + sizeof(ForceRow) + (kept ? sizeof(HalfStepRow) : 0) + (previous ? sizeof(PlaceRow) : 0) +
                       (keepsOrientation(model) ? sizeof(Quat) + sizeof(AngleRow) : 0) + (model.heat ? 2 * sizeof(double) : 0) +
                       sizeof(std::uint16_t) + sizeof(std::uint32_t) + (model.counters.empty() ? 0 : sizeof(std::uint32_t)) + sizeof(Vec3) +
                       2 * sizeof(float);
  plan.bytesPerGrain += mixed ? sizeof(SingleRow) + sizeof(SingleForceRow) : 0;
  plan.bytesPerContact = static_cast<std::size_t>(traits.stateSize) * (mixed ? sizeof(float) : sizeof(double));
  plan.bytesPerListedPair = (traits.stateSize > 0 ? 5 : 4) * sizeof(std::int32_t);
  return plan;
}

}  // namespace tsubu::sim
