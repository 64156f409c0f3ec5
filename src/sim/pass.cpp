#include "sim/pass.h"

#include "sim/fields/drag.h"
#include "sim/fields/magnet_pass.h"
#include "sim/heat.h"
#include "sim/laws/catalogue.h"

namespace tsubu::sim {

bool grainsTurn(const Model& model) { return lawFunctions(lawIndex(model.contact)).traits.turns || hasPermanentMagnets(model); }

std::vector<std::unique_ptr<ForcePass>> makePasses(const Model& model) {
  const bool turns = grainsTurn(model), verlet = model.integrator == Integrator::velocityVerlet;
  const Fields& fields = model.fields;
  std::vector<std::unique_ptr<ForcePass>> passes;
  if (fields.drag) passes.push_back(std::make_unique<DragPass>(*fields.drag, turns, verlet));
  if (fields.damping) passes.push_back(std::make_unique<DampingPass>(*fields.damping, turns));
  if (model.magnets) passes.push_back(std::make_unique<MagnetPass>(model));
  if (model.heat) passes.push_back(std::make_unique<HeatPass>(model));
  return passes;
}

}  // namespace tsubu::sim
