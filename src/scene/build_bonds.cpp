#include "scene/build_bonds.h"

#include <algorithm>
#include <cmath>

#include "core/portable_math.h"
#include "scene/pairs.h"

namespace tsubu::scene {

namespace {

sim::BondEnd endOf(const Scene& scene, const std::string& grains, const std::string& material, const std::vector<std::size_t>& first) {
  sim::BondEnd end;
  if (!material.empty()) end.material = static_cast<std::uint16_t>(materialIndex(scene, material));
  for (std::size_t s = 0; s < scene.grains.size(); ++s) {
    if (grains.empty() || scene.grains[s].name != grains) continue;
    end.firstId = static_cast<std::uint32_t>(first[s]);
    end.lastId = static_cast<std::uint32_t>(first[s + 1]);
  }
  return end;
}

std::array<double, sim::bondWays> byWay(const ByWay& way) {
  return {way.value, way.shear.value_or(way.value), way.torsion.value_or(way.value), way.bending.value_or(way.value)};
}

void setDamping(const Bonds& bonds, sim::Bonding& made) {
  if (const auto* percent = std::get_if<PercentDamper>(&bonds.damping)) {
    made.damping = sim::BondDamping::percent;
    made.dampingOf = byWay(percent->share);
  } else if (const auto* exponential = std::get_if<ExponentialDamper>(&bonds.damping)) {
    made.damping = sim::BondDamping::exponential;
    made.dampingOf = byWay(exponential->rate);
  } else if (const auto* viscous = std::get_if<ViscousDamper>(&bonds.damping)) {
    made.damping = sim::BondDamping::viscous;
    made.dampingOf = byWay(viscous->ratio);
  }
}

sim::BondStrength strengthOf(const BondStrength& given) {
  sim::BondStrength strength;
  strength.tension = given.tension.value_or(sim::BondStrength::never);
  if (given.compressionRatio) strength.compression = *given.compressionRatio * strength.tension;
  strength.shear = given.shear.value_or(sim::BondStrength::never);
  strength.pressureSlope = portable::tan(given.frictionAngle);
  strength.stretch = given.stretch.value_or(sim::BondStrength::never);
  return strength;
}

}  // namespace

std::vector<sim::Bonding> buildBonds(const Scene& scene, const std::vector<std::size_t>& firstOfSource) {
  std::vector<sim::Bonding> all;
  for (const Bonds& bonds : scene.bonds) {
    sim::Bonding made;
    made.name = bonds.name;
    made.first = endOf(scene, bonds.grains, bonds.material, firstOfSource);
    made.second = endOf(scene, bonds.withGrains.empty() ? bonds.grains : bonds.withGrains,
                        bonds.withMaterial.empty() ? bonds.material : bonds.withMaterial, firstOfSource);
    for (std::size_t w = 0; w < scene.walls.size(); ++w)
      if (!bonds.wall.empty() && scene.walls[w].name == bonds.wall) made.wall = static_cast<std::uint16_t>(w);
    made.distance = bonds.distance;
    made.radius = bonds.radius;
    if (const auto* modulus = std::get_if<YoungsModulus>(&bonds.stiffness))
      made.modulus = modulus->modulus;
    else
      made.stiffness = std::get<StiffnessPerArea>(bonds.stiffness).stiffness;
    made.stiffnessRatio = bonds.stiffnessRatio;
    made.strength = strengthOf(bonds.strength);
    setDamping(bonds, made);
    made.start = bonds.start;
    made.end = bonds.end.value_or(bonds.start);
    made.probability = bonds.probability;
    made.contactBeyondRest = bonds.contact == BondContact::beyondRest;
    all.push_back(std::move(made));
  }
  return all;
}

}  // namespace tsubu::scene
