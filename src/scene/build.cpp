#include "scene/build.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "render/colour_map.h"
#include "scene/build_bonds.h"
#include "scene/pairs.h"
#include "scene/place_grains.h"
#include "scene/wall_pictures.h"
#include "sim/fields/drag.h"
#include "sim/fields/gravity.h"
#include "sim/pass.h"
#include "sim/periodic.h"
#include "sim/simulation.h"
#include "sim/state.h"

namespace tsubu::scene {

namespace {

sim::PropertyValues valuesOf(const Properties& properties) {
  sim::PropertyValues values;
  for (const sim::PropertyInfo& info : sim::propertyTable()) {
    if (properties[info.property]) values[info.property] = *properties[info.property];
  }
  return values;
}

void buildMaterials(const Scene& scene, sim::Model& model) {
  for (const Material& material : scene.materials) model.materials.push_back({material.name, valuesOf(material.properties)});
  model.pairs = sim::PairTable(scene.materials.size());
  for (std::size_t a = 0; a < scene.materials.size(); ++a) {
    for (std::size_t b = a; b < scene.materials.size(); ++b) model.pairs.set(a, b, valuesOf(pairProperties(scene, a, b)));
  }
}

// K; nothing reads it where heat is not modelled.
double temperatureOf(const Scene& scene, const GrainSource& source) {
  return source.temperature.value_or(scene.heat ? scene.heat->temperature : 0.0);
}

sim::Stream buildStream(const Scene& scene, const GrainSource& source, const Inlet& inlet) {
  sim::Stream stream;
  stream.name = source.name;
  stream.region = inlet.region;
  (inlet.rateKind == RateKind::number ? stream.grainsPerSecond : stream.kilogramsPerSecond) = inlet.rate;
  stream.radii = source.radii;
  stream.velocity = source.velocity;
  stream.velocitySpread = source.velocitySpread;
  stream.angularVelocity = source.spin;
  stream.material = static_cast<std::uint16_t>(materialIndex(scene, source.material));
  stream.temperature = temperatureOf(scene, source);
  stream.start = inlet.start;
  stream.end = inlet.end;
  if (inlet.count) stream.count = *inlet.count;
  return stream;
}

void buildGrains(const Scene& scene, sim::Model& model) {
  std::vector<std::size_t> first;
  for (const GrainSource& source : scene.grains) {
    first.push_back(model.grains.size());
    placeGrains(scene, source, model.grains);
    for (std::size_t g = first.back(); g < model.grains.size(); ++g) model.grains[g].temperature = temperatureOf(scene, source);
    if (const auto* inlet = std::get_if<Inlet>(&source.from)) model.streams.push_back(buildStream(scene, source, *inlet));
  }
  refuseOverlaps(scene, model.grains, first);
  first.push_back(model.grains.size());
  model.bonds = buildBonds(scene, first);
}

sim::WallMotion motionOf(const Wall& wall) {
  struct Kind {
    using Result = decltype(sim::MotionPart::kind);
    Result operator()(const Translate& m) const { return sim::Translation{m.velocity}; }
    Result operator()(const Rotate& m) const { return sim::Rotation{m.point, m.axis, m.speed}; }
    Result operator()(const Oscillate& m) const { return sim::Oscillation{m.amplitude, m.frequency, m.phase}; }
    Result operator()(const Rock& m) const { return sim::Rocking{m.point, m.axis, m.amplitude, m.frequency, m.phase}; }
  };
  std::vector<sim::MotionPart> parts;
  for (const Motion& motion : wall.motions) parts.push_back({std::visit(Kind{}, motion.kind), motion.start, motion.end});
  return sim::WallMotion(std::move(parts));
}

// What is to be seen: grains, inlets and meshes; planes have no end.
Box boundsOf(const sim::Model& model) {
  Box bounds;
  for (const sim::Grain& grain : model.grains) {
    bounds.extend(grain.position - Vec3::Constant(grain.radius));
    bounds.extend(grain.position + Vec3::Constant(grain.radius));
  }
  for (const sim::Stream& stream : model.streams) bounds.extend(stream.region.bounds());
  for (const sim::Wall& wall : model.walls) {
    if (wall.surface && !wall.surface->asPlane()) bounds.extend(wall.surface->bounds());
  }
  // Grains fall until something holds them: the planes beneath belong to the picture.
  for (const sim::Wall& wall : model.walls) {
    const auto plane = wall.surface ? wall.surface->asPlane() : std::nullopt;
    if (!plane || bounds.isEmpty() || -model.gravity.dot(plane->normal) < 0.5 * model.gravity.norm()) continue;
    const Vec3 centre = bounds.center();
    bounds.extend(centre - plane->signedDistance(centre) * plane->normal);
  }
  if (bounds.isEmpty()) bounds = Box(Vec3::Constant(-0.5), Vec3::Constant(0.5));
  return bounds;
}

void buildWalls(const Scene& scene, Built& built) {
  for (const Wall& wall : scene.walls) {
    sim::Wall made;
    made.name = wall.name;
    made.motion = motionOf(wall);
    made.body = wall.body;
    made.temperature = wall.temperature;
    made.material = static_cast<std::uint16_t>(materialIndex(scene, wall.material));
    TriangleMesh seen;
    if (const auto* plane = std::get_if<PlaneShape>(&wall.shape)) {
      made.surface = std::make_shared<const sim::Surface>(sim::Surface::plane(wall.name, plane->point, plane->normal));
    } else {
      seen = placedMesh(scene, wall, std::get<MeshShape>(wall.shape));
      made.surface = std::make_shared<const sim::Surface>(seen);
      for (const sim::MeshFault& fault : made.surface->faults())
        (fault.remedy == sim::MeshRemedy::harmless ? built.notes : built.warnings).push_back(fault.sentence);
    }
    built.walls.push_back({std::move(seen), lookOf(scene, wall)});
    built.model.walls.push_back(std::move(made));
  }
  built.bounds = boundsOf(built.model);
  for (std::size_t i = 0; i < scene.walls.size(); ++i) {
    if (const auto* plane = std::get_if<PlaneShape>(&scene.walls[i].shape)) {
      built.walls[i].mesh = drawnPlane(scene, scene.walls[i], *plane, built.bounds);
    }
  }
}

// s of simulated time for which a broken bond is shown.
double brokenFor(const Scene& scene) { return scene.show.brokenFor.value_or(1.0 / 3 / slowMotion(scene.output)); }

sim::Model buildModel(const Scene& scene) {
  const Simulation& s = scene.simulation;
  sim::Model model;
  buildMaterials(scene, model);
  model.contact = scene.contact;
  model.integrator = s.integrator;
  model.precision = s.precision;
  model.gravity = s.gravity;
  model.fields = scene.fields;
  model.heat = scene.heat.has_value();
  for (const Sink& sink : scene.sinks) model.sinks.push_back({sink.name, sink.region});
  for (const Counter& counter : scene.counters)
    model.counters.push_back({counter.name, counter.point, counter.normal.normalized(), counter.radius});
  if (s.domain) model.domain = Box(s.domain->min, s.domain->max);
  model.periodic = s.periodic;
  model.skin = s.skin.value_or(0);
  model.ledger = s.ledger;
  if (!scene.bonds.empty() && scene.show.bonds) model.showBonds = brokenFor(scene);
  model.orientation = scene.colours.pattern != render::Pattern::none;
  model.load = scene.colours.by == render::ColourBy::force;
  model.showForces = scene.show.forces != render::ShownForces::none;
  const auto ofForces = [](const Observable& o) { return std::holds_alternative<PeakForce>(o.kind); };
  model.contactForces = scene.diagnostics.has_value() || model.showForces || s.limit == StepRule::spectral ||
                        std::any_of(scene.observe.begin(), scene.observe.end(), ofForces);
  model.continuous = s.continuous;
  model.watch = {s.overlapLimit, s.travelLimit, s.onViolation == OnViolation::stop};
  model.seed = s.seed;
  return model;
}

// Four diameters: two grains that far apart pull at each other with 1/256 of what they do when they touch.
double automaticCutOff(const sim::Model& model) {
  const auto magnetic = [&](std::uint16_t material) {
    const sim::PropertyValues& values = model.materials[material].values;
    return values.has(sim::Property::magnetisation) || values.has(sim::Property::susceptibility);
  };
  double largest = 0;
  for (const sim::Grain& grain : model.grains)
    if (magnetic(grain.material)) largest = std::max(largest, grain.radius);
  for (const sim::Stream& stream : model.streams)
    if (magnetic(stream.material)) largest = std::max(largest, stream.radii.largest());
  return 8 * largest;
}

void buildMagnets(const Scene& scene, sim::Model& model) {
  if (!scene.magnets) return;
  model.magnets.emplace();
  model.magnets->cutOff = scene.magnets->cutOff.value_or(automaticCutOff(model));
  for (const FieldSource& source : scene.magnets->sources) {
    sim::FieldSource& made = model.magnets->sources.emplace_back();
    made.kind = source.kind;
    const auto named = [&](const Wall& wall) { return wall.name == source.wall; };
    const auto wall = std::find_if(scene.walls.begin(), scene.walls.end(), named);
    if (!source.wall.empty()) made.wall = static_cast<std::size_t>(wall - scene.walls.begin());
  }
}

render::Style buildStyle(const Scene& scene) {
  render::Style style;
  style.picture = scene.picture;
  style.background = scene.background;
  style.light = scene.light;
  style.camera = scene.camera;
  style.grains = scene.colours;
  style.grains.shown = scene.show.grains;
  style.grains.scale = scene.show.grainScale.value_or(scene.show.forces == render::ShownForces::none ? 1 : 0.25);
  style.bonds.shown = !scene.bonds.empty() && scene.show.bonds;
  style.bonds.map = scene.show.bondMap;
  style.bonds.range = scene.show.bondRange;
  style.bonds.scale = scene.show.bondScale;
  style.bonds.brokenFor = brokenFor(scene);
  style.forces = {scene.show.forces, scene.show.forceMap, scene.show.forceRange, scene.show.forceRadius.value_or(0)};
  std::size_t given = 0;
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    if (scene.materials[i].colour) given = i + 1;
  }
  for (std::size_t i = 0; i < given; ++i) style.grains.materials.push_back(scene.materials[i].colour.value_or(render::materialColour(i)));
  style.overlay.time = scene.overlay.time;
  style.overlay.timeDecimals = scene.overlay.timeDecimals;
  style.overlay.legend = scene.overlay.legend;
  style.overlay.legendPlace = scene.overlay.legendPlace == 1 ? render::LegendPlace::topRight : render::LegendPlace::bottomRight;
  if (scene.overlay.title) style.overlay.title = scene.title;
  const double slow = slowMotion(scene.output);
  if (scene.overlay.time && std::abs(slow - 1) > 1e-9) style.overlay.slowMotion = slow;
  return style;
}

// What a fluid may give to grains within the bounds: all flows but that of a pipe are largest at a corner.
double flowSpeed(const sim::Model& model, const Box& bounds) {
  if (!model.fields.drag) return 0;
  const auto* pipe = std::get_if<sim::PipeFlow>(&model.fields.drag->flow);
  double most = pipe ? std::abs(pipe->speed) : 0;
  const sim::FlowField flow(model.fields.drag->flow);
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 x = bounds.corner(static_cast<Box::CornerType>(corner));
    most = std::max(most, sim::norm(flow.at({x.x(), x.y(), x.z()}).velocity));
  }
  return most;
}

// What weight and buoyancy can do against linear drag: the fastest terminal velocity, infinite without it.
double terminalSpeed(const sim::Model& model) {
  const double gravity = sim::strongestGravity(model.gravity, model.fields.gravity);
  const double fluid = model.fields.drag && model.fields.drag->buoyancy ? model.fields.drag->density : 0;
  double most = 0;
  const auto meet = [&](std::uint16_t material, double radius) {
    const double density = model.materials[material].values[sim::Property::density];
    const double rate = sim::dampingRates(model.fields, sim::massOf(density, radius), radius, 0, false).linear;
    most = std::max(most, gravity * std::abs(1 - fluid / density) / rate);
  };
  for (const sim::Grain& grain : model.grains) meet(grain.material, grain.radius);
  for (const sim::Stream& stream : model.streams) meet(stream.material, stream.radii.largest());
  return most;
}

// What a wall may come to that moves under load: free over the height of the scene, or held back by its guide.
double bodySpeed(const sim::WallBody& body, double gravity, const Box& bounds) {
  const double pull = std::abs(body.force) + (body.weight ? body.mass * gravity : 0.0);
  const double free = std::sqrt(body.velocity * body.velocity + 2 * pull / body.mass * bounds.sizes().norm());
  return body.damping > 0 ? std::min(free, std::max(std::abs(body.velocity), pull / body.damping)) : free;
}

// The largest speed to expect: what grains start with or get from falling through the scene, and what moving walls have.
double expectedSpeed(const sim::Model& model, const Box& bounds, double end) {
  double start = 0, wall = 0;
  for (const sim::Grain& grain : model.grains) start = std::max(start, grain.velocity.norm());
  for (const sim::Stream& stream : model.streams) start = std::max(start, stream.velocity.norm() + std::sqrt(3.0) * stream.velocitySpread);
  for (const sim::Wall& w : model.walls) {
    if (!w.motion.still() && w.surface)
      wall = std::max(wall, w.motion.maxSpeed(w.surface->asPlane() ? bounds : w.surface->bounds(), 0, end));
  }
  for (const sim::Wall& w : model.walls) {
    if (w.body) wall = std::max(wall, bodySpeed(*w.body, sim::strongestGravity(model.gravity, model.fields.gravity), bounds));
  }
  const double drop = model.fields.gravity.empty() ? model.gravity.cwiseAbs().dot(bounds.sizes())  // |g| × height along gravity
                                                   : sim::strongestGravity(model.gravity, model.fields.gravity) * bounds.sizes().norm();
  return std::max({std::min(std::sqrt(start * start + 2 * drop), std::max(start, terminalSpeed(model))), wall, flowSpeed(model, bounds)});
}

std::uint64_t roundUp(double ratio) { return static_cast<std::uint64_t>(std::max(1.0, std::ceil(ratio * (1 - 1e-9)))); }

double smallestRadius(const sim::Model& model) {
  double smallest = forever;
  for (const sim::Grain& grain : model.grains) smallest = std::min(smallest, grain.radius);
  for (const sim::Stream& stream : model.streams) smallest = std::min(smallest, stream.radii.smallest());
  return smallest;
}

sim::StepLimit limitAtStart(const sim::Model& model, double step) {
  sim::Model still = model;
  still.timeStep = step;
  still.contactForces = true;
  still.ledger = still.watch.stop = false;
  return sim::Simulation(std::move(still), 1).stableStep();
}

}  // namespace

FramePlan planFrames(const Scene& scene, const sim::Model& model, double speed, std::vector<std::string>& warnings) {
  const Simulation& s = scene.simulation;
  FramePlan plan;
  plan.interval = frameInterval(scene.output);
  plan.ledgerInterval = ledgerInterval(scene.output);
  const bool live = s.limit == StepRule::spectral;
  const sim::TimeStepChoice choice = live ? sim::chooseStepForNewContacts(model) : sim::chooseTimeStep(model);
  plan.limit = choice.limit;
  if (!choice.warning.empty()) warnings.push_back(choice.warning);
  double step;
  if (s.timeStep) {
    step = *s.timeStep;
    plan.limitedBy = "the scene (time_step)";
    if (step > choice.limit) {
      warnings.push_back(
          fmt::format("The time step of {:.4g} s is above the stability limit of {:.4g} s ({}).", step, choice.limit, choice.limitedBy));
    }
  } else {
    step = s.safety * choice.limit;
    plan.limitedBy = fmt::format("{}; {} of the limit", choice.limitedBy, s.safety);
    const double travel = 0.5 * s.travelLimit * smallestRadius(model) / speed;
    if (travel < step && !s.continuous) {
      step = travel;
      plan.limitedBy = fmt::format("speed: up to {:.3g} m/s, half of travel_limit per step", speed);
    }
    if (live) {
      plan.live = {s.safety, step, plan.limitedBy};
      const sim::StepLimit now = limitAtStart(model, step);
      if (now.step < plan.limit) plan.limit = now.step;
      if (s.safety * now.step < step) {
        step = s.safety * now.step;
        plan.limitedBy = fmt::format("{} at the start; {} of the limit", now.by, s.safety);
      }
    }
  }
  // The shorter interval is a whole number of steps, and so is the longer one, which is a whole number of the shorter.
  const double shorter = std::min(plan.interval, plan.ledgerInterval);
  const std::uint64_t stepsPerInterval = roundUp(shorter / step);
  plan.timeStep = shorter / static_cast<double>(stepsPerInterval);
  plan.stepsPerFrame = stepsPerInterval * static_cast<std::uint64_t>(std::llround(plan.interval / shorter));
  plan.stepsPerLedgerRow = stepsPerInterval * static_cast<std::uint64_t>(std::llround(plan.ledgerInterval / shorter));
  plan.steps = roundUp(s.end / plan.timeStep);
  plan.frames = plan.steps / plan.stepsPerFrame + 1;
  return plan;
}

Built build(const Scene& scene) {
  Built built;
  built.model = buildModel(scene);
  buildGrains(scene, built.model);
  sim::checkPeriods(built.model);
  buildWalls(scene, built);
  buildMagnets(scene, built.model);
  sim::checkIntegrator(built.model);
  sim::checkRotation(built.model);
  sim::checkContinuous(built.model);
  sim::checkPrecision(built.model);
  built.plan = planFrames(scene, built.model, expectedSpeed(built.model, built.bounds, scene.simulation.end), built.warnings);
  built.model.timeStep = built.plan.timeStep;
  built.style = buildStyle(scene);
  if (!scene.show.forceRadius) built.style.forces.radius = 0.5 * smallestRadius(built.model);
  return built;
}

}  // namespace tsubu::scene
