#pragma once
// Columns of grains that come to rest under their weight, and how far they creep from then on.

#include "verification/models.h"

namespace tsubu::sim::test {

struct Creep {
  std::uint64_t steps = 0;  ///< while it was watched
  double moved = 0;     ///< largest displacement of a grain while it was watched, in radii
  double deepest = 0;   ///< deepest overlap, in radii
  double kinetic = 0;   ///< energy left at the end over what was dissipated
  double residual = 0;  ///< of the ledger
};

/// `count` unequal grains with friction in a shaft `across` diameters wide; watched for `watched` s after `settling` s, or for so many steps
/// where that is more than a thousand.
inline Creep creepOfColumn(int count, int across, Integrator integrator, double settling, double watched) {
  const double r = 2e-3, step = 2.3 * r, stiffness = 1000;
  Scenario s;
  s.model.integrator = integrator;
  s.model.contact = {"linear", "spring", "elastic_plastic", false};
  s.model.gravity = {0, 0, -9.81};
  s.pair[Property::normalStiffness] = stiffness;
  s.pair[Property::restitution] = 0.2;
  s.pair[Property::friction] = 0.6;
  s.pair[Property::rollingFriction] = 0.1;
  Random random(8, 3);
  Material material;
  material.name = "bead";
  material.values[Property::density] = 2500;
  s.model.materials.push_back(material);
  for (int n = 0; n < count; ++n) {
    const int layer = across * across;
    Grain g;
    g.radius = r * random.uniform(0.85, 1);
    const double u = random.uniform(0, 0.2 * r), v = random.uniform(0, 0.2 * r);
    g.position = Vec3(step * (n % across) + u, step * (n % layer / across) + v, r + step * (n / layer));
    s.model.grains.push_back(g);
  }
  const double width = step * across;
  s.model.domain = Box(Vec3::Constant(-1), Vec3::Constant(3));
  s.plane({0, 0, 0}, {0, 0, 1});
  s.plane({-r, 0, 0}, {1, 0, 0});
  s.plane({width - r, 0, 0}, {-1, 0, 0});
  s.plane({0, -r, 0}, {0, 1, 0});
  s.plane({0, width - r, 0}, {0, -1, 0});
  const double limit = 2 / std::sqrt(8 * 2 * stiffness / (2500 * 4.0 / 3 * pi * std::pow(0.85 * r, 3)));
  Simulation sim = s.start(0.3 * limit);
  sim.advance(static_cast<std::uint64_t>(settling / sim.timeStep()));
  const Snapshot before = look(sim);
  Creep creep;
  creep.steps = static_cast<std::uint64_t>(watched > 1000 ? watched : watched / sim.timeStep());
  sim.advance(creep.steps);
  const Snapshot after = look(sim);
  for (std::size_t g = 0; g < before.grains(); ++g) {
    creep.moved = std::max(creep.moved, (after.position[g] - before.position[g]).norm() / r);
  }
  const Ledger ledger = sim.ledger();
  creep.deepest = sim.contacts().deepestOverlap;
  creep.kinetic = ledger.kinetic() / ledger.dissipated();
  creep.residual = ledger.residualFraction();
  return creep;
}

}  // namespace tsubu::sim::test
