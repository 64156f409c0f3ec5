#include "scene/pairs.h"

#include <algorithm>

#include "sim/laws/catalogue.h"

namespace tsubu::scene {

std::size_t materialIndex(const Scene& scene, const std::string& name) {
  if (name.empty() && scene.materials.size() == 1) return 0;
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    if (scene.materials[i].name == name) return i;
  }
  return noMaterial;
}

std::set<std::size_t> grainMaterials(const Scene& scene) {
  std::set<std::size_t> used;
  for (const GrainSource& source : scene.grains) {
    const std::size_t index = materialIndex(scene, source.material);
    if (index != noMaterial) {
      used.insert(index);
    } else if (std::holds_alternative<FromFile>(source.from)) {  // the file says: it may name any
      for (std::size_t i = 0; i < scene.materials.size(); ++i) used.insert(i);
    }
  }
  return used;
}

std::set<std::size_t> wallMaterials(const Scene& scene) {
  std::set<std::size_t> used;
  for (const Wall& wall : scene.walls) {
    const std::size_t index = materialIndex(scene, wall.material);
    if (index != noMaterial) used.insert(index);
  }
  return used;
}

std::vector<std::pair<std::size_t, std::size_t>> touchingPairs(const Scene& scene) {
  const std::set<std::size_t> grains = grainMaterials(scene), walls = wallMaterials(scene);
  std::set<std::pair<std::size_t, std::size_t>> pairs;
  for (const std::size_t a : grains) {
    for (const std::size_t b : grains) pairs.insert(std::minmax(a, b));
    for (const std::size_t b : walls) pairs.insert(std::minmax(a, b));
  }
  return {pairs.begin(), pairs.end()};
}

Properties pairProperties(const Scene& scene, std::size_t a, std::size_t b) {
  Properties result = scene.pairs.all;
  for (const Pair& pair : scene.pairs.special) {
    const std::size_t first = materialIndex(scene, pair.first), second = materialIndex(scene, pair.second);
    if (std::minmax(first, second) != std::minmax(a, b)) continue;
    for (std::size_t p = 0; p < sim::propertyCount; ++p) {
      if (pair.properties.values[p]) result.values[p] = pair.properties.values[p];
    }
    for (const sim::Reading& reading : sim::readings(scene.contact)) {
      const sim::Need& need = reading.need;
      if (need.property == need.alternative) continue;
      if (pair.properties[need.property] && !pair.properties[need.alternative]) result[need.alternative].reset();
      if (pair.properties[need.alternative] && !pair.properties[need.property]) result[need.property].reset();
    }
  }
  return result;
}

}  // namespace tsubu::scene
