#include "sim/heat.h"

#include <algorithm>
#include <cmath>
#include <span>

#include <fmt/format.h>

#include "core/error.h"
#include "core/hash.h"
#include "sim/wall_pass.h"

namespace tsubu::sim {

namespace {

double harmonicMean(double a, double b) { return 2 * a * b / (a + b); }

/// H1 and H2, W/K.
double conductanceOf(double conductivity, double effectiveRadius, double overlap) {
  return 2 * conductivity * std::sqrt(effectiveRadius * overlap);
}

}  // namespace

double heatCapacityOf(const Model& model, const State& state, std::size_t grain) {
  return model.materials[state.material[grain]].values[Property::heatCapacity] * state.mass(grain);
}

double warmingRate(double conductivity, double capacity, double mass, double radius) {
  return 12 * conductanceOf(conductivity, 0.5 * radius, 0.1 * radius) / (mass * capacity);
}

HeatPass::HeatPass(const Model& model) {
  for (const Material& material : model.materials) {
    conductivity_.push_back(material.values[Property::conductivity]);
    capacity_.push_back(material.values[Property::heatCapacity]);
  }
}

void HeatPass::conduct(const World& world, int slab) {
  const State& state = world.state;
  const SlabPairs& pairs = world.pairs.slabs()[static_cast<std::size_t>(slab)];
  // Bonded grains conduct where they touch, like others; but only the outer list still has them.
  const bool bonded = !pairs.outerTouch.empty();
  const std::vector<std::int32_t>&first = bonded ? pairs.outerI : pairs.i, &second = bonded ? pairs.outerJ : pairs.j;
  for (std::size_t k = 0; k < first.size(); ++k) {
    const auto i = static_cast<std::size_t>(first[k]), j = static_cast<std::size_t>(second[k]);
    const GrainRow &a = state.rows[i], &b = state.rows[j];
    const double reach = a.radius + b.radius, distance2 = norm2(a.position() - b.position());
    if (!(distance2 < reach * reach)) continue;
    const std::int32_t partner = pairs.grainOf(second[k]);
    const auto p = static_cast<std::size_t>(partner);
    const double h = conductanceOf(harmonicMean(conductivity_[state.material[i]], conductivity_[state.material[p]]),
                                   1 / (a.inverseRadius + b.inverseRadius), reach - std::sqrt(distance2));
    const double q = h * (state.temperature[p] - state.temperature[i]);
    flow_[i] += q, conductance_[i] += h;
    if (p == j) {
      flow_[p] -= q, conductance_[p] += h;
    } else {
      across_[static_cast<std::size_t>(slab)].push_back({partner, -q, h});
    }
  }
}

void HeatPass::conductWalls(const World& world, int slabNumber) {
  const State& state = world.state;
  const SlabWalls& slab = world.walls.slabs()[static_cast<std::size_t>(slabNumber)];
  WallContacts contacts;
  for (const WallGroup& group : slab.groups) {
    const Wall& wall = world.model.walls[group.wall];
    if (!wall.temperature) continue;
    const auto g = static_cast<std::size_t>(group.grain);
    const GrainRow& row = state.rows[g];
    const std::span<const std::uint32_t> features = slab.featuresOf(group);
    wall.surface->contacts(world.walls.places()[group.wall].pose.toLocal({row.x, row.y, row.z}), row.radius, features, contacts);
    for (const WallContact& contact : contacts) {
      if (!(contact.distance < row.radius)) continue;
      const double conductivity = harmonicMean(conductivity_[state.material[g]], conductivity_[wall.material]);
      const double h = contact.weight * conductanceOf(conductivity, row.radius, row.radius - contact.distance);
      const double q = h * (*wall.temperature - state.temperature[g]);
      flow_[g] += q;
      conductance_[g] += h;
      fromWalls_[static_cast<std::size_t>(slabNumber)] += q;
    }
  }
}

void HeatPass::check(const World& world, std::size_t g) const {
  const double rate = conductance_[g] / (capacity_[world.state.material[g]] * world.state.mass(g));
  if (!(rate * world.step.dt > 1)) return;
  const GrainRow& row = world.state.rows[g];
  throw Error(ErrorKind::simulation,
              fmt::format("Heat flows too fast for the time step: grain {} at ({:.6g}, {:.6g}, {:.6g}) m would take {:.3g} of the "
                          "difference in one step, t = {:.6g} s.",
                          world.state.id[g], row.x, row.y, row.z, rate * world.step.dt, world.time),
              fmt::format("a step below {:.3g} s, less conductivity or more heat_capacity", 1 / rate));
}

void HeatPass::addForces(const World& world) {
  const std::size_t n = world.state.size();
  const int slabs = world.slabs.count();
  flow_.assign(n, 0);
  conductance_.assign(n, 0);
  fromWalls_.assign(static_cast<std::size_t>(slabs), 0);
  across_.assign(static_cast<std::size_t>(slabs), {});
  const auto evaluate = [&](int slab, int) {
    conduct(world, slab);
    conductWalls(world, slab);
  };
  overSlabs(world.order, world.team, evaluate, [](int, int) {});
  for (const std::vector<Across>& slab : across_) {
    for (const Across& across : slab) {
      flow_[static_cast<std::size_t>(across.owner)] += across.flow;
      conductance_[static_cast<std::size_t>(across.owner)] += across.conductance;
    }
  }
  double total = 0;
  for (const double share : fromWalls_) total += share;
  lastFromWalls_ = total * world.step.dt;
  heatFromWalls_ += lastFromWalls_;
  for (std::size_t g = 0; g < n; ++g) {
    check(world, g);
    world.state.warming[g] = flow_[g] * world.step.dt / (capacity_[world.state.material[g]] * world.state.mass(g));
  }
}

void HeatPass::account(const World& world, Ledger& ledger) const {
  for (std::size_t g = 0; g < world.state.size(); ++g)
    ledger.heat.stored += heatCapacityOf(world.model, world.state, g) * world.state.temperature[g];
  ledger.heat.fromWalls = heatFromWalls_ - lastFromWalls_;  // the present step's is still to come
}

std::uint64_t HeatPass::hash(const State& state) const {
  std::uint64_t sum = 0;
  for (std::size_t g = 0; g < state.size(); ++g) {
    Hash hash;
    hash.add(std::uint64_t{state.id[g]});
    hash.add(state.temperature[g]);
    sum += hash.value();
  }
  return sum;
}

}  // namespace tsubu::sim
