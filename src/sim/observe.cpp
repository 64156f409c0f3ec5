// What can be seen of a simulation: the ledger, a survey of contacts, snapshots, the fingerprint of the state.

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "core/hash.h"
#include "sim/laws/catalogue.h"
#include "sim/simulation_impl.h"

namespace tsubu::sim {

namespace {

std::vector<std::size_t> byId(const State& state) {
  std::vector<std::size_t> order(state.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return state.id[a] < state.id[b]; });
  return order;
}

}  // namespace

// The velocities that contacts see are those of the instant, and known also when the forces are not; half-step velocities are carried on
// in free fall.
double Simulation::Impl::energyOf(std::size_t grain) const {
  const GrainRow& row = state.rows[grain];
  const Vec3 v = Vec3(row.vx, row.vy, row.vz) + (scheme.behind - scheme.ahead) * model.timeStep * gravity.now();
  return (0.5 * v.squaredNorm() + 0.2 * norm2(row.surfaceSpin()) - gravity.now().dot(positionOf(row))) / row.inverseMass;
}

Ledger Simulation::Impl::ledgerNow() {
  computeForces();
  countCrossings();
  Ledger ledger;
  ledger.time = time();
  double mass = 0;
  Vec3 centre = Vec3::Zero();
  std::vector<Velocities> now(state.size());
  const std::vector<std::size_t> order = byId(state);
  for (const std::size_t g : order) {
    now[g] = velocitiesNow(state, g, gravity.now(), model.timeStep);
    const double m = state.mass(g);
    mass += m;
    centre += m * positionOf(state.rows[g]);
    ledger.momentum += m * now[g].v;
  }
  if (mass > 0) centre /= mass;
  const Vec3 bulk = mass > 0 ? Vec3(ledger.momentum / mass) : Vec3(Vec3::Zero());
  ledger.kineticBulk = 0.5 * mass * bulk.squaredNorm();
  ledger.angularMomentumBulk = centre.cross(ledger.momentum);
  for (const std::size_t g : order) {
    const double m = state.mass(g), r = state.rows[g].radius;
    const Vec3 x = positionOf(state.rows[g]);
    ledger.kineticFluctuation += 0.5 * m * (now[g].v - bulk).squaredNorm();
    ledger.kineticRotation += 0.2 * m * now[g].s.squaredNorm();
    ledger.gravitational -= m * gravity.now().dot(x);
    ledger.angularMomentumRest += m * (x - centre).cross(now[g].v - bulk) + (0.4 * m * r) * now[g].s;
  }

  // The accounts of this step run half a step beyond the present instant in velocity Verlet (memory lives at half steps).
  std::array<double, Accounts::kinds> step{};
  double work = 0;
  const double lead = stepOf().lead;
  for (const Accounts& accounts : last)
    for (int k = 0; k < Accounts::overlap; ++k) step[static_cast<std::size_t>(k)] += accounts.sum(static_cast<Accounts::Kind>(k));
  for (const SlabWalls& slab : walls.slabs()) work += slab.work - (1 - lead) * slab.lastWork;
  const auto dissipated = [&](Accounts::Kind kind) {
    const auto k = static_cast<std::size_t>(kind);
    return total[k] - (1 - lead) * step[k];
  };
  ledger.elasticNormal = step[Accounts::storedNormal];
  ledger.elasticTangential = step[Accounts::storedTangential];
  ledger.elasticRolling = step[Accounts::storedRolling];
  ledger.dissipatedNormal = dissipated(Accounts::normal);
  ledger.dissipatedTangential = dissipated(Accounts::tangential);
  ledger.dissipatedFriction = dissipated(Accounts::friction);
  ledger.dissipatedRolling = dissipated(Accounts::rolling);
  ledger.workWalls = work + impactWork;
  ledger.inserted = insertedEnergy;
  ledger.removed = removedEnergy;
  ledger.heat.inserted = insertedHeat;
  ledger.heat.removed = removedHeat;
  ledger.initial = initialEnergy;
  ledger.workFields = gravity.work() + wrapWork;
  for (const MovingWall& wall : moving) wall.account(model.timeStep, scheme, gravity.now(), ledger);
  for (const auto& pass : passes) pass->account(world(time(), model.timeStep), ledger);

  const Ledger& before = lastLedger;
  const double motion = ledger.mechanical() - ledger.gravitational - (before.mechanical() - before.gravitational);
  const double height =
      ledger.gravitational - before.gravitational - (ledger.inserted - before.inserted) + (ledger.removed - before.removed);
  turnover += std::max(
      {std::abs(motion), std::abs(height), std::abs(ledger.dissipated() - before.dissipated()), std::abs(ledger.work() - before.work())});
  ledger.turnover = turnover;
  lastLedger = ledger;
  return ledger;
}

std::vector<WallState> Simulation::Impl::movingWallsNow() {
  computeForces();
  std::vector<WallState> states;
  for (const MovingWall& wall : moving)
    states.push_back({model.walls[wall.wall()].name, wall.way(), wall.speedNow(model.timeStep, scheme), wall.load()});
  return states;
}

Simulation::Impl::DeepestContact Simulation::Impl::surveyContacts() const {
  DeepestContact deepest;
  const auto meet = [&](double overlap, std::size_t grain, const auto& nameOfPartner) {
    ++deepest.touching;
    if (overlap > deepest.overlap) deepest = {deepest.touching, overlap, grain, nameOfPartner()};
  };
  for (const SlabPairs& slab : pairs.slabs()) {
    for (std::size_t k = 0; k < slab.i.size(); ++k) {
      const auto i = static_cast<std::size_t>(slab.i[k]), j = static_cast<std::size_t>(slab.j[k]);
      const GrainRow &a = state.rows[i], &b = state.rows[j];
      const double overlap = slab.touchOf(k, a.radius + b.radius) - (positionOf(a) - positionOf(b)).norm();
      const auto partner = static_cast<std::size_t>(slab.grainOf(slab.j[k]));
      if (overlap > 0) meet(overlap / std::min(a.radius, b.radius), i, [&] { return fmt::format("grain {}", state.id[partner]); });
    }
  }
  WallContacts contacts;
  for (const SlabWalls& slab : walls.slabs()) {
    for (const WallGroup& group : slab.groups) {
      const GrainRow& row = state.rows[static_cast<std::size_t>(group.grain)];
      const Wall& wall = model.walls[group.wall];
      const std::span<const std::uint32_t> features = slab.featuresOf(group);
      wall.surface->contacts(walls.places()[group.wall].pose.toLocal(positionOf(row)), row.radius, features, contacts);
      for (const WallContact& contact : contacts)
        meet((row.radius - contact.distance) / row.radius, static_cast<std::size_t>(group.grain),
             [&] { return fmt::format("wall '{}'", wall.name); });
    }
  }
  return deepest;
}

ContactSummary Simulation::Impl::contactsNow() {
  computeForces();
  const DeepestContact deepest = surveyContacts();
  return {deepest.touching, deepest.overlap};
}

/// A contact as it is at the present instant, with what it remembers. Enough for normal forces and stored energies: they depend on
/// the present alone and can be had at any time without touching the memory.
struct Simulation::Impl::SeenContact {
  std::size_t i;
  std::size_t j;    ///< `noGrain` for a wall
  Contact contact;  ///< as far as normal laws and stored energies read it
  const double* constants;
  double weight;  ///< share of the law that acts
  double memory[mostMemory];
};

template <class Visit>
void Simulation::Impl::visitContacts(Visit&& visit) const {
  const std::size_t n = model.materials.size();
  const auto see = [](const Vec3& d, double radiusSum, const Vec3& dv, double mass, double radius) {
    Contact c{};
    const double distance = d.norm();
    const Vec3 normal = d / std::max(distance, tiny);
    c.n = {normal.x(), normal.y(), normal.z()};
    c.overlap = radiusSum - distance;
    c.separationSpeed = dv.dot(normal);
    c.effectiveMass = mass;
    c.rootMass = std::sqrt(c.effectiveMass);
    c.inverseEffectiveMass = 1 / mass;
    c.effectiveRadius = radius;
    c.inverseSpinInertia = 5 / (mass * radius * radius);
    return c;
  };
  const auto components = static_cast<std::size_t>(traits.stateSize);
  for (const SlabPairs& slab : pairs.slabs()) {
    for (std::size_t k = 0; k < slab.i.size(); ++k) {
      const auto i = static_cast<std::size_t>(slab.i[k]), j = static_cast<std::size_t>(slab.j[k]);
      const GrainRow &a = state.rows[i], &b = state.rows[j];
      SeenContact seen{i,
                       static_cast<std::size_t>(slab.grainOf(slab.j[k])),
                       see(positionOf(a) - positionOf(b), slab.touchOf(k, a.radius + b.radius), Vec3(a.vx - b.vx, a.vy - b.vy, a.vz - b.vz),
                           1 / (a.inverseMass + b.inverseMass), 1 / (a.inverseRadius + b.inverseRadius)),
                       constants.of(state.material[i] * n + state.material[j]),
                       1,
                       {}};
      if (!(seen.contact.overlap > 0)) continue;
      for (std::size_t c = 0; c < components; ++c) seen.memory[c] = slab.memory.at(c, k);
      visit(seen);
    }
  }
  WallContacts contacts;
  for (const SlabWalls& slab : walls.slabs()) {
    for (const WallGroup& group : slab.groups) {
      const auto g = static_cast<std::size_t>(group.grain);
      const GrainRow& row = state.rows[g];
      const WallPlace& place = walls.places()[group.wall];
      const std::span<const std::uint32_t> features = slab.featuresOf(group);
      model.walls[group.wall].surface->contacts(place.pose.toLocal(positionOf(row)), row.radius, features, contacts);
      const std::optional<WallBody>& body = model.walls[group.wall].body;
      const double mass = 1 / (row.inverseMass + (body ? 1 / body->mass : 0));
      for (const WallContact& contact : contacts) {
        const Vec3 velocity = place.twist.at(place.pose.toWorld(contact.point));
        SeenContact seen{g,
                         noGrain,
                         see(contact.distance * (place.pose.rotation * contact.normal), row.radius, Vec3(row.vx, row.vy, row.vz) - velocity,
                             mass, row.radius),
                         constants.of(state.material[g] * n + model.walls[group.wall].material),
                         contact.weight,
                         {}};
        const auto candidate = std::lower_bound(features.begin(), features.end(), contact.feature) - features.begin();
        std::copy_n(slab.memoryOf(group.first + static_cast<std::int32_t>(candidate)), components, seen.memory);
        visit(seen);
      }
    }
  }
}

double Simulation::Impl::contactEnergyOf(std::size_t i, std::size_t j) const {
  const GrainRow &a = state.rows[i], &b = state.rows[j];
  const Vec3 d = periods.nearest(positionOf(a) - positionOf(b));
  Contact contact{};
  contact.overlap = a.radius + b.radius - d.norm();
  if (!(contact.overlap > 0)) return 0;
  const Vec3 n = d.normalized();
  contact.n = {n.x(), n.y(), n.z()};
  contact.inverseEffectiveMass = a.inverseMass + b.inverseMass;
  contact.effectiveMass = 1 / contact.inverseEffectiveMass;
  contact.rootMass = std::sqrt(contact.effectiveMass);
  contact.effectiveRadius = 1 / (a.inverseRadius + b.inverseRadius);
  contact.inverseSpinInertia = 5 / (contact.effectiveMass * contact.effectiveRadius * contact.effectiveRadius);
  double memory[mostMemory] = {};
  pairs.copyMemory(slabs, static_cast<std::int32_t>(i), static_cast<std::int32_t>(j), memory);
  const LawFunctions& functions = lawFunctions(law);
  const double* const pair = constants.of(state.material[i] * model.materials.size() + state.material[j]);
  const double springs = functions.stored(pair, contact, stepOf(), memory);
  ContactEnergy now{};
  functions.evaluate(pair, contact, stepOf(), memory, now);
  return now.storedNormal + springs;
}

void Simulation::Impl::addLoads(std::vector<double>& load) const {
  const LawFunctions& functions = lawFunctions(law);
  visitContacts([&](SeenContact& seen) {
    ContactEnergy energy{};
    const ContactForce force = functions.evaluate(seen.constants, seen.contact, stepOf(), seen.memory, energy);
    const double normal = seen.weight * std::abs(dot(force.force, seen.contact.n));
    load[seen.i] += normal;
    if (seen.j != noGrain) load[seen.j] += normal;
  });
}

double Simulation::Impl::storedInContactsOf(const std::vector<char>& grains) const {
  const LawFunctions& functions = lawFunctions(law);
  double energy = 0;
  visitContacts([&](SeenContact& seen) {
    if (!grains[seen.i] && (seen.j == noGrain || !grains[seen.j])) return;
    const double springs = functions.stored(seen.constants, seen.contact, stepOf(), seen.memory);
    ContactEnergy now{};
    functions.evaluate(seen.constants, seen.contact, stepOf(), seen.memory, now);
    energy += seen.weight * (now.storedNormal + springs);
  });
  return energy;
}

void Simulation::Impl::fill(Snapshot& snapshot) {
  computeForces();
  countCrossings();
  snapshot = Snapshot{};
  snapshot.time = time();
  snapshot.step = steps;
  std::vector<double> load;
  if (model.load) {
    load.assign(state.size(), 0.0);
    addLoads(load);
  }
  for (const std::size_t g : byId(state)) {
    const GrainRow& row = state.rows[g];
    const Velocities now = velocitiesNow(state, g, gravity.now(), model.timeStep);
    snapshot.id.push_back(state.id[g]);
    snapshot.material.push_back(state.material[g]);
    snapshot.radius.push_back(row.radius);
    snapshot.position.push_back(periods.wrapped(positionOf(row)));
    snapshot.velocity.push_back(now.v);
    if (state.turns) snapshot.angularVelocity.push_back(now.s * row.inverseRadius);
    if (state.keepsOrientation) snapshot.orientation.push_back(orientationNow(state, g));
    if (model.heat) snapshot.temperature.push_back(state.temperature[g]);
    if (model.load) snapshot.load.push_back(load[g]);
  }
  for (const WallPlace& place : walls.places()) snapshot.walls.push_back(place.pose);
  for (const auto& pass : passes) pass->show(world(time(), model.timeStep), snapshot);
  if (model.showForces) showForces(snapshot);
}

// Contacts in any order: the hash of each, keyed by its two ids and seen from the lower one, added up.
std::uint64_t Simulation::Impl::contactHash() const {
  std::uint64_t sum = 0;
  const auto c = static_cast<std::size_t>(traits.stateSize);
  for (const SlabPairs& slab : pairs.slabs()) {
    for (std::size_t k = 0; k < slab.i.size() && c > 0; ++k) {
      std::uint64_t a = state.id[static_cast<std::size_t>(slab.i[k])], b = state.id[static_cast<std::size_t>(slab.grainOf(slab.j[k]))];
      const double sign = a < b ? 1 : -1;
      Hash hash;
      hash.add(std::min(a, b));
      hash.add(std::max(a, b));
      bool any = false;
      for (std::size_t component = 0; component < c; ++component) {
        const double value = slab.memory.at(component, k);
        any = any || value != 0;
        hash.add(value == 0 ? 0.0 : (traits.odd >> component & 1U) ? sign * value : value);
      }
      if (any) sum += hash.value();
    }
  }
  for (const SlabWalls& slab : walls.slabs()) {
    for (const WallGroup& group : slab.groups) {
      for (std::int32_t w = group.first; w < group.last; ++w) {
        const WallCandidate& candidate = slab.candidates[static_cast<std::size_t>(w)];
        if (!candidate.touching) continue;
        Hash hash;
        hash.add(std::uint64_t{state.id[static_cast<std::size_t>(group.grain)]});
        hash.add((std::uint64_t{group.wall} << 32) | candidate.feature);
        for (std::size_t component = 0; component < c; ++component) hash.add(slab.memoryOf(w)[component]);
        sum += hash.value();
      }
    }
  }
  return sum;
}

std::uint64_t Simulation::Impl::stateHash() {
  computeForces();
  Hash hash;
  for (const std::size_t g : byId(state)) {
    const GrainRow& row = state.rows[g];
    hash.add(std::uint64_t{state.id[g]});
    for (const double value : {row.x, row.y, row.z, row.vx, row.vy, row.vz, row.sx, row.sy, row.sz}) hash.add(value);
    if (!state.half.empty())
      for (const double value : {state.half[g].vx, state.half[g].vy, state.half[g].vz}) hash.add(value);
    if (!state.previous.empty())
      for (const double value : {state.previous[g].x, state.previous[g].y, state.previous[g].z}) hash.add(value);
    if (state.keepsOrientation) {
      const Quat orientation = orientationNow(state, g);
      for (const double value : orientation.coeffs()) hash.add(value);
    }
  }
  hash.add(contactHash());
  for (const MovingWall& wall : moving)
    for (const double value : {wall.way(), wall.speedSeen(), wall.load()}) hash.add(value);
  for (const auto& pass : passes) hash.add(pass->hash(state));
  return hash.value();
}

}  // namespace tsubu::sim
