#pragma once
// Models in a few lines, for scenes whose answer is a formula.

#include <cmath>
#include <memory>
#include <numbers>
#include <string>

#include "core/mesh.h"
#include "core/random.h"
#include "sim/laws/damping_from_restitution.h"
#include "sim/simulation.h"

namespace tsubu::sim::test {

inline constexpr double pi = std::numbers::pi;

/// Three numbers in [−size, size].
inline Vec3 randomVec(Random& random, double size) {
  const double x = random.uniform(-size, size), y = random.uniform(-size, size), z = random.uniform(-size, size);
  return {x, y, z};
}

/// A model of grains with masses and radii of one's choice. Every grain is of a material of its own, and all pairs are alike.
class Scenario {
 public:
  Model model;
  PropertyValues pair;

  Scenario() {
    model.contact = {"linear", "none", "none", false};
    model.watch.overlapLimit = 0.5;
  }

  /// Returns the id. The radius in m, the mass in kg.
  std::uint32_t grain(double mass, double radius, const Vec3& position, const Vec3& velocity = Vec3::Zero(),
                      const Vec3& spin = Vec3::Zero()) {
    Material material;
    material.name = "m" + std::to_string(model.materials.size());
    material.values[Property::density] = mass / (4.0 / 3.0 * pi * radius * radius * radius);
    Grain g;
    g.position = position;
    g.velocity = velocity;
    g.angularVelocity = spin;
    g.radius = radius;
    g.material = static_cast<std::uint16_t>(model.materials.size());
    model.materials.push_back(material);
    model.grains.push_back(g);
    return static_cast<std::uint32_t>(model.grains.size() - 1);
  }

  Wall& wall(Surface surface, WallMotion motion = {}) {
    Wall w;
    w.name = surface.name();
    w.surface = std::make_shared<const Surface>(std::move(surface));
    w.motion = std::move(motion);
    model.walls.push_back(w);
    return model.walls.back();
  }
  Wall& plane(const Vec3& point, const Vec3& normal, WallMotion motion = {}) {
    return wall(Surface::plane("plane" + std::to_string(model.walls.size()), point, normal), std::move(motion));
  }

  Simulation start(double timeStep, int threads = 1) {
    Model m = model;
    if (m.materials.empty()) m.materials.push_back({"none", {}});
    m.pairs = PairTable(m.materials.size());
    for (std::size_t a = 0; a < m.materials.size(); ++a)
      for (std::size_t b = a; b < m.materials.size(); ++b) m.pairs.set(a, b, pair);
    m.timeStep = timeStep;
    return Simulation(std::move(m), threads);
  }
};

inline Snapshot look(Simulation& simulation) {
  Snapshot snapshot;
  simulation.fill(snapshot);
  return snapshot;
}

/// How long a linear contact lasts that starts with overlap 0, s: half a period with tension, until the force is gone without.
inline double contactDuration(double stiffness, double effectiveMass, double restitution, bool tension) {
  const double omega = std::sqrt(stiffness / effectiveMass);
  const double zeta = dampingRatio(restitution, tension);
  if (tension) return pi / (omega * std::sqrt(1 - zeta * zeta));
  if (zeta == 0) return pi / omega;
  return -std::log(restitution) / (zeta * omega);  // e = exp(−ζωt_c): Schwager & Pöschel 2007
}

}  // namespace tsubu::sim::test
