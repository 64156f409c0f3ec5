#include "sim/laws/catalogue.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/names.h"
#include "sim/model.h"

namespace tsubu::sim {

namespace {

template <class List>
std::vector<LawInfo> describe() {
  std::vector<LawInfo> infos;
  forEachType(List{}, [&]<class Law>() { infos.push_back({Law::name, Law::sentence, {Law::reads.begin(), Law::reads.end()}}); });
  return infos;
}

std::size_t indexIn(const LawFamily& family, const std::string& name) {
  std::vector<std::string> known;
  for (std::size_t i = 0; i < family.laws.size(); ++i) {
    if (family.laws[i].name == name) return i;
    known.emplace_back(family.laws[i].name);
  }
  const auto nearest = nearestName(name, known);
  throw Error(ErrorKind::scene, fmt::format("Unknown {} law '{}': expected {}.", family.key, name, listNames(known)),
              nearest ? fmt::format("did you mean '{}'?", *nearest) : std::string());
}

}  // namespace

const std::vector<LawFamily>& lawFamilies() {
  static const std::vector<LawFamily> families{{"normal", describe<NormalLaws>()},
                                               {"tangential", describe<TangentialLaws>()},
                                               {"rolling", describe<RollingLaws>()}};
  return families;
}

std::size_t lawIndex(const ContactChoice& choice) {
  const auto& families = lawFamilies();
  const std::size_t normal = indexIn(families[0], choice.normal);
  const std::size_t tangential = indexIn(families[1], choice.tangential);
  const std::size_t rolling = indexIn(families[2], choice.rolling);
  const std::size_t index = (normal * TangentialLaws::size + tangential) * RollingLaws::size + rolling;
  auto sensible = []<class Law>() { return makesSense<Law>; };
  if (!visitLaw(index, sensible)) {
    throw Error(ErrorKind::scene,
                fmt::format("Rolling law '{}' makes no sense with tangential law '{}': grains without friction never turn.", choice.rolling,
                            choice.tangential),
                "choose rolling = \"none\", or a tangential law that acts");
  }
  return index;
}

}  // namespace tsubu::sim
