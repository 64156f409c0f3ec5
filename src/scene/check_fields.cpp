#include <fmt/format.h>

#include "scene/check.h"

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
  }

 private:
  void complain(const Path& path, std::string sentence, std::string hint = {}) {
    findings_.errors.push_back({positionOf_(path), std::move(sentence), std::move(hint)});
  }
  void warn(const Path& path, std::string sentence, std::string hint = {}) {
    findings_.warnings.push_back({positionOf_(path), std::move(sentence), std::move(hint)});
  }

  void drag(const sim::Drag& d) {
    if (d.dragCoefficient > 0 && !(d.density > 0))
      complain({"fields", "drag", "drag_coefficient"}, "Quadratic drag needs the density of the fluid.", "for instance density = \"1.2 kg/m^3\"");
    else if (d.viscosity == 0 && d.coefficient == 0 && d.dragCoefficient == 0 && !(d.buoyancy && d.density > 0))
      complain({"fields", "drag"}, "A fluid without viscosity, coefficient, drag_coefficient or density does nothing.", "give one of them");
  }

  void damping(const sim::GlobalDamping& d) {
    if (d.force == 0 && d.torque == 0 && d.rate == 0) complain({"fields", "damping"}, "This damping does nothing.", "give force, torque or rate");
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
