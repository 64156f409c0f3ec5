#include "sim/pass.h"

#include <fmt/format.h>

#include "core/error.h"
#include "sim/bonds/bond_pass.h"
#include "sim/fields/drag.h"
#include "sim/fields/magnet_pass.h"
#include "sim/heat.h"
#include "sim/laws/catalogue.h"

namespace tsubu::sim {

bool grainsTurn(const Model& model) {
  if (!model.contact.rotation) return false;
  return lawFunctions(lawIndex(model.contact)).traits.turns || !model.bonds.empty() || hasPermanentMagnets(model);
}

bool keepsOrientation(const Model& model) { return grainsTurn(model) && (model.orientation || hasPermanentMagnets(model)); }

void checkRotation(const Model& model) {
  if (model.contact.rotation) return;
  const auto refuse = [](const char* what, const char* hint) {
    throw Error(ErrorKind::scene, fmt::format("Rotation is switched off, and {}.", what), hint);
  };
  if (model.contact.rolling != "none") refuse("rolling resistance is about nothing else", "rolling = \"none\"");
  if (model.contact.twisting != "none") refuse("twisting resistance is about nothing else", "twisting = \"none\"");
  if (!model.bonds.empty()) refuse("bonds bend and twist", "leave rotation out");
  if (hasPermanentMagnets(model)) refuse("lasting magnets turn", "leave rotation out");
}

std::vector<std::unique_ptr<ForcePass>> makePasses(const Model& model) {
  const bool turns = grainsTurn(model);
  const Fields& fields = model.fields;
  std::vector<std::unique_ptr<ForcePass>> passes;
  if (!model.bonds.empty()) passes.push_back(std::make_unique<BondPass>(model));
  if (fields.drag) passes.push_back(std::make_unique<DragPass>(*fields.drag, turns, schemeOf(model.integrator).dragLimit));
  if (fields.damping) passes.push_back(std::make_unique<DampingPass>(*fields.damping, turns));
  if (model.magnets) passes.push_back(std::make_unique<MagnetPass>(model));
  if (model.heat) passes.push_back(std::make_unique<HeatPass>(model));
  return passes;
}

void checkIntegrator(const Model& model) {
  if (model.integrator != Integrator::rungeKutta) return;
  const std::string hint = "choose another integrator";
  for (const auto& pass : makePasses(model))
    if (!pass->evaluatesAnew())
      throw Error(ErrorKind::scene, fmt::format("Runge-Kutta evaluates all forces four times in a step, which '{}' cannot.", pass->name()),
                  hint);
  for (const Wall& wall : model.walls)
    if (wall.body)
      throw Error(ErrorKind::scene, fmt::format("Runge-Kutta does not move walls under load, as wall '{}' is.", wall.name), hint);
}

namespace {

// Beyond, squares of moments leave the range of single numbers: grains like dust, or like houses.
constexpr double smallestSingle = 10e-6, largestSingle = 100;  // radius, m

constexpr std::string_view withoutIt = "leave out precision = \"mixed\"";

void checkSingleRange(double smallest, double largest) {
  if (smallest >= smallestSingle && largest <= largestSingle) return;
  const std::string radii = smallest == largest ? fmt::format("A radius of {:.3g} m is", smallest)
                                                : fmt::format("Radii from {:.3g} to {:.3g} m are", smallest, largest);
  throw Error(ErrorKind::scene,
              fmt::format("{} outside of what single precision can do: {:g} m to {:g} m.", radii, smallestSingle, largestSingle),
              std::string(withoutIt));
}

}  // namespace

void checkPrecision(Precision precision, const ContactChoice& contact, Integrator integrator) {
  if (precision != Precision::mixed) return;
  const std::size_t law = lawIndex(contact);
  if (!hasSingleKernel(law)) {
    const LawFunctions& functions = lawFunctions(law);
    throw Error(ErrorKind::scene,
                fmt::format("The laws {}, {}, {} and {} (normal, tangential, rolling, twisting) are there in double precision alone.",
                            functions.names[0], functions.names[1], functions.names[2], functions.names[3]),
                std::string(withoutIt));
  }
  if (integrator == Integrator::rungeKutta)
    throw Error(ErrorKind::scene, "Runge-Kutta is there for its accuracy, which contacts in single precision would spoil.",
                "choose another integrator, or leave out precision = \"mixed\"");
}

void checkPrecision(const Model& model) {
  if (model.precision != Precision::mixed) return;
  checkPrecision(model.precision, model.contact, model.integrator);
  for (const Grain& grain : model.grains) checkSingleRange(grain.radius, grain.radius);
  for (const Stream& stream : model.streams) checkSingleRange(stream.radii.smallest(), stream.radii.largest());
}

}  // namespace tsubu::sim
