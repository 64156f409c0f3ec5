#include "sim/pair_constants.h"

#include <algorithm>
#include <cstring>

#include <fmt/format.h>

#include "core/error.h"
#include "sim/laws/catalogue.h"

namespace tsubu::sim {

LawTraits lawTraits(std::size_t law) {
  auto traits = []<class Law>() { return LawTraits{Law::stateSize, Law::turns, Law::rolls}; };
  return visitLaw(law, traits);
}

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

void checkNeeds(const Model& model, std::size_t a, std::size_t b, std::string_view family, std::string_view law, std::span<const Need> reads) {
  const PropertyValues& values = model.pairs.at(a, b);
  for (const Need& need : reads) {
    if (need.optional || values.has(need.property) || values.has(need.alternative)) continue;
    const std::string either =
        need.alternative == need.property ? std::string() : fmt::format(" or {}", infoOf(need.alternative).key);
    throw Error(ErrorKind::scene, fmt::format("The pair {}–{} lacks {}{}, which the {} law '{}' reads.", model.materials[a].name,
                                              model.materials[b].name, infoOf(need.property).key, either, family, law));
  }
}

template <class Law>
typename Law::Pair prepareOne(const Model& model, std::size_t a, std::size_t b) {
  checkNeeds(model, a, b, "normal", Law::Normal::name, Law::Normal::reads);
  checkNeeds(model, a, b, "tangential", Law::Tangential::name, Law::Tangential::reads);
  checkNeeds(model, a, b, "rolling", Law::Rolling::name, Law::Rolling::reads);
  return Law::prepare(model.pairs.at(a, b), model.contact.tension);
}

}  // namespace

std::vector<unsigned char> preparePairs(const Model& model, std::size_t law) {
  const std::size_t n = model.materials.size();
  const std::vector<char> meet = pairsThatMeet(model);
  auto prepare = [&]<class Law>() {
    using Pair = typename Law::Pair;
    std::vector<unsigned char> bytes(std::max<std::size_t>(1, n * n) * sizeof(Pair), 0);
    for (std::size_t a = 0; a < n; ++a) {
      for (std::size_t b = 0; b < n; ++b) {
        if (!meet[a * n + b]) continue;
        const Pair pair = prepareOne<Law>(model, a, b);
        std::memcpy(bytes.data() + (a * n + b) * sizeof(Pair), &pair, sizeof(Pair));
      }
    }
    return bytes;
  };
  return visitLaw(law, prepare);
}

PairClasses classesOfPairs(const Model& model, const std::vector<unsigned char>& pairConstants) {
  const MaterialUse use = useOfMaterials(model);
  const std::size_t n = model.materials.size(), size = pairConstants.size() / std::max<std::size_t>(1, n * n);
  const auto classOf = [&](const std::vector<char>& partners) {
    PairClass found{true, 0};
    bool any = false;
    for (std::size_t pair = 0; pair < n * n; ++pair) {
      if (!use.ofGrains[pair / n] || !partners[pair % n]) continue;
      if (!any) found.first = pair;
      any = true;
      found.alike = found.alike && std::memcmp(pairConstants.data() + pair * size, pairConstants.data() + found.first * size, size) == 0;
    }
    return found;
  };
  return {classOf(use.ofGrains), classOf(use.ofWalls)};
}

std::array<ContactMode, 3> contactModes(const Model& model, std::size_t law, std::size_t a, std::size_t b, double inverseMass) {
  auto read = [&]<class Law>() -> std::array<ContactMode, 3> {
    const typename Law::Pair pair = prepareOne<Law>(model, a, b);
    const double damping = Law::Normal::damping(pair.normal, 1 / inverseMass);
    return {ContactMode{Law::Normal::stiffness(pair.normal) * inverseMass, damping * inverseMass},
            Law::Tangential::mode(pair.tangential, damping, inverseMass), Law::Rolling::mode(pair.rolling, inverseMass)};
  };
  return visitLaw(law, read);
}

}  // namespace tsubu::sim
