#pragma once
// Columns of grains that come to rest under their weight or stand from the start, and how far they creep from then on.

#include <string_view>

#include "verification/models.h"

namespace tsubu::sim::test {

struct Creep {
  std::uint64_t steps = 0;  ///< while it was watched
  double moved = 0;         ///< largest displacement of a grain while it was watched, in radii
  double deepest = 0;       ///< deepest overlap, in radii
  double kinetic = 0;       ///< energy left at the end over what was dissipated
  double residual = 0;      ///< of the ledger
};

/// `count` unequal grains with friction in a shaft `across` diameters wide; watched for `watched` s after `settling` s, or for so many
/// steps where that is more than a thousand.
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

/// Grains one upon the other, each overlap that of the weight above it. Nothing holds them at the sides: on one vertical line no force has
/// a part across it, not even by rounding, so they do not buckle.
struct Stack {
  static constexpr double r = 1e-3, density = 2500, gravity = 9.81;
  static constexpr double deepest = 0.05 * r;  ///< m: overlap of the lowest two

  std::string_view law;  ///< "linear" or "hertz"
  int count;

  double mass() const { return density * (4.0 / 3 * pi * r * r * r); }
  double weight() const { return count * mass() * gravity; }
  /// F = c δ^p, c chosen so that `deepest` bears the weight of all; Hertz: c = 4/3 E* √R* (N6).
  double power() const { return law == "hertz" ? 1.5 : 1.0; }
  double young() const { return 2 * (0.75 * weight() / (std::sqrt(0.5 * r) * std::pow(deepest, 1.5))); }  // ν = 0: E* = E/2
  double overlap(double force) const { return deepest * std::pow(force / weight(), 1 / power()); }
  /// 1/s: √(dF/dδ/m) of the lowest contact, the hardest.
  double omega() const { return std::sqrt(power() * weight() / deepest / mass()); }

  /// \param heavier  by how much more than their weight the grains press on each other
  Simulation build(double heavier = 0) const {
    Scenario s;
    s.model.contact = {std::string(law), "none", "none", false};
    s.model.integrator = Integrator::velocityVerlet;
    s.model.gravity = {0, 0, -gravity};
    s.model.domain = Box(Vec3::Constant(-1), Vec3(1, 1, 1 + 2 * r * count));
    s.pair[Property::normalStiffness] = weight() / deepest;
    s.pair[Property::restitution] = 1;
    Material material;
    material.name = "bead";
    material.values[Property::density] = density;
    material.values[Property::youngModulus] = young();
    material.values[Property::poissonRatio] = 0;
    s.model.materials.push_back(material);
    // A wall has twice the R* of two grains.
    long double z = r - overlap(weight()) * (law == "hertz" ? std::pow(0.5, 1.0 / 3) : 1.0);
    for (int n = 0; n < count; ++n) {
      if (n > 0) z += 2 * r - static_cast<long double>(overlap((count - n) * mass() * gravity * (1 + heavier)));
      Grain g;
      g.radius = r;
      g.position = Vec3(0, 0, static_cast<double>(z));
      s.model.grains.push_back(g);
    }
    s.plane({0, 0, 0}, {0, 0, 1});
    return s.start(0.2 / omega());
  }
};

/// Displacements that rounding brings forth: every step rounds every place anew, to `ulp` at most, so they grow as the root of the number
/// of steps and not with it. Three times that, for the largest of so many grains.
inline double roundedAway(double ulp, std::uint64_t steps) { return 3 * ulp * std::sqrt(static_cast<double>(steps)); }

struct Standing {
  double waves = 0;     ///< how often a wave could go up or down meanwhile
  double ulp = 0;       ///< m: to which the place of the topmost grain is rounded
  double moved = 0;     ///< m: largest displacement of a grain
  double aside = 0;     ///< m: across
  double fastest = 0;   ///< m/s
  double residual = 0;  ///< of the ledger, over gravitational and elastic energy
};

/// \param heavier  see Stack::build
inline Standing watch(const Stack& stack, std::uint64_t steps, double heavier = 0) {
  Simulation sim = stack.build(heavier);
  const Snapshot before = look(sim);
  Standing seen;
  double travel = 0;
  for (int n = 1; n <= stack.count; ++n) {
    const double force = stack.weight() * n / stack.count;
    travel += std::sqrt(stack.mass() * stack.overlap(force) / (stack.power() * force));  // √(m/k) from grain to grain
  }
  seen.waves = static_cast<double>(steps) * sim.timeStep() / travel;
  const double top = before.position.back().z();
  seen.ulp = std::nextafter(top, 2 * top) - top;
  for (int part = 0; part < 50; ++part) {
    sim.advance(steps / 50);
    const Snapshot now = look(sim);
    for (std::size_t g = 0; g < now.grains(); ++g) {
      const Vec3 d = now.position[g] - before.position[g];
      seen.moved = std::max(seen.moved, d.norm());
      seen.aside = std::max(seen.aside, std::hypot(d.x(), d.y()));
      seen.fastest = std::max(seen.fastest, now.velocity[g].norm());
    }
    const Ledger ledger = sim.ledger();
    seen.residual = std::max(seen.residual, std::abs(ledger.residual()) / ledger.mechanical());
  }
  return seen;
}

}  // namespace tsubu::sim::test
