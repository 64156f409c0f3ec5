#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/names.h"
#include "scene/check.h"
#include "scene/pairs.h"
#include "sim/laws/catalogue.h"

namespace tsubu::scene {

namespace {

std::string keyOf(sim::Property property) { return std::string(sim::infoOf(property).key); }

std::string pairName(const Scene& scene, std::pair<std::size_t, std::size_t> pair) {
  return fmt::format("{}–{}", scene.materials[pair.first].name, scene.materials[pair.second].name);
}

bool lacks(const Scene& scene, std::pair<std::size_t, std::size_t> pair, const sim::Need& need) {
  if (sim::infoOf(need.property).scope == sim::Scope::pair) {
    const Properties values = pairProperties(scene, pair.first, pair.second);
    return !values[need.property] && !values[need.alternative];
  }
  return !scene.materials[pair.first].properties[need.property] || !scene.materials[pair.second].properties[need.property];
}

void checkNeed(const Scene& scene, const sim::Reading& reading, const PositionOf& positionOf, Findings& findings) {
  const sim::Need& need = reading.need;
  if (need.optional) return;
  const sim::PropertyInfo& info = sim::infoOf(need.property);
  const std::string either = need.property == need.alternative ? std::string() : fmt::format(" (or '{}')", keyOf(need.alternative));
  std::string sentence(info.sentence);
  if (sentence.back() == '.') sentence.pop_back();
  std::vector<std::pair<std::size_t, std::size_t>> lacking;
  for (const auto& pair : touchingPairs(scene))
    if (lacks(scene, pair, need)) lacking.push_back(pair);
  if (lacking.empty()) return;
  const std::string more = lacking.size() > 1 ? fmt::format(" and {} more", lacking.size() - 1) : std::string();
  if (info.scope == sim::Scope::pair) {
    findings.errors.push_back({positionOf({"pairs"}),
                               fmt::format("The {} law '{}' needs '{}'{} for the pair {}{}.", reading.family, reading.law, info.key, either,
                                           pairName(scene, lacking.front()), more),
                               fmt::format("write it in [pairs]; {}", sentence)});
    return;
  }
  const auto [a, b] = lacking.front();
  const Material& without = scene.materials[scene.materials[a].properties[need.property] ? b : a];
  findings.errors.push_back(
      {positionOf({"materials", without.name}),
       fmt::format("The {} law '{}' needs '{}' of the material '{}'.", reading.family, reading.law, info.key, without.name),
       fmt::format("write it in [materials.{}]; {}", without.name, sentence)});
}

bool isOf(sim::Property property, std::initializer_list<sim::Property> group) {
  return std::find(group.begin(), group.end(), property) != group.end();
}
bool isOfHeat(sim::Property property) { return isOf(property, {sim::Property::conductivity, sim::Property::heatCapacity}); }
bool isOfMagnets(sim::Property property) { return isOf(property, {sim::Property::magnetisation, sim::Property::susceptibility}); }

// Values that no chosen law reads are not wrong (the law may be switched for a comparison), but worth a word; two that say the same
// thing in different ways are.
void checkTable(const Scene& scene, const Properties& properties, sim::Scope scope, const Path& path, const PositionOf& positionOf,
                Findings& findings) {
  const auto at = [&](sim::Property property) {
    Path full = path;
    full.push_back(keyOf(property));
    return positionOf(full);
  };
  std::array<bool, sim::propertyCount> read{};
  read[static_cast<std::size_t>(sim::Property::density)] = true;
  for (const sim::Reading& reading : sim::readings(scene.contact)) {
    const sim::Need& need = reading.need;
    read[static_cast<std::size_t>(need.property)] = read[static_cast<std::size_t>(need.alternative)] = true;
    if (need.property != need.alternative && properties[need.property] && properties[need.alternative]) {
      findings.errors.push_back(
          {at(need.alternative),
           fmt::format("'{}' and '{}' say the same in two ways; only one can be given.", keyOf(need.property), keyOf(need.alternative)),
           {}});
    }
  }
  for (const sim::PropertyInfo& info : sim::propertyTable()) {
    if (info.scope != scope || !properties[info.property] || read[static_cast<std::size_t>(info.property)]) continue;
    if (isOfHeat(info.property) || isOfMagnets(info.property)) {
      const std::string_view table = isOfHeat(info.property) ? "heat" : "magnets";
      const bool asked = isOfHeat(info.property) ? scene.heat.has_value() : scene.magnets.has_value();
      if (!asked) findings.warnings.push_back({at(info.property), fmt::format("Without [{}] nothing reads '{}'.", table, info.key), {}});
      continue;
    }
    findings.warnings.push_back({at(info.property), fmt::format("None of the chosen contact laws reads '{}'.", info.key), "see [contact]"});
  }
}

}  // namespace

void checkContact(const Scene& scene, const PositionOf& positionOf, Findings& findings) {
  try {
    sim::lawIndex(scene.contact);
  } catch (const Error& error) {
    for (const Diagnostic& what : error.diagnostics()) findings.errors.push_back({positionOf({"contact"}), what.message, what.hint});
  }
  if (!scene.contact.rotation) {
    const auto refuse = [&](const char* key, const char* what, std::string hint) {
      findings.errors.push_back({positionOf({"contact", key}), fmt::format("Rotation is switched off, and {}.", what), std::move(hint)});
    };
    if (scene.contact.rolling != "none") refuse("rolling", "rolling resistance is about nothing else", "rolling = \"none\"");
    if (scene.contact.twisting != "none") refuse("twisting", "twisting resistance is about nothing else", "twisting = \"none\"");
    if (!scene.bonds.empty()) refuse("rotation", "bonds bend and twist", "leave rotation out");
    for (const GrainSource& source : scene.grains)
      if (!source.spin.isZero())
        findings.warnings.push_back({positionOf({"grains", source.name, "spin"}), "Rotation is switched off: nobody reads the spin.", {}});
  }
  for (const sim::Reading& reading : sim::readings(scene.contact)) checkNeed(scene, reading, positionOf, findings);
  checkTable(scene, scene.pairs.all, sim::Scope::pair, {"pairs"}, positionOf, findings);
  for (const Pair& pair : scene.pairs.special)
    checkTable(scene, pair.properties, sim::Scope::pair, {"pairs", pair.first, pair.second}, positionOf, findings);
  for (const Material& material : scene.materials)
    checkTable(scene, material.properties, sim::Scope::material, {"materials", material.name}, positionOf, findings);
  for (const std::size_t i : grainMaterials(scene)) {
    const Material& material = scene.materials[i];
    if (material.properties[sim::Property::density]) continue;
    findings.errors.push_back({positionOf({"materials", material.name}),
                               fmt::format("Grains are made of '{}', which has no density.", material.name),
                               "for instance density = \"2500 kg/m^3\""});
  }
}

}  // namespace tsubu::scene
