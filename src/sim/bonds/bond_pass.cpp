#include "sim/bonds/bond_pass.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "core/error.h"
#include "sim/bonds/bond_search.h"

namespace tsubu::sim {

BondPass::BondPass(const Model& model) : shown_(model.showBonds) {
  for (const Bonding& bonding : model.bonds) {
    if (bonding.wall && model.walls[*bonding.wall].body)
      throw Error(ErrorKind::scene,
                  fmt::format("The bonds '{}' cannot hold on to the wall '{}', which moves under load.", bonding.name,
                              model.walls[*bonding.wall].name),
                  "give the wall a motion instead, or none");
    Kind kind;
    kind.bonding = &bonding;
    kind.constants = kindOf(bonding);
    kind.kernel = kernels().bonds({bonding.damping, bonding.strength.breakable(), model.ledger});
    kinds_.push_back(std::move(kind));
    until_ = std::max({until_, bonding.start, bonding.end});
  }
}

// Takes all bonds of a kind off their slabs, and what walls have done.
void BondPass::collect(const Kind& kind, BondColumns& all, WallBonds& walls) {
  for (const SlabBonds& slab : kind.slabs) {
    for (std::size_t k = 0; k < slab.near.size(); ++k) all.take(slab.near, k);
    for (std::size_t k = 0; k < slab.wall.foot.size(); ++k) walls.take(slab.wall, k);
    walls.work.total += slab.wall.work.total;
    walls.work.last += slab.wall.work.last;
  }
  for (std::size_t k = 0; k < kind.far.size(); ++k) all.take(kind.far, k);
}

void BondPass::regroup(const World& world, const std::vector<std::int32_t>& newPlace) {
  const auto moved = [&newPlace](std::int32_t place) { return newPlace[static_cast<std::size_t>(place)]; };
  for (Kind& kind : kinds_) {
    BondColumns all;
    WallBonds walls;
    collect(kind, all, walls);
    std::vector<char> gone(all.size()), goneAtWalls(walls.foot.size());
    for (std::size_t k = 0; k < gone.size(); ++k) {
      all.i[k] = moved(all.i[k]);
      all.j[k] = moved(all.j[k]);
      gone[k] = all.i[k] < 0 || all.j[k] < 0;
    }
    for (std::size_t k = 0; k < goneAtWalls.size(); ++k) {
      walls.bonds.i[k] = moved(walls.bonds.i[k]);
      goneAtWalls[k] = walls.bonds.i[k] < 0;
    }
    all.drop(gone);
    walls.drop(goneAtWalls);
    holding_ -= gone.size() - all.size() + goneAtWalls.size() - walls.foot.size();
    settle(world, kind, all, walls);
  }
  std::size_t kept = 0;
  for (Scar scar : scars_) {
    scar.i = moved(scar.i);
    scar.j = moved(scar.j);
    if (scar.i < 0 || scar.j < 0) continue;
    world.pairs.setTouch(world.slabs, scar.i, scar.j, scar.touch);
    scars_[kept++] = scar;
  }
  scars_.resize(kept);
  if (step_ == 0) makeDue(world);
}

// Lays the bonds of a kind along the slabs, in the order of their places, and says how bonded pairs touch.
void BondPass::settle(const World& world, Kind& kind, BondColumns& all, WallBonds& walls) {
  const auto count = static_cast<std::size_t>(world.slabs.count());
  std::vector<SlabBonds> slabs(count);
  BondColumns far;
  // By places, lower and higher: numbers that compare at once.
  std::vector<std::pair<std::uint64_t, std::size_t>> order(all.size());
  for (std::size_t k = 0; k < all.size(); ++k)
    order[k] = {keyOfPair(static_cast<std::uint32_t>(all.i[k]), static_cast<std::uint32_t>(all.j[k])), k};
  std::sort(order.begin(), order.end());
  for (const auto& [key, k] : order) {
    const auto low = static_cast<std::int32_t>(key >> 32), high = static_cast<std::int32_t>(key & 0xffffffff);
    const int slab = world.slabs.of(low);
    const GrainRow &a = world.state.rows[static_cast<std::size_t>(low)], &b = world.state.rows[static_cast<std::size_t>(high)];
    const bool isNear = world.slabs.of(high) <= slab + 1 && (!world.periods.any() || world.between(a, b) == positionOf(a) - positionOf(b));
    (isNear ? slabs[static_cast<std::size_t>(slab)].near : far).take(all, k);
    const double sum = a.radius + b.radius;
    world.pairs.setTouch(world.slabs, low, high, touchOf(kind, all.at(BondColumns::rest, k), sum));
  }
  std::vector<std::size_t> wallOrder(walls.foot.size());
  std::iota(wallOrder.begin(), wallOrder.end(), std::size_t{0});
  std::stable_sort(wallOrder.begin(), wallOrder.end(), [&](std::size_t a, std::size_t b) { return walls.bonds.i[a] < walls.bonds.i[b]; });
  for (const std::size_t k : wallOrder) slabs[static_cast<std::size_t>(world.slabs.of(walls.bonds.i[k]))].wall.take(walls, k);
  if (kind.bonding->wall) {
    for (SlabBonds& slab : slabs)
      slab.wall.place(world.model.walls[*kind.bonding->wall].motion, world.state.rows, world.periods, world.time, world.way);
    slabs.front().wall.work = walls.work;
  }
  kind.slabs = std::move(slabs);
  kind.far = std::move(far);
}

double BondPass::touchOf(const Kind& kind, double rest, double radiusSum) const {
  return kind.bonding->contactBeyondRest ? std::min(rest, radiusSum) : -1;
}

// Bonds of the start are made with the first lists, before anything has touched, and are not strained yet at the first instant.
void BondPass::addForces(const World& world) {
  if (step_ > 0) {
    evaluate(world);
    letGo(world);
    carryScars(world);
    makeDue(world);
  }
  ++step_;
}

void BondPass::evaluate(const World& world) {
  State& state = world.state;
  const double dt = world.way;
  stages_.resize(static_cast<std::size_t>(world.team.threads()));
  const BondRows grains{state.rows.data(), !state.half.empty() ? state.half.data() : nullptr, state.forces.data()};
  const auto evaluate = [&](int s, int thread) {
    BondStage& stage = stages_[static_cast<std::size_t>(thread)];
    for (Kind& kind : kinds_) {
      SlabBonds& slab = kind.slabs[static_cast<std::size_t>(s)];
      slab.found = slab.foundAtWall = {};
      kind.kernel(kind.constants, slab.near, grains, grains, dt, stage, slab.found);
      WallBonds& wall = slab.wall;
      if (wall.foot.empty()) {
        wall.work.add(0);
        continue;
      }
      wall.place(world.model.walls[*kind.bonding->wall].motion, state.rows, world.periods, world.time, dt);
      const BondRows feet{wall.rows.data(), !state.half.empty() ? wall.half.data() : nullptr, wall.forces.data()};
      if (state.half.empty())  // the rows of the other schemes have the velocities of the half step
        for (std::size_t k = 0; k < wall.rows.size(); ++k) {
          std::copy_n(&wall.half[k].vx, 3, &wall.rows[k].vx);
          std::copy_n(&wall.half[k].sx, 3, &wall.rows[k].sx);
        }
      kind.kernel(kind.constants, wall.bonds, grains, feet, dt, stage, slab.foundAtWall);
      wall.addWork(dt);
    }
  };
  overSlabs(world.order, world.team, evaluate, [](int, int) {});
  double loss = 0;
  for (Kind& kind : kinds_) {
    kind.foundFar = {};
    if (world.periods.any())
      evaluateAcross(world, kind, grains);
    else
      kind.kernel(kind.constants, kind.far, grains, grains, dt, stages_.front(), kind.foundFar);
    const auto add = [&](const BondFindings& found) {
      loss += BondFindings::sum(found.loss);
      relaxed_ += BondFindings::sum(found.relaxed);
    };
    for (const SlabBonds& slab : kind.slabs) {
      add(slab.found);
      add(slab.foundAtWall);
    }
    add(kind.foundFar);
  }
  loss_.add(loss);
}

// The second grain of each bond is replaced by its nearest image, and what acts on that is handed to it.
void BondPass::evaluateAcross(const World& world, Kind& kind, const BondRows& grains) {
  BondColumns& bonds = kind.far;
  State& state = world.state;
  std::vector<std::int32_t> owners(bonds.size());
  std::iota(owners.begin(), owners.end(), 0);
  std::swap(owners, bonds.j);
  std::vector<GrainRow> rows;
  std::vector<HalfStepRow> half;
  std::vector<ForceRow> forces(owners.size());
  for (std::size_t k = 0; k < owners.size(); ++k) {
    const auto j = static_cast<std::size_t>(owners[k]);
    const GrainRow& first = state.rows[static_cast<std::size_t>(bonds.i[k])];
    const Vec3 x = positionOf(first) - world.between(first, state.rows[j]);
    rows.push_back(state.rows[j]);
    rows.back().x = x.x(), rows.back().y = x.y(), rows.back().z = x.z();
    if (!state.half.empty()) half.push_back(state.half[j]);
  }
  kind.kernel(kind.constants, bonds, grains, {rows.data(), !state.half.empty() ? half.data() : nullptr, forces.data()}, world.way,
              stages_.front(), kind.foundFar);
  std::swap(owners, bonds.j);
  for (std::size_t k = 0; k < bonds.size(); ++k) {
    ForceRow& to = state.forces[static_cast<std::size_t>(bonds.j[k])];
    const ForceRow& from = forces[k];
    to.fx += from.fx, to.fy += from.fy, to.fz += from.fz;
    to.qx += from.qx, to.qy += from.qy, to.qz += from.qz;
  }
}

void BondPass::letGo(const World& world) {
  const auto marks = [](const BondColumns& bonds, const BondFindings& found) {
    std::vector<char> marked(bonds.size(), 0);
    for (const std::int32_t k : found.broken) marked[static_cast<std::size_t>(k)] = 1;
    return marked;
  };
  if (!breaks_.empty() && breaks_.front().time + *shown_ < world.time)
    std::erase_if(breaks_, [&](const Break& old) { return old.time + *shown_ < world.time; });
  for (Kind& kind : kinds_) {
    for (SlabBonds& slab : kind.slabs) {
      if (!slab.found.broken.empty()) {
        letGo(world, kind, slab.near, world.state.rows, slab.found);
        slab.near.drop(marks(slab.near, slab.found));
      }
      if (!slab.foundAtWall.broken.empty()) {
        letGo(world, kind, slab.wall.bonds, slab.wall.rows, slab.foundAtWall);
        slab.wall.drop(marks(slab.wall.bonds, slab.foundAtWall));
        slab.wall.place(world.model.walls[*kind.bonding->wall].motion, world.state.rows, world.periods, world.time, world.way);
      }
    }
    if (!kind.foundFar.broken.empty()) {
      letGo(world, kind, kind.far, world.state.rows, kind.foundFar);
      kind.far.drop(marks(kind.far, kind.foundFar));
    }
  }
}

void BondPass::letGo(const World& world, const Kind& kind, const BondColumns& bonds, const std::vector<GrainRow>& second,
                     BondFindings& found) {
  holding_ -= found.broken.size();
  broken_ += found.broken.size();
  released_ += found.released;
  for (const std::int32_t broken : found.broken) {
    const auto k = static_cast<std::size_t>(broken);
    const GrainRow& a = world.state.rows[static_cast<std::size_t>(bonds.i[k])];
    const GrainRow& b = second[static_cast<std::size_t>(bonds.j[k])];
    if (shown_) breaks_.push_back({positionOf(a), positionOf(a) - world.between(a, b), bonds.radius[k], world.time});
    if (&second != &world.state.rows) continue;
    const double sum = a.radius + b.radius, touched = touchOf(kind, bonds.at(BondColumns::rest, k), sum);
    const double touch = std::max(touched, std::min(world.between(a, b).norm(), sum));
    if (touch < sum) scars_.push_back({bonds.i[k], bonds.j[k], touch});
    world.pairs.setTouch(world.slabs, bonds.i[k], bonds.j[k], touch < sum ? touch : 0);
  }
}

void BondPass::carryScars(const World& world) {
  std::size_t kept = 0;
  for (Scar scar : scars_) {
    const GrainRow& a = world.state.rows[static_cast<std::size_t>(scar.i)];
    const GrainRow& b = world.state.rows[static_cast<std::size_t>(scar.j)];
    const double sum = a.radius + b.radius, distance = world.between(a, b).norm();
    if (distance > scar.touch) {
      scar.touch = distance;
      world.pairs.setTouch(world.slabs, scar.i, scar.j, distance < sum ? distance : 0);
    }
    if (scar.touch < sum) scars_[kept++] = scar;
  }
  scars_.resize(kept);
}

}  // namespace tsubu::sim
