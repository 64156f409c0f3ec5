// Steps of another length, in a run (docs/physics.md, I8).

#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "sim/fields/drag.h"
#include "sim/simulation_impl.h"
#include "sim/time_step.h"

namespace tsubu::sim {

void checkChangingSteps(Integrator integrator) {
  if (integrator != Integrator::leapfrog && integrator != Integrator::centralDifferences) return;
  throw Error(ErrorKind::scene,
              fmt::format("With {} contacts see the velocity of the half step before, which belongs to steps of one length.",
                          schemeOf(integrator).name),
              "choose velocity_verlet");
}

void Simulation::Impl::setTimeStep(double dt) {
  checkChangingSteps(model.integrator);
  if (!(dt > 0)) throw Error(ErrorKind::simulation, "The time step must be positive.");
  computeForces();
  // A step that goes over to another length already, with its forces known, is finished first.
  (changing ? stepAfterNext : nextTimeStep) = dt;
}

double Simulation::Impl::evaluationStep() const {
  return changing && scheme.ahead > 0 ? 0.5 * (model.timeStep + nextTimeStep) : model.timeStep;
}

double Simulation::Impl::kickStep() const {
  if (!changing) return model.timeStep;
  return scheme.ahead > 0 ? evaluationStep() : nextTimeStep;
}

// Where nothing is kept of the step before, the new length holds at once.
void Simulation::Impl::beginChange() {
  if (scheme.lead > 0) {
    changing = true;
    return;
  }
  since = time();
  stepsSince = steps;
  model.timeStep = nextTimeStep;
  nextTimeStep = 0;
}

// Velocities have gone from the middle of the old step to the middle of the new one; the way, so far by the length of the kick, is brought
// to that of the new step.
void Simulation::Impl::finishChange() {
  const double kick = kickStep(), rest = nextTimeStep - kick, ahead = nextTimeStep / kick;
  for (std::size_t g = 0; rest != 0 && g < state.size(); ++g) {
    GrainRow& row = state.rows[g];
    const HalfStepRow& half = state.half[g];
    row.x += rest * half.vx, row.y += rest * half.vy, row.z += rest * half.vz;
    row.vx = half.vx + ahead * (row.vx - half.vx), row.vy = half.vy + ahead * (row.vy - half.vy),
    row.vz = half.vz + ahead * (row.vz - half.vz);
    if (!state.turns) continue;
    if (state.keepsOrientation) {
      AngleRow& turned = state.turned[g];
      const double angle = rest * row.inverseRadius;
      turned.x += static_cast<float>(angle * half.sx), turned.y += static_cast<float>(angle * half.sy),
          turned.z += static_cast<float>(angle * half.sz);
    }
    row.sx = half.sx + ahead * (row.sx - half.sx), row.sy = half.sy + ahead * (row.sy - half.sy),
    row.sz = half.sz + ahead * (row.sz - half.sz);
  }
  state.allToSingle();
  since = time();
  stepsSince = steps;
  model.timeStep = nextTimeStep;
  nextTimeStep = std::exchange(stepAfterNext, 0.0);
  changing = false;
  stepsBetweenArrivals = 1;
  prepareArrivals();
}

ContactNetwork Simulation::Impl::networkNow() {
  const Instant instant = instantNow();
  std::vector<std::uint16_t> material(instant.grains.size());
  const std::vector<std::int32_t> rank = ranks();
  for (std::size_t g = 0; g < state.size(); ++g) material[static_cast<std::size_t>(rank[g])] = state.material[g];
  ContactNetwork network = networkOf(model, law, constants, state.turns, instant, material);
  for (const auto& pass : passes) {
    const std::size_t before = network.links.size();
    pass->addLinks(world(time(), model.timeStep), network.links);
    for (std::size_t l = before; l < network.links.size(); ++l) {
      Link& link = network.links[l];
      link.first = rank[static_cast<std::size_t>(link.first)];
      if (link.second >= 0) link.second = rank[static_cast<std::size_t>(link.second)];
    }
  }
  if (!model.fields.drag && !model.fields.damping) return network;
  const FlowField flow(model.fields.drag ? model.fields.drag->flow : Flow{});
  for (const SeenGrain& grain : instant.grains) {
    const Vec3& x = grain.position;
    const V3 u = flow.at({x.x(), x.y(), x.z()}).velocity;
    const DampingRates rates =
        dampingRates(model.fields, grain.mass, grain.radius, (grain.velocity - Vec3(u.x, u.y, u.z)).norm(), state.turns);
    network.slowing = std::max({network.slowing, rates.linear, rates.rotary});
  }
  return network;
}

StepLimit Simulation::Impl::stableStepNow() {
  const ContactNetwork network = networkNow();
  StepLimit limit = longestStep(network, model.integrator, stiffest);
  for (std::size_t w = 0; w < moving.size(); ++w) {
    if (moving[w].contacts() == 0) continue;
    const double own = sim::stableStep(moving[w], contactsOfMoving[w], model.integrator);
    if (own < limit.step)
      limit.step = own,
      limit.by = fmt::format("wall '{}', of its mass and {} contacts", model.walls[moving[w].wall()].name, moving[w].contacts());
  }
  return limit;
}

}  // namespace tsubu::sim
