#include "scene/costs.h"

#include <algorithm>
#include <charconv>
#include <set>
#include <sstream>

#include <fmt/format.h>

#include "scene/measured_costs.h"
#include "sim/laws/catalogue.h"
#include "sim/pass.h"

namespace tsubu::scene {

namespace {

// Cells of a row; quotes stand around what has commas.
std::vector<std::string> cellsOf(const std::string& line) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (const char c : line) {
    if (c == '"')
      quoted = !quoted;
    else if (c == ',' && !quoted)
      cells.emplace_back();
    else
      cells.back() += c;
  }
  return cells;
}

double number(const std::string& text) {
  double value = 0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

MeasuredCosts parsed(const std::string& csv) {
  MeasuredCosts costs;
  std::istringstream stream(csv);
  std::string line;
  std::getline(stream, line);
  while (std::getline(stream, line)) {
    const std::vector<std::string> cells = cellsOf(line);
    if (cells.size() < 9) continue;
    costs.features.push_back(
        {cells[0], cells[1], number(cells[2]), number(cells[3]), static_cast<int>(number(cells[4])), static_cast<int>(number(cells[5]))});
    costs.machine = cells[7];
    costs.isa = cells[8];
  }
  return costs;
}

bool polydisperse(const sim::Model& model) {
  std::set<double> radii;
  for (const sim::Grain& grain : model.grains) radii.insert(grain.radius);
  for (const sim::Stream& stream : model.streams) radii.insert({stream.radii.smallest(), stream.radii.largest()});
  return radii.size() > 1;
}

}  // namespace

const FeatureCost* MeasuredCosts::of(std::string_view feature) const {
  const auto found = std::find_if(features.begin(), features.end(), [&](const FeatureCost& cost) { return cost.feature == feature; });
  return found == features.end() ? nullptr : &*found;
}

const MeasuredCosts& measuredCosts() {
  static const MeasuredCosts costs = parsed(measuredCostsCsv);
  return costs;
}

std::vector<std::string> featuresOf(const sim::Model& model) {
  std::vector<std::string> names{"contacts, motion, lists"};
  const auto add = [&](bool there, std::string name) {
    if (there) names.push_back(std::move(name));
  };
  for (const sim::LawFamily& family : sim::lawFamilies()) {
    const std::string& chosen = sim::chosenIn(model.contact, family.key);
    add(chosen != "none" && chosen != "linear", fmt::format("{}: {}", family.key, chosen));
  }
  add(model.contact.tangential != "none" && !model.contact.rotation, "rotation held");
  add(sim::keepsOrientation(model), "orientation of grains");
  add(model.integrator != sim::Integrator::symplecticEuler, fmt::format("integrator: {}", sim::schemeOf(model.integrator).name));
  add(model.precision == sim::Precision::mixed, "mixed precision");
  add(model.ledger, "energy ledger");
  add(!model.bonds.empty(), "bonds");
  add(model.fields.drag.has_value(), "drag");
  add(model.fields.damping.has_value(), "global damping");
  add(model.magnets.has_value(), "magnets");
  add(model.heat, "heat conduction");
  add(std::find(model.periodic.begin(), model.periodic.end(), true) != model.periodic.end(), "periodic domain");
  const auto any = [&](auto&& is) { return std::any_of(model.walls.begin(), model.walls.end(), is); };
  add(any([](const sim::Wall& wall) { return !wall.surface->asPlane(); }), "mesh wall");
  add(any([](const sim::Wall& wall) { return !wall.motion.still(); }), "moving wall");
  add(any([](const sim::Wall& wall) { return wall.body.has_value(); }), "walls that move under load");
  add(polydisperse(model), "sizes of grains");
  add(model.continuous, "continuous collisions");
  return names;
}

}  // namespace tsubu::scene
