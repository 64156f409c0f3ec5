#include "sim/pair_constants.h"

#include <algorithm>
#include <cstring>

#include <fmt/format.h>

#include "core/error.h"

namespace tsubu::sim {

namespace {

struct MaterialUse {
  std::vector<char> ofGrains, ofWalls;
};

MaterialUse useOfMaterials(const Model& model) {
  MaterialUse use{std::vector<char>(model.materials.size(), 0), std::vector<char>(model.materials.size(), 0)};
  for (const Grain& grain : model.grains) use.ofGrains[grain.material] = 1;
  for (const Stream& stream : model.streams) use.ofGrains[stream.material] = 1;
  for (const Wall& wall : model.walls) use.ofWalls[wall.material] = 1;
  return use;
}

}  // namespace

std::vector<char> pairsThatMeet(const Model& model) {
  const std::size_t n = model.materials.size();
  const MaterialUse use = useOfMaterials(model);
  std::vector<char> meet(n * n, 0);
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t b = 0; b < n; ++b)
      if (use.ofGrains[a] && (use.ofGrains[b] || use.ofWalls[b])) meet[a * n + b] = meet[b * n + a] = 1;
  return meet;
}

namespace {

bool has(const PairValues& values, Property property) {
  if (infoOf(property).scope == Scope::pair) return values.pair.has(property);
  return values.first.has(property) && values.second.has(property);
}

void checkNeeds(const Model& model, std::size_t a, std::size_t b, const PairValues& values) {
  for (const Reading& reading : readings(model.contact)) {
    const Need& need = reading.need;
    if (need.optional || has(values, need.property) || has(values, need.alternative)) continue;
    const std::string either = need.alternative == need.property ? std::string() : fmt::format(" or {}", infoOf(need.alternative).key);
    throw Error(ErrorKind::scene, fmt::format("The pair {}–{} lacks {}{}, which the {} law '{}' reads.", model.materials[a].name,
                                              model.materials[b].name, infoOf(need.property).key, either, reading.family, reading.law));
  }
}

}  // namespace

PairConstants preparePairs(const Model& model, std::size_t law) {
  const std::size_t n = model.materials.size();
  const std::vector<char> meet = pairsThatMeet(model);
  const LawFunctions& functions = lawFunctions(law);
  // Kernels read four doubles at a time.
  PairConstants constants{functions.constants, std::vector<double>(std::max<std::size_t>(1, n * n) * functions.constants + 4, 0.0)};
  for (std::size_t a = 0; a < n; ++a) {
    for (std::size_t b = 0; b < n; ++b) {
      if (!meet[a * n + b]) continue;
      PropertyValues pair = model.pairs.at(a, b);
      // T4: what slips without turning has all of m*, and not 2/7 of it.
      if (!model.contact.rotation && !pair.has(Property::tangentialDampingFactor)) pair[Property::tangentialDampingFactor] = 1;
      const PairValues values{pair, model.materials[a].values, model.materials[b].values};
      checkNeeds(model, a, b, values);
      functions.prepare(values, model.contact.tension, model.contact.rescale, constants.values.data() + (a * n + b) * constants.size);
    }
  }
  return constants;
}

PairClasses classesOfPairs(const Model& model, const PairConstants& constants) {
  const MaterialUse use = useOfMaterials(model);
  const std::size_t n = model.materials.size(), bytes = constants.size * sizeof(double);
  const auto classOf = [&](const std::vector<char>& partners) {
    PairClass found{true, 0};
    bool any = false;
    for (std::size_t pair = 0; pair < n * n; ++pair) {
      if (!use.ofGrains[pair / n] || !partners[pair % n]) continue;
      if (!any) found.first = pair;
      any = true;
      found.alike = found.alike && std::memcmp(constants.of(pair), constants.of(found.first), bytes) == 0;
    }
    return found;
  };
  return {classOf(use.ofGrains), classOf(use.ofWalls)};
}

}  // namespace tsubu::sim
