// What bonds say about grains, materials and walls.

#include <fmt/format.h>

#include <algorithm>

#include "core/names.h"
#include "scene/check.h"
#include "scene/pairs.h"

namespace tsubu::scene {

namespace {

template <class T>
std::vector<std::string> namesOf(const std::vector<T>& items) {
  std::vector<std::string> names;
  for (const T& item : items) names.push_back(item.name);
  return names;
}

}  // namespace

void checkBonds(const Scene& scene, const PositionOf& positionOf, Findings& findings) {
  const auto complain = [&](const Bonds& bonds, const std::string& key, std::string sentence, std::string hint = {}) {
    findings.errors.push_back({positionOf({"bonds", bonds.name, key}), std::move(sentence), std::move(hint)});
  };
  const auto named = [&](const Bonds& bonds, const std::string& key, const std::string& name, const std::string& what,
                         const std::vector<std::string>& known) {
    if (name.empty() || std::find(known.begin(), known.end(), name) != known.end()) return;
    const auto nearest = nearestName(name, known);
    complain(bonds, key, fmt::format("There is no {} '{}'.", what, name),
             nearest         ? fmt::format("did you mean '{}'?", *nearest)
             : known.empty() ? ""
                             : fmt::format("there is {}", listNames(known)));
  };
  const std::vector<std::string> sources = namesOf(scene.grains), materials = namesOf(scene.materials), walls = namesOf(scene.walls);
  for (const Bonds& bonds : scene.bonds) {
    named(bonds, "grains", bonds.grains, "source of grains", sources);
    named(bonds, "with_grains", bonds.withGrains, "source of grains", sources);
    named(bonds, "material", bonds.material, "material", materials);
    named(bonds, "with_material", bonds.withMaterial, "material", materials);
    named(bonds, "wall", bonds.wall, "wall", walls);
    for (const std::string& grains : {bonds.grains, bonds.withGrains}) {
      const auto source = std::find_if(scene.grains.begin(), scene.grains.end(), [&](const GrainSource& s) { return s.name == grains; });
      if (source != scene.grains.end() && std::holds_alternative<Inlet>(source->from))
        complain(bonds, grains == bonds.grains ? "grains" : "with_grains",
                 fmt::format("The grains of '{}' come in during the run and cannot be told apart by their source.", grains),
                 "give them a material of their own and write material");
    }
    if (!bonds.wall.empty() && (!bonds.withGrains.empty() || !bonds.withMaterial.empty()))
      complain(bonds, "wall", fmt::format("The bonds '{}' have a wall at the other end and grains as well.", bonds.name),
               "write two tables of bonds");
    const auto wall = std::find_if(scene.walls.begin(), scene.walls.end(), [&](const Wall& w) { return w.name == bonds.wall; });
    if (wall != scene.walls.end() && wall->body)
      complain(bonds, "wall", fmt::format("The wall '{}' moves under load and cannot hold bonds.", bonds.wall),
               "give it a motion, or none");
    if (bonds.end && !(*bonds.end > bonds.start))
      complain(bonds, "end", fmt::format("Bonds are made until {} s, before they begin at {} s.", *bonds.end, bonds.start),
               "leave 'end' out to make them once");
    const BondStrength& strength = bonds.strength;
    if (strength.compressionRatio && !strength.tension)
      complain(bonds, "strength", "A 'compression_ratio' needs a strength in 'tension'.", "it is a share of that");
    if (strength.frictionAngle > 0 && !strength.shear)
      complain(bonds, "strength", "A 'friction_angle' needs a strength in 'shear'.", "it adds to that");
  }
}

}  // namespace tsubu::scene
