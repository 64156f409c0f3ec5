#include "sim/diagnostics/instant.h"

#include <algorithm>
#include <numeric>

#include "core/error.h"
#include "sim/simulation_impl.h"

namespace tsubu::sim {

std::vector<std::int32_t> Simulation::Impl::ranks() const {
  std::vector<std::int32_t> order(state.size()), rank(state.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](std::int32_t a, std::int32_t b) { return state.id[static_cast<std::size_t>(a)] < state.id[static_cast<std::size_t>(b)]; });
  for (std::size_t k = 0; k < order.size(); ++k) rank[static_cast<std::size_t>(order[k])] = static_cast<std::int32_t>(k);
  return rank;
}

Instant Simulation::Impl::instantNow() {
  if (!model.contactForces) throw Error(ErrorKind::simulation, "This model does not note the forces of its contacts.");
  computeForces();
  Instant instant;
  instant.time = time();
  instant.periods = periods;
  const std::vector<std::int32_t> rank = ranks();
  std::vector<std::int32_t> order(state.size());
  for (std::size_t g = 0; g < state.size(); ++g) order[static_cast<std::size_t>(rank[g])] = static_cast<std::int32_t>(g);
  instant.grains.reserve(state.size());
  for (const std::int32_t place : order) {
    const auto g = static_cast<std::size_t>(place);
    const GrainRow& row = state.rows[g];
    const Velocities now = velocitiesNow(state, g, gravity.now(), model.timeStep);
    instant.grains.push_back({periods.wrapped(Vec3(row.x, row.y, row.z)), now.v, now.s * row.inverseRadius, row.radius, state.mass(g)});
  }
  for (std::size_t s = 0; s < acting.size(); ++s) {
    for (ActingContact contact : acting[s]) {
      contact.first = rank[static_cast<std::size_t>(contact.first)];
      if (!contact.withWall()) contact.second = rank[static_cast<std::size_t>(pairs.slabs()[s].grainOf(contact.second))];
      instant.contacts.push_back(contact);
    }
  }
  return instant;
}

void Simulation::Impl::showForces(Snapshot& snapshot) const {
  for (const std::vector<ActingContact>& slab : acting) {
    for (const ActingContact& contact : slab) {
      const GrainRow& row = state.rows[static_cast<std::size_t>(contact.first)];
      const Vec3 centre = periods.wrapped(Vec3(row.x, row.y, row.z));
      snapshot.forces.push_back({centre, centre - contact.branch, contact.normalForce()});
    }
  }
}

}  // namespace tsubu::sim
