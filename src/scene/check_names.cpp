#include <fmt/format.h>

#include <filesystem>

#include "core/names.h"
#include "scene/check.h"
#include "scene/pairs.h"

namespace tsubu::scene {

namespace {

std::vector<std::string> materialNames(const Scene& scene) {
  std::vector<std::string> names;
  for (const Material& material : scene.materials) names.push_back(material.name);
  return names;
}

std::string hintFor(const std::string& name, const std::vector<std::string>& known) {
  if (const auto nearest = nearestName(name, known)) return fmt::format("did you mean '{}'?", *nearest);
  return known.empty() ? std::string() : fmt::format("there is {}", listNames(known));
}

class NameCheck {
 public:
  NameCheck(const Scene& scene, const PositionOf& positionOf, Findings& findings)
      : scene_(scene), positionOf_(positionOf), findings_(findings), names_(materialNames(scene)) {}

  void material(const Path& owner, const std::string& name, bool mayBeAbsent) {
    if (scene_.materials.empty() || materialIndex(scene_, name) != noMaterial || (name.empty() && mayBeAbsent)) return;
    if (name.empty()) {
      complain(owner, fmt::format("'{}.{}' does not say its material.", owner[0], owner[1]), fmt::format("there is {}", listNames(names_)));
    } else {
      Path path = owner;
      path.push_back("material");
      complain(path, fmt::format("There is no material '{}'.", name), hintFor(name, names_));
    }
  }

  void pair(const Pair& pair) {
    for (const std::string& name : {pair.first, pair.second}) {
      if (materialIndex(scene_, name) != noMaterial) continue;
      complain({"pairs", pair.first, pair.second}, fmt::format("There is no material '{}'.", name), hintFor(name, names_));
    }
  }

  void file(const Path& path, const std::string& what, const std::string& file) {
    std::error_code ignored;
    const std::string place = resolved(scene_, file);
    if (std::filesystem::is_regular_file(place, ignored)) return;
    findings_.missingFiles.push_back(
        {positionOf_(path), fmt::format("There is no {} '{}'.", what, place), "paths start at the folder of the scene"});
  }

  void complain(const Path& path, std::string sentence, std::string hint = {}) {
    findings_.errors.push_back({positionOf_(path), std::move(sentence), std::move(hint)});
  }

 private:
  const Scene& scene_;
  const PositionOf& positionOf_;
  Findings& findings_;
  std::vector<std::string> names_;
};

}  // namespace

void checkNames(const Scene& scene, const PositionOf& positionOf, Findings& findings) {
  NameCheck check(scene, positionOf, findings);
  if (scene.materials.empty()) check.complain({"materials"}, "The scene has no material.", "write [materials.glass] with a density");
  if (scene.grains.empty()) check.complain({"grains"}, "The scene has no grains.", "write [grains.bed] with a source");
  for (const Material& material : scene.materials) {
    if (material.name.empty()) check.complain({"materials", ""}, "A material has no name.");
    for (const sim::PropertyInfo& info : sim::propertyTable()) {
      if (material.name == info.key) {
        check.complain({"materials", material.name}, fmt::format("A material cannot be called '{}'.", material.name),
                       "it is the key of a property");
      }
    }
  }
  for (const GrainSource& source : scene.grains) {
    const auto* from = std::get_if<FromFile>(&source.from);
    check.material({"grains", source.name}, source.material, from != nullptr);
    if (from) check.file({"grains", source.name, "file"}, "file of grains", from->file);
  }
  for (const Wall& wall : scene.walls) {
    check.material({"walls", wall.name}, wall.material, false);
    if (const auto* mesh = std::get_if<MeshShape>(&wall.shape)) check.file({"walls", wall.name, "mesh"}, "mesh", mesh->file);
  }
  for (std::size_t i = 0; i < scene.pairs.special.size(); ++i) {
    const Pair& pair = scene.pairs.special[i];
    check.pair(pair);
    for (std::size_t j = 0; j < i; ++j) {
      if (scene.pairs.special[j].first == pair.second && scene.pairs.special[j].second == pair.first) {
        check.complain({"pairs", pair.first, pair.second},
                       fmt::format("The pair of {} and {} is described twice, in both orders.", pair.first, pair.second));
      }
    }
  }
}

}  // namespace tsubu::scene
