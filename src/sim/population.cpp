// Who comes and goes: arrivals at inlets, grains taken out by sinks, grains that are lost, and those that cross a counter.

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "sim/heat.h"
#include "sim/simulation_impl.h"

namespace tsubu::sim {

namespace {

// Inlets look for room this often: in the time in which a grain moves this share of its radius.
constexpr double arrivalTravel = 0.25;

}  // namespace

void Simulation::Impl::prepareArrivals() {
  double interval = std::numeric_limits<double>::infinity();
  for (const Stream& stream : model.streams) {
    const double r = stream.radii.smallest();
    const double speed = stream.velocity.norm() + std::sqrt(2 * strongestGravity(model.gravity, model.fields.gravity) * r);
    if (speed > 0) interval = std::min(interval, arrivalTravel * r / speed);
  }
  if (std::isfinite(interval)) stepsBetweenArrivals = static_cast<std::uint64_t>(std::max(1.0, std::floor(interval / model.timeStep)));
}

// A box around everything that is there, three times its size: a grain outside has left the scene. Where only unbounded planes say
// how large the scene is, a grain may go as far as a thousand times its radius.
void Simulation::Impl::chooseDomain() {
  if (!model.domain.isEmpty()) return;
  Box box;
  double largest = 0;
  for (const GrainRow& row : state.rows) {
    box.extend(positionOf(row));
    largest = std::max(largest, row.radius);
  }
  for (const Stream& stream : model.streams) box.extend(stream.region.bounds());
  bool bounded = false;
  for (const Wall& wall : model.walls) {
    if (!wall.surface->bounds().sizes().allFinite()) continue;
    box.extend(wall.surface->bounds());
    bounded = true;
  }
  for (const Sink& sink : model.sinks) {
    const Box bounds = sink.region.bounds();
    for (int axis = 0; axis < 3 && !box.isEmpty(); ++axis) {
      for (const double edge : {bounds.min()[axis], bounds.max()[axis]}) {
        Vec3 point = box.center();
        point[axis] = edge;
        if (std::isfinite(edge)) box.extend(point);
      }
    }
  }
  if (box.isEmpty()) box.extend(Vec3(Vec3::Zero()));
  for (const Stream& stream : model.streams) largest = std::max(largest, stream.radii.largest());
  for (const Wall& wall : model.walls) {
    const auto plane = wall.surface->asPlane();
    if (plane) box.extend(Vec3(box.center() - plane->signedDistance(box.center()) * plane->normal));
  }
  const double margin = std::max({box.sizes().norm(), 1e-3, bounded ? 0.0 : 1000 * largest});
  model.domain = Box(box.min() - Vec3::Constant(margin), box.max() + Vec3::Constant(margin));
}

std::uint32_t Simulation::Impl::sidesOf(const Vec3& position) const {
  std::uint32_t sides = 0;
  for (std::size_t c = 0; c < model.counters.size(); ++c)
    if ((position - model.counters[c].point).dot(model.counters[c].normal) > 0) sides |= 1U << c;
  return sides;
}

void Simulation::Impl::addGrain(const Grain& grain) {
  state.add(grain, model.materials[grain.material].values[Property::density], gravity.now(), model.timeStep);
  if (!model.counters.empty()) state.sides.push_back(sidesOf(grain.position));
  rebuildNeeded = true;
}

void Simulation::Impl::countCrossing(std::size_t grain) {
  const Vec3 x = positionOf(state.rows[grain]);
  const std::uint32_t now = sidesOf(x), changed = now ^ state.sides[grain];
  if (changed == 0) return;
  state.sides[grain] = now;
  for (std::size_t c = 0; c < model.counters.size(); ++c) {
    if ((changed >> c & 1U) == 0) continue;
    const Counter& counter = model.counters[c];
    const Vec3 offset = x - counter.point;
    if ((offset - offset.dot(counter.normal) * counter.normal).norm() > counter.radius) continue;
    counts.crossed[c] += (now >> c & 1U) ? 1 : -1;
  }
}

void Simulation::Impl::countCrossings() {
  for (std::size_t g = 0; g < state.size() && !model.counters.empty(); ++g) countCrossing(g);
}

// Asked of many grains, on all threads unless the lists are due for another reason than their ways; the few that do are then dealt with
// in order.
bool Simulation::Impl::goesOrCrosses(std::size_t grain) const {
  const Vec3 x = positionOf(state.rows[grain]);
  if (!model.counters.empty() && sidesOf(x) != state.sides[grain]) return true;
  const Vec3 inside = periods.wrapped(x);
  return !model.domain.contains(inside) ||
         std::any_of(model.sinks.begin(), model.sinks.end(), [&](const Sink& sink) { return sink.region.contains(inside); });
}

std::vector<std::size_t> Simulation::Impl::thoseWhoGoOrCross() {
  std::vector<std::vector<std::size_t>> found;
  const auto look = [&](std::size_t part, std::size_t first, std::size_t end) {
    for (std::size_t g = first; g < end; ++g)
      if (goesOrCrosses(g)) found[part].push_back(g);
  };
  if (rebuildNeeded) {
    found.resize(1);
    look(0, 0, state.size());
  } else {
    found.resize(due.size());
    team.run(static_cast<int>(due.size()), [&](int k, int) {
      const auto part = static_cast<std::size_t>(k);
      look(part, static_cast<std::size_t>(slabs.begin(due[part])), static_cast<std::size_t>(slabs.end(due[part])));
    });
  }
  std::vector<std::size_t> all;
  for (const std::vector<std::size_t>& part : found) all.insert(all.end(), part.begin(), part.end());
  return all;
}

void Simulation::Impl::changePopulation() {
  bool anyTunnelled = false;
  for (const SlabWalls& slab : walls.slabs()) anyTunnelled = anyTunnelled || !slab.tunnelled.empty();
  if (anyTunnelled || rebuildNeeded || !due.empty()) leave(anyTunnelled);
  if (!model.streams.empty() && steps % stepsBetweenArrivals == 0) arrive();
}

void Simulation::Impl::lose(std::size_t grain, const std::string& why, std::vector<char>& goes) {
  if (goes[grain]) return;
  goes[grain] = 1;
  ++counts.lost;
  lost.push_back({state.id[grain], positionOf(state.rows[grain]), time(), why});
  if (counts.lost <= 10) warnings.push_back(fmt::format("Lost: {}, {}.", describe(grain), why));
  if (counts.lost == 11) warnings.push_back("More grains are lost; run.json lists them.");
}

void Simulation::Impl::leave(bool anyTunnelled) {
  const std::vector<std::size_t> there = thoseWhoGoOrCross();
  if (there.empty() && !anyTunnelled) return;
  std::vector<char> goes(state.size(), 0);
  bool any = false;
  for (SlabWalls& slab : walls.slabs()) {
    for (const std::int32_t g : slab.tunnelled) lose(static_cast<std::size_t>(g), "went through a wall", goes);
    any = any || !slab.tunnelled.empty();
    slab.tunnelled.clear();
  }
  for (const std::size_t g : there) {
    if (!model.counters.empty()) countCrossing(g);
    const Vec3 x = periods.wrapped(positionOf(state.rows[g]));
    if (!model.domain.contains(x)) lose(g, "left the domain", goes);
    for (const Sink& sink : model.sinks) {
      if (goes[g] || !sink.region.contains(x)) continue;
      goes[g] = 1;
      ++counts.removed;
    }
    any = any || goes[g];
  }
  if (any) removeGrains(goes);
}

void Simulation::Impl::removeGrains(const std::vector<char>& goes) {
  if (model.ledger) {
    for (const SlabPairs& slab : pairs.slabs()) PairLists::refreshImages(state, slab);
    removedEnergy += storedInContactsOf(goes) + storedInPasses(goes);
  }
  std::vector<std::int32_t> stay;
  std::vector<std::int32_t> place(state.size(), -1);
  for (std::size_t g = 0; g < state.size(); ++g) {
    if (goes[g]) {
      removedEnergy += energyOf(g);
      if (model.heat) removedHeat += heatCapacityOf(model, state, g) * state.temperature[g];
      continue;
    }
    place[g] = static_cast<std::int32_t>(stay.size());
    stay.push_back(static_cast<std::int32_t>(g));
  }
  state.reorder(stay);
  placeAfterRemoval = std::move(place);
  rebuildNeeded = true;
}

double Simulation::Impl::storedInPasses(const std::vector<char>& grains) {
  double energy = 0;
  for (const auto& pass : passes) energy += pass->storedIn(world(time(), model.timeStep), grains);
  return energy;
}

// What passes store in grains that have just come is known when the lists are.
void Simulation::Impl::bookArrivals() {
  if (firstArrival == state.nextId) return;
  if (steps > 0 && model.ledger && !passes.empty()) {
    std::vector<char> came(state.size());
    for (std::size_t g = 0; g < state.size(); ++g) came[g] = state.id[g] >= firstArrival;
    insertedEnergy += storedInPasses(came);
  }
}

/// `near` is room to work in.
bool Simulation::Impl::touchesGrain(const Vec3& centre, double radius, std::vector<std::int32_t>& near) const {
  near.clear();
  // The grid knows places as they were at the last rebuild; skins cover what grains have moved since, up to the last step.
  const double around = radius + fastest * model.timeStep;
  if (rebuildNeeded) {
    for (std::size_t g = 0; g < state.size(); ++g) near.push_back(static_cast<std::int32_t>(g));
  } else {
    const Vec3 inside = periods.wrapped(centre);
    grid.near(inside, around, -1, near);
    periods.forImages(inside, grid.farthest(around), [&](int shift) { grid.near(inside + periods.shift(shift), around, -1, near); });
  }
  return std::any_of(near.begin(), near.end(), [&](std::int32_t g) {
    const GrainRow& row = state.rows[static_cast<std::size_t>(g)];
    const double cut = row.radius + radius;
    return periods.nearest(positionOf(row) - centre).squaredNorm() < cut * cut;
  });
}

void Simulation::Impl::arrive() {
  std::vector<Grain> arrivals;
  std::vector<std::int32_t> near;
  const IsFree isFree = [&](const Vec3& centre, double radius) {
    for (const Grain& grain : arrivals) {
      const double cut = grain.radius + radius;
      if (periods.nearest(grain.position - centre).squaredNorm() < cut * cut) return false;
    }
    return !touchesGrain(centre, radius, near) && !walls.touches(centre, radius);
  };
  for (std::size_t s = 0; s < model.streams.size(); ++s) {
    const Stream& stream = model.streams[s];
    stream.emit(model.seed, s, model.materials[stream.material].values[Property::density], time(), isFree, streams[s], arrivals);
  }
  for (const Grain& grain : arrivals) {
    addGrain(grain);
    insertedEnergy += energyOf(state.size() - 1);
    if (model.heat) insertedHeat += heatCapacityOf(model, state, state.size() - 1) * grain.temperature;
  }
  counts.inserted += arrivals.size();
}

}  // namespace tsubu::sim
