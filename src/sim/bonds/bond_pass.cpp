#include "sim/bonds/bond_pass.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "core/error.h"
#include "core/hash.h"
#include "core/snapshot.h"
#include "sim/simulation.h"

namespace tsubu::sim {

namespace {

// While bonds are made all the time, pairs are looked for again when two grains may have come nearer by this share of the smallest radius.
constexpr double searchTravel = 0.01;

Vec3 positionOf(const GrainRow& row) { return {row.x, row.y, row.z}; }
/// x_a − x_b, across the boundary of a periodic domain when that is shorter.
Vec3 between(const World& world, const GrainRow& a, const GrainRow& b) { return world.periods.nearest(positionOf(a) - positionOf(b)); }
double distanceOf(const World& world, const GrainRow& a, const GrainRow& b) { return between(world, a, b).norm(); }

V3 directionOf(const Vec3& branch, double length) { return {branch.x() / length, branch.y() / length, branch.z() / length}; }

std::uint64_t keyOf(std::uint32_t a, std::uint32_t b) { return (std::uint64_t{std::min(a, b)} << 32) | std::max(a, b); }

}  // namespace

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

template <class Visit>
void BondPass::visit(const State& state, Visit&& visit) const {
  for (const Kind& kind : kinds_) {
    for (const SlabBonds& slab : kind.slabs) {
      for (std::size_t k = 0; k < slab.near.size(); ++k) visit(kind, slab.near, k, state.rows, false);
      for (std::size_t k = 0; k < slab.wall.rows.size(); ++k) visit(kind, slab.wall.bonds, k, slab.wall.rows, true);
    }
    for (std::size_t k = 0; k < kind.far.size(); ++k) visit(kind, kind.far, k, state.rows, false);
  }
}

void BondPass::regroup(const World& world, const std::vector<std::int32_t>& newPlace) {
  const auto moved = [&newPlace](std::int32_t place) { return newPlace[static_cast<std::size_t>(place)]; };
  for (Kind& kind : kinds_) {
    BondColumns all;
    WallBonds walls;
    const auto carry = [&](const BondColumns& bonds) {
      for (std::size_t k = 0; k < bonds.size(); ++k) {
        const std::int32_t i = moved(bonds.i[k]), j = moved(bonds.j[k]);
        if (i < 0 || j < 0) {
          --holding_;
          continue;
        }
        all.take(bonds, k);
        all.i.back() = i;
        all.j.back() = j;
      }
    };
    for (const SlabBonds& slab : kind.slabs) {
      carry(slab.near);
      walls.work.total += slab.wall.work.total;
      walls.work.last += slab.wall.work.last;
      for (std::size_t k = 0; k < slab.wall.bonds.size(); ++k) {
        const std::int32_t i = moved(slab.wall.bonds.i[k]);
        if (i < 0) {
          --holding_;
          continue;
        }
        walls.take(slab.wall, k);
        walls.bonds.i.back() = i;
      }
    }
    carry(kind.far);
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
    order[k] = {keyOf(static_cast<std::uint32_t>(all.i[k]), static_cast<std::uint32_t>(all.j[k])), k};
  std::sort(order.begin(), order.end());
  for (const auto& [key, k] : order) {
    const auto low = static_cast<std::int32_t>(key >> 32), high = static_cast<std::int32_t>(key & 0xffffffff);
    const int slab = world.slabs.of(low);
    const GrainRow &a = world.state.rows[static_cast<std::size_t>(low)], &b = world.state.rows[static_cast<std::size_t>(high)];
    const bool isNear = world.slabs.of(high) <= slab + 1 && (!world.periods.any() || between(world, a, b) == positionOf(a) - positionOf(b));
    (isNear ? slabs[static_cast<std::size_t>(slab)].near : far).take(all, k);
    const double sum = a.radius + b.radius;
    world.pairs.setTouch(world.slabs, low, high, touchOf(kind, all.at(BondColumns::rest, k), sum));
  }
  std::vector<std::size_t> wallOrder(walls.foot.size());
  std::iota(wallOrder.begin(), wallOrder.end(), std::size_t{0});
  std::stable_sort(wallOrder.begin(), wallOrder.end(), [&](std::size_t a, std::size_t b) { return walls.bonds.i[a] < walls.bonds.i[b]; });
  for (const std::size_t k : wallOrder) slabs[static_cast<std::size_t>(world.slabs.of(walls.bonds.i[k]))].wall.take(walls, k);
  if (kind.bonding->wall) {
    for (SlabBonds& slab : slabs) slab.wall.place(world.model.walls[*kind.bonding->wall].motion, world.state.rows, world.periods, world.time, world.way);
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
  for (int parity = 0; parity < 2; ++parity) {
    world.team.run((world.slabs.count() + 1 - parity) / 2, [&](int task, int thread) {
      BondStage& stage = stages_[static_cast<std::size_t>(thread)];
      for (Kind& kind : kinds_) {
        SlabBonds& slab = kind.slabs[static_cast<std::size_t>(2 * task + parity)];
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
    });
  }
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
    const Vec3 x = positionOf(first) - between(world, first, state.rows[j]);
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
    if (shown_) breaks_.push_back({positionOf(a), positionOf(a) - between(world, a, b), bonds.at(BondColumns::radius, k), world.time});
    if (&second != &world.state.rows) continue;
    const double sum = a.radius + b.radius, touched = touchOf(kind, bonds.at(BondColumns::rest, k), sum);
    const double touch = std::max(touched, std::min(distanceOf(world, a, b), sum));
    if (touch < sum) scars_.push_back({bonds.i[k], bonds.j[k], touch});
    world.pairs.setTouch(world.slabs, bonds.i[k], bonds.j[k], touch < sum ? touch : 0);
  }
}

void BondPass::carryScars(const World& world) {
  std::size_t kept = 0;
  for (Scar scar : scars_) {
    const GrainRow& a = world.state.rows[static_cast<std::size_t>(scar.i)];
    const GrainRow& b = world.state.rows[static_cast<std::size_t>(scar.j)];
    const double sum = a.radius + b.radius, distance = distanceOf(world, a, b);
    if (distance > scar.touch) {
      scar.touch = distance;
      world.pairs.setTouch(world.slabs, scar.i, scar.j, distance < sum ? distance : 0);
    }
    if (scar.touch < sum) scars_[kept++] = scar;
  }
  scars_.resize(kept);
}

// --- making -------------------------------------------------------------------------------------------------------------

void BondPass::makeDue(const World& world) {
  const double slack = 0.5 * world.step.dt;
  if (world.time > until_ + slack) {
    known_.clear();
    knownAtWalls_.clear();
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
  for (const SlabBonds& slab : kind.slabs) {
    for (std::size_t k = 0; k < slab.near.size(); ++k) all.take(slab.near, k);
    for (std::size_t k = 0; k < slab.wall.foot.size(); ++k) walls.take(slab.wall, k);
    walls.work.total += slab.wall.work.total;
    walls.work.last += slab.wall.work.last;
  }
  for (std::size_t k = 0; k < kind.far.size(); ++k) all.take(kind.far, k);
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
      if (!known_.insert(keyOf(state.id[i], state.id[j])).second) continue;
      const GrainRow &a = state.rows[i], &b = state.rows[j];
      const Vec3 d = between(world, a, b);
      if (step_ > 0) silenced_ += world.contactEnergy(pair.i, pair.j);
      all.add(pair.i, pair.j, bodyOf(bonding, std::min(a.radius, b.radius), d.norm(), inertiaOf(a, b)), {.rest = d.norm()});
    }
  }
  const std::size_t made = all.size() + walls.foot.size() - before;
  holding_ += made;
  if (made > 0) settle(world, kind, all, walls);
}

// --- accounts -----------------------------------------------------------------------------------------------------------

namespace {
double storedIn(const World& world, const BondKind& constants, const BondColumns& bonds, std::size_t k, const GrainRow& a,
                const GrainRow& b) {
  const Vec3 branch = between(world, a, b);
  const double r = branch.norm();
  const BondStrain strain = strainOf(bonds.memory(k), directionOf(branch, r), r);
  return springProduct(springsOf(bonds.body(k), constants.shearOverNormal), strain, strain);
}
}  // namespace

// Half of this step's kick belongs to the present instant where velocities live at half steps, none of it elsewhere; springs are of the
// instant.
void BondPass::account(const World& world, Ledger& ledger) const {
  const double share = schemeOf(world.model.integrator).behind;
  visit(world.state, [&](const Kind& kind, const BondColumns& bonds, std::size_t k, const std::vector<GrainRow>& second, bool) {
    ledger.elasticBonds += sim::storedIn(world, kind.constants, bonds, k, world.state.rows[static_cast<std::size_t>(bonds.i[k])],
                                         second[static_cast<std::size_t>(bonds.j[k])]);
  });
  ledger.dissipatedBonds += loss_.now(share) + relaxed_ + silenced_;
  ledger.dissipatedBreakage += released_;
  for (const Kind& kind : kinds_)
    for (const SlabBonds& slab : kind.slabs) ledger.workWalls += slab.wall.work.now(share);
}

double BondPass::storedIn(const World& world, const std::vector<char>& grains) const {
  double energy = 0;
  visit(world.state, [&](const Kind& kind, const BondColumns& bonds, std::size_t k, const std::vector<GrainRow>& second, bool wall) {
    const auto i = static_cast<std::size_t>(bonds.i[k]), j = static_cast<std::size_t>(bonds.j[k]);
    if (grains[i] || (!wall && grains[j])) energy += sim::storedIn(world, kind.constants, bonds, k, world.state.rows[i], second[j]);
  });
  return energy;
}

// B2, B6. Dampers of B4 take a share of the force at most: they count as springs that are stiffer by it.
void BondPass::addLinks(const World& world, std::vector<Link>& links) const {
  visit(world.state, [&](const Kind& kind, const BondColumns& bonds, std::size_t k, const std::vector<GrainRow>& second, bool wall) {
    const GrainRow &a = world.state.rows[static_cast<std::size_t>(bonds.i[k])], &b = second[static_cast<std::size_t>(bonds.j[k])];
    const Vec3 branch = between(world, a, b);
    const double length = branch.norm();
    const BondBody body = bonds.body(k);
    const BondKind& c = kind.constants;
    const bool viscous = kind.bonding->damping == BondDamping::viscous, percent = kind.bonding->damping == BondDamping::percent;
    const BondSprings springs = springsOf(body, c.shearOverNormal);
    const auto spring = [&](BondWay way, double stiffness, double critical) {
      return Link::Spring{stiffness * (percent ? 1 + c.eta[way] : 1), viscous ? c.eta[way] * critical : 0};
    };
    Link link{};
    link.first = bonds.i[k];
    link.second = wall ? -1 : bonds.j[k];
    link.normal = branch / length;
    link.firstLever = wall ? length : length * a.radius / (a.radius + b.radius);
    link.secondLever = length - link.firstLever;
    link.inverseMass = a.inverseMass + (wall ? 0 : b.inverseMass);
    link.along = spring(along, springs.along, body.critical);
    link.across = spring(across, springs.across, body.critical);
    link.rolling = spring(bending, springs.bend, body.bendCritical);
    link.twisting = spring(twisting, springs.twist, body.bendCritical);
    link.bond = true;
    links.push_back(link);
  });
}

void BondPass::count(Counts& counts) const {
  counts.bonds = holding_;
  counts.broken = broken_;
}

void BondPass::show(const World& world, Snapshot& snapshot) const {
  if (!shown_) return;
  visit(world.state, [&](const Kind& kind, const BondColumns& bonds, std::size_t k, const std::vector<GrainRow>& second, bool) {
    const GrainRow& first = world.state.rows[static_cast<std::size_t>(bonds.i[k])];
    const Vec3 a = positionOf(first), b = a - between(world, first, second[static_cast<std::size_t>(bonds.j[k])]);
    const BondBody body = bonds.body(k);
    const double r = (a - b).norm();
    const BondPull pull = pullOf(springsOf(body, kind.constants.shearOverNormal), strainOf(bonds.memory(k), directionOf(a - b, r), r));
    snapshot.bonds.push_back({a, b, body.radius, bondLoad(kind.constants.strength, body, pull, r), -1});
  });
  for (const Break& each : breaks_) snapshot.bonds.push_back({each.first, each.second, each.radius, 0, world.time - each.time});
}

// Bonds in any order: the hash of each, keyed by its ids, added up.
std::uint64_t BondPass::hash(const State& state) const {
  std::uint64_t sum = 0;
  visit(state, [&](const Kind& kind, const BondColumns& bonds, std::size_t k, const std::vector<GrainRow>&, bool wall) {
    Hash hash;
    hash.add(static_cast<std::uint64_t>(&kind - kinds_.data()));
    hash.add(std::uint64_t{state.id[static_cast<std::size_t>(bonds.i[k])]});
    hash.add(wall ? ~std::uint64_t{0} : std::uint64_t{state.id[static_cast<std::size_t>(bonds.j[k])]});
    for (const auto& column : bonds.column) hash.add(column[k]);
    sum += hash.value();
  });
  for (const Scar& scar : scars_) {
    Hash hash;
    hash.add(keyOf(state.id[static_cast<std::size_t>(scar.i)], state.id[static_cast<std::size_t>(scar.j)]));
    hash.add(scar.touch);
    sum += hash.value();
  }
  return sum + broken_;
}

}  // namespace tsubu::sim
