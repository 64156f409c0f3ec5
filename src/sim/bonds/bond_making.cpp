// Which bonds are made, and when.

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/bonds/bond_pass.h"
#include "sim/bonds/bond_search.h"

namespace tsubu::sim {

namespace {

// While bonds are made all the time, pairs are looked for again when two grains may have come nearer by this share of the smallest radius.
constexpr double searchTravel = 0.01;

}  // namespace

void BondPass::makeDue(const World& world) {
  const double slack = 0.5 * world.step.dt;
  if (world.time > until_ + slack) {
    // Not clear(), which goes over all buckets, of an empty set too: in every step.
    std::unordered_set<std::uint64_t>().swap(known_);
    std::unordered_set<std::uint64_t>().swap(knownAtWalls_);
    return;
  }
  bool searched = false;
  for (std::size_t k = 0; k < kinds_.size(); ++k) {
    Kind& kind = kinds_[k];
    const Bonding& bonding = *kind.bonding;
    if (world.time < bonding.start - slack) continue;
    if (bonding.end > bonding.start) {
      if (step_ < nextSearch_ || world.time > bonding.end + slack) continue;
      searched = true;
    } else if (kind.made) {
      continue;
    }
    kind.made = true;
    make(world, k);
  }
  if (!searched) return;
  double fastest2 = 0, smallest = std::numeric_limits<double>::infinity();
  for (const GrainRow& row : world.state.rows) {
    fastest2 = std::max(fastest2, norm2(row.velocity()));
    smallest = std::min(smallest, row.radius);
  }
  const double way = 2 * std::sqrt(fastest2) * world.step.dt, steps = searchTravel * smallest / std::max(way, tiny);
  nextSearch_ = step_ + static_cast<std::uint64_t>(std::clamp(steps, 1.0, 1000.0));
}

void BondPass::make(const World& world, std::size_t number) {
  Kind& kind = kinds_[number];
  const Bonding& bonding = *kind.bonding;
  const State& state = world.state;
  const BondableGrains grains{state.rows, state.id, state.material, world.periods};
  BondColumns all;
  WallBonds walls;
  collect(kind, all, walls);
  const std::size_t before = all.size() + walls.foot.size();
  if (bonding.wall) {
    const Pose pose = world.model.walls[*bonding.wall].motion.at(world.time);
    for (const WallFoot& foot : bondableFeet(bonding, number, world.model.seed, grains, world.model.walls[*bonding.wall], pose)) {
      const auto g = static_cast<std::size_t>(foot.grain);
      if (!knownAtWalls_.insert((std::uint64_t{*bonding.wall} << 32) | state.id[g]).second) continue;
      const GrainRow& row = state.rows[g];
      const Vec3 d = positionOf(row) - foot.point;
      const BondInertia inertia{row.inverseMass, 2.5 * row.inverseMass * row.inverseRadius * row.inverseRadius};
      walls.add(foot.grain, pose.toLocal(foot.point), bodyOf(bonding, row.radius, d.norm(), inertia), {.rest = d.norm()});
    }
  } else {
    for (const BondedPair& pair : bondablePairs(bonding, number, world.model.seed, grains)) {
      const auto i = static_cast<std::size_t>(pair.i), j = static_cast<std::size_t>(pair.j);
      if (!known_.insert(keyOfPair(state.id[i], state.id[j])).second) continue;
      const GrainRow &a = state.rows[i], &b = state.rows[j];
      const Vec3 d = world.between(a, b);
      if (step_ > 0) silenced_ += world.contactEnergy(pair.i, pair.j);
      all.add(pair.i, pair.j, bodyOf(bonding, std::min(a.radius, b.radius), d.norm(), inertiaOf(a, b)), {.rest = d.norm()});
    }
  }
  const std::size_t made = all.size() + walls.foot.size() - before;
  holding_ += made;
  if (made > 0) settle(world, kind, all, walls);
}

}  // namespace tsubu::sim
