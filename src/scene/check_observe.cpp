#include <fmt/format.h>

#include <algorithm>

#include "core/names.h"
#include "scene/check.h"
#include "scene/pairs.h"

namespace tsubu::scene {

namespace {

class ObserveCheck {
 public:
  ObserveCheck(const Scene& scene, const PositionOf& positionOf, Findings& findings)
      : scene_(scene), positionOf_(positionOf), findings_(findings) {}

  void of(const Observable& observable) {
    name_ = observable.name;
    std::visit([this](const auto& o) { check(o); }, observable.kind);
  }

 private:
  void complain(const std::string& key, std::string sentence, std::string hint = {}) {
    Path path{"observe", name_};
    if (!key.empty()) path.push_back(key);
    findings_.errors.push_back({positionOf_(path), std::move(sentence), std::move(hint)});
  }

  // Is it the name of one of these?
  template <class Items>
  void named(const std::string& key, const std::string& name, const char* what, const Items& items) {
    std::vector<std::string> known;
    for (const auto& item : items) known.push_back(item.name);
    if (std::find(known.begin(), known.end(), name) != known.end()) return;
    const auto nearest = nearestName(name, known);
    complain(key, fmt::format("There is no {} '{}'.", what, name),
             nearest         ? fmt::format("did you mean '{}'?", *nearest)
             : known.empty() ? std::string()
                             : fmt::format("there is {}", listNames(known)));
  }

  void check(const DischargeRate& o) {
    named("counter", o.counter, "counter", scene_.counters);
    if (!(o.from < o.to)) complain("to", fmt::format("Crossings are counted from {} s to {} s.", o.from, o.to), "from must lie before to");
    // A run that is cut short may well be meant.
    if (o.from >= scene_.simulation.end)
      findings_.warnings.push_back({positionOf_({"observe", name_, "from"}),
                                    fmt::format("Crossings are counted from {} s on; the run ends at {} s.", o.from, scene_.simulation.end),
                                    {}});
  }
  void check(const TimeToEmpty& o) {
    if (o.box.has_value() == !o.counter.empty()) complain({}, "What is to be empty is told by either a counter or a box.");
    if (!o.counter.empty()) named("counter", o.counter, "counter", scene_.counters);
  }
  void check(const CentreOfMass& o) {
    if (!o.material.empty()) named("material", o.material, "material", scene_.materials);
  }
  void check(const AngleOfRepose&) {
    if (scene_.simulation.gravity.norm() == 0) complain({}, "Without gravity there is no angle of repose.");
  }
  void check(const PeakForce& o) { named("wall", o.wall, "wall", scene_.walls); }
  void check(const MixingIndex& o) { named("material", o.material, "material", scene_.materials); }
  void check(const BrokenBonds&) {
    if (scene_.bonds.empty()) complain({}, "The scene has no bonds that could break.");
  }
  void check(const EnergyResidual&) {
    if (!scene_.simulation.ledger) complain({}, "Without a ledger there is no residual.", "write ledger = true in [simulation]");
  }
  void check(const KineticEnergy&) {
    if (!scene_.simulation.ledger)
      complain({}, "Without a ledger the kinetic energy is not added up.", "write ledger = true in [simulation]");
  }
  void check(const auto&) {}

  const Scene& scene_;
  const PositionOf& positionOf_;
  Findings& findings_;
  std::string name_;
};

}  // namespace

void checkObserve(const Scene& scene, const PositionOf& positionOf, Findings& findings) {
  ObserveCheck check(scene, positionOf, findings);
  for (const Observable& observable : scene.observe) check.of(observable);
}

}  // namespace tsubu::scene
