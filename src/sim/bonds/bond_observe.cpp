// What bonds tell of themselves: energies, stiffness, pictures, fingerprint.

#include "core/hash.h"
#include "core/snapshot.h"
#include "sim/bonds/bond_pass.h"
#include "sim/bonds/bond_search.h"
#include "sim/network.h"
#include "sim/scheme.h"
#include "sim/simulation.h"

namespace tsubu::sim {

namespace {

V3 directionOf(const Vec3& branch, double length) { return {branch.x() / length, branch.y() / length, branch.z() / length}; }

}  // namespace

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

namespace {
double storedIn(const World& world, const BondKind& constants, const BondColumns& bonds, std::size_t k, const GrainRow& a,
                const GrainRow& b) {
  const Vec3 branch = world.between(a, b);
  const double r = branch.norm();
  const BondStrain strain = strainOf(bonds.memory(k), directionOf(branch, r), r);
  return springProduct(springsOf(constants, bonds.body(k)), strain, strain);
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
    const Vec3 branch = world.between(a, b);
    const double length = branch.norm();
    const BondBody body = bonds.body(k);
    const BondKind& c = kind.constants;
    const bool viscous = kind.bonding->damping == BondDamping::viscous, percent = kind.bonding->damping == BondDamping::percent;
    const BondSprings springs = springsOf(c, body);
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
    const Vec3 a = positionOf(first), b = a - world.between(first, second[static_cast<std::size_t>(bonds.j[k])]);
    const BondBody body = bonds.body(k);
    const double r = (a - b).norm();
    const BondPull pull = pullOf(springsOf(kind.constants, body), strainOf(bonds.memory(k), directionOf(a - b, r), r));
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
    const BondBody body = bonds.body(k);
    for (const double number : {body.radius, body.length, body.critical, body.bendCritical}) hash.add(number);
    sum += hash.value();
  });
  for (const Scar& scar : scars_) {
    Hash hash;
    hash.add(keyOfPair(state.id[static_cast<std::size_t>(scar.i)], state.id[static_cast<std::size_t>(scar.j)]));
    hash.add(scar.touch);
    sum += hash.value();
  }
  return sum + broken_;
}

}  // namespace tsubu::sim
