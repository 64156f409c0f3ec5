#include <fmt/format.h>

#include <algorithm>

#include "scene/check.h"
#include "scene/pairs.h"

namespace tsubu::scene {

namespace {

class FieldCheck {
 public:
  FieldCheck(const Scene& scene, const PositionOf& positionOf, Findings& findings)
      : scene_(scene), positionOf_(positionOf), findings_(findings) {}

  void all() {
    for (const sim::GravityChange& change : scene_.fields.gravity) {
      if (change.start < change.end) continue;
      complain({"fields", "gravity"}, fmt::format("A change of gravity ends at {} s, before it starts at {} s.", change.end, change.start));
    }
    if (scene_.fields.drag) drag(*scene_.fields.drag);
    if (scene_.fields.damping) damping(*scene_.fields.damping);
    heat();
    magnets();
  }

 private:
  // Every material that takes part in the exchange of heat must say how well it conducts, and those of grains how much they hold.
  void heat() {
    const auto lacks = [&](std::size_t material, sim::Property property, std::string_view who) {
      if (material >= scene_.materials.size()) return;  // said by checkNames
      const Material& m = scene_.materials[material];
      if (m.properties[property]) return;
      complain({"materials", m.name}, fmt::format("Heat flows {} '{}', which has no {}.", who, m.name, sim::infoOf(property).key),
               property == sim::Property::conductivity ? "for instance conductivity = \"0.8 W/(m K)\""
                                                       : "for instance heat_capacity = \"800 J/(kg K)\"");
    };
    if (scene_.heat) {
      for (const std::size_t material : grainMaterials(scene_)) {
        lacks(material, sim::Property::conductivity, "through grains of");
        lacks(material, sim::Property::heatCapacity, "through grains of");
      }
      for (const Wall& wall : scene_.walls)
        if (wall.temperature) lacks(materialIndex(scene_, wall.material), sim::Property::conductivity, "from a wall of");
      return;
    }
    constexpr std::string_view none = "Heat is not modelled: the temperature has no effect.", hint = "write [heat]";
    for (const GrainSource& source : scene_.grains)
      if (source.temperature) complain({"grains", source.name, "temperature"}, std::string(none), std::string(hint));
    for (const Wall& wall : scene_.walls)
      if (wall.temperature) complain({"walls", wall.name, "temperature"}, std::string(none), std::string(hint));
    if (scene_.colours.by == render::ColourBy::temperature)
      complain({"colours", "by"}, "Heat is not modelled: there is no temperature to show.", std::string(hint));
  }

  void complain(const Path& path, std::string sentence, std::string hint = {}) {
    findings_.errors.push_back({positionOf_(path), std::move(sentence), std::move(hint)});
  }
  void warn(const Path& path, std::string sentence, std::string hint = {}) {
    findings_.warnings.push_back({positionOf_(path), std::move(sentence), std::move(hint)});
  }

  void magnets() {
    const auto isMagnetic = [&](std::size_t material) {
      const Properties& values = scene_.materials[material].properties;
      return values[sim::Property::magnetisation].value_or(0) != 0 || values[sim::Property::susceptibility].value_or(0) != 0;
    };
    const auto grains = grainMaterials(scene_);
    const bool any = std::any_of(grains.begin(), grains.end(), isMagnetic);
    if (scene_.magnets && !any) complain({"magnets"}, "No grain is magnetic.", "give its material a magnetisation or a susceptibility");
    if (!scene_.magnets) return;
    for (const FieldSource& source : scene_.magnets->sources) {
      if (source.wall.empty()) continue;
      const auto wall = std::find_if(scene_.walls.begin(), scene_.walls.end(), [&](const Wall& w) { return w.name == source.wall; });
      const Path path{"magnets", "sources", source.name, "wall"};
      if (wall == scene_.walls.end()) {
        complain(path, fmt::format("There is no wall '{}' that could carry the source '{}'.", source.wall, source.name), "see [walls]");
      } else if (wall->body) {
        complain(path, fmt::format("The wall '{}' moves under load: a source on it would pull at it unseen.", source.wall),
                 "let it move as it is told, or stand the source still");
      }
    }
  }

  void drag(const sim::Drag& d) {
    if (d.dragCoefficient > 0 && !(d.density > 0))
      complain({"fields", "drag", "drag_coefficient"}, "Quadratic drag needs the density of the fluid.",
               "for instance density = \"1.2 kg/m^3\"");
    else if (d.viscosity == 0 && d.coefficient == 0 && d.dragCoefficient == 0 && !(d.buoyancy && d.density > 0))
      complain({"fields", "drag"}, "A fluid without viscosity, coefficient, drag_coefficient or density does nothing.", "give one of them");
  }

  void damping(const sim::GlobalDamping& d) {
    if (d.force == 0 && d.torque == 0 && d.rate == 0)
      complain({"fields", "damping"}, "This damping does nothing.", "give force, torque or rate");
    if (d.torque > 0 && scene_.contact.tangential == "none")
      warn({"fields", "damping", "torque"}, "Without friction grains do not turn: the torque has no effect.", "see [contact]");
  }

  const Scene& scene_;
  const PositionOf& positionOf_;
  Findings& findings_;
};

}  // namespace

void checkFields(const Scene& scene, const PositionOf& positionOf, Findings& findings) { FieldCheck(scene, positionOf, findings).all(); }

}  // namespace tsubu::scene
